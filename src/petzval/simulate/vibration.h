// SPDX-License-Identifier: BSD-3-Clause
// A camera that shakes: turns at random, with a spectrum that is given.
#pragma once

#include <petzval/simulate/motion_path.h>

#include <cstdint>
#include <string>
#include <vector>

namespace petzval {

/// One-sided power spectral densities of the angles of a camera, straight between frequencies, 0 outside.
///
///     const VibrationSpectrum hand = VibrationSpectrum::parse("0.02@1-20");  // degrees rms, Hz
///     ClipOptions options;
///     options.motion = hand.shaken(options.motion, options.duration_s(), 1);
class VibrationSpectrum {
 public:
  struct Line {
    double frequency_hz = 0, pan_deg2_per_hz = 0, pitch_deg2_per_hz = 0;
  };

  /// \throws InputError unless frequencies increase and densities are not negative.
  explicit VibrationSpectrum(std::vector<Line> lines);
  /// "RMS@FROM-TO": both angles by so many degrees rms, flat between two frequencies [Hz]; or a .csv whose
  /// first line names its columns: frequency_hz, and any of pan_deg2_per_hz and pitch_deg2_per_hz.
  /// \throws InputError saying what would be right, with file and line.
  static VibrationSpectrum parse(const std::string& text);

  const std::vector<Line>& lines() const { return lines_; }
  /// Root of the integral of a density [degrees].
  double rms_pan_deg() const;
  double rms_pitch_deg() const;

  /// A path with the vibration on top, from 0 to `duration_s`: for each angle 256 cosines, one at random in
  /// each of as many equal intervals of frequency, with the power of that interval and a random phase
  /// (Shinozuka & Deodatis, Appl. Mech. Rev. 44 (1991) 191): Gaussian to a good approximation, and not
  /// periodic. Sixteen instants to the shortest period: there 1.3 % of the amplitude are lost to straight
  /// lines. \throws InputError if that makes more than 4 million.
  MotionPath shaken(const MotionPath& path, double duration_s, std::uint64_t seed) const;

 private:
  std::vector<Line> lines_;
};

}  // namespace petzval
