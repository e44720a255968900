// SPDX-License-Identifier: BSD-3-Clause
// What all exposures of one sensor to one kind of light share.
#pragma once

#include <petzval/simulate/expose.h>

#include <span>

namespace petzval {

/// A sensor, its options and its exposure time, settled once for any number of raw images.
class PreparedExposure {
 public:
  /// \param light  that exposure and white balance are measured on. \throws InputError as expose().
  /// \param calibrations  standard_calibrations() of the sensor where they are known, for they cost more than
  /// a small picture; empty: they are worked out.
  PreparedExposure(const SpectralImage& light, Sensor sensor, const ExposeOptions& options,
                   const Context& context, std::vector<ColourCalibration> calibrations = {});

  double seconds() const { return seconds_; }
  void set_seconds(double seconds) { seconds_ = seconds; }
  const Sensor& sensor() const { return sensor_; }
  const PhotoCurrent& first_current() const { return current_; }
  /// Of other light through the same lens.
  PhotoCurrent current(const SpectralImage& light) const;
  /// \param currents  of all exposures; or, where that changes, one for each of the bracket.
  /// \param first_frame  of a clip: its noise is its own.
  RawImage raw(std::span<const PhotoCurrent> currents, std::uint64_t seed, int first_frame = 0) const;

 private:
  Sensor sensor_;
  ExposeOptions options_;
  PhotoCurrent current_;
  double seconds_;
  RawImage facts_;  ///< a raw image but for its samples
};

}  // namespace petzval
