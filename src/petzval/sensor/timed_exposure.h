// SPDX-License-Identifier: BSD-3-Clause
// An exposure as an interval: light that changes while the rows of a frame are open.
#pragma once

#include <petzval/sensor/lamp_flicker.h>
#include <petzval/sensor/photo_current.h>
#include <petzval/sensor/shutter.h>

#include <vector>

namespace petzval {

/// When a frame is exposed: row r from start + row delay on, for the exposure time.
struct FrameTiming {
  double start_s = 0, exposure_s = 0;
  Shutter shutter = {};

  double row_start_s(int row) const { return start_s + shutter.row_delay_s(row); }
  /// When the last row of a frame ends.
  double end_s(int rows) const { return row_start_s(rows - 1) + exposure_s; }
};

/// Collects the light of one frame.
///
///     TimedExposure exposure(timing, flicker);
///     for (…) exposure.add(t0, current0, t1, current1);   // from timing.start_s to timing.end_s(rows)
///     capture(exposure.mean_current(), sensor, timing.exposure_s, options);
///
/// From each instant to the next the current of a pixel changes in a straight line, and is multiplied by the
/// flicker of the lamps; the integral over the window of each row is then exact. Of a picture that moves by h
/// pixels from one instant to the next, a detail of f cycles per pixel keeps (πfh)/tan(πfh) of the contrast
/// that true motion leaves it (the trapezoidal rule): 0.98 at h = 0.25 and f = 0.3, 0.92 at h = 0.5.
class TimedExposure {
 public:
  TimedExposure(const FrameTiming& timing, const LampFlicker& flicker) : timing_(timing), flicker_(flicker) {}

  /// How long, in seconds of steady light, a row collects the light of t0 and that of t1.
  struct Shares {
    double of_t0 = 0, of_t1 = 0;
  };
  Shares shares(int row, double t0_s, double t1_s) const;

  /// Light from t0 to t1. \throws InputError unless both are of one frame and t1 is later.
  void add(double t0_s, const PhotoCurrent& at_t0, double t1_s, const PhotoCurrent& at_t1);
  /// Electrons collected over the exposure time.
  PhotoCurrent mean_current() const;

 private:
  FrameTiming timing_;
  LampFlicker flicker_;
  PhotoCurrent frame_;  ///< of the sizes of what was added
  std::vector<double> electrons_;
};

}  // namespace petzval
