// SPDX-License-Identifier: BSD-3-Clause
// A quantity sampled over wavelength.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace petzval {

/// Samples of a quantity at strictly increasing wavelengths [nm], linear in between. The unit of the values
/// is the business of whoever holds the spectrum (and in the name of the variable).
class Spectrum {
 public:
  Spectrum() = default;
  /// \throws InputError unless the sizes agree, there is at least one sample, the wavelengths are finite,
  /// positive and strictly increasing, and the values are finite.
  Spectrum(std::vector<double> wavelengths_nm, std::vector<double> values);

  const std::vector<double>& wavelengths_nm() const { return wavelengths_nm_; }
  const std::vector<double>& values() const { return values_; }
  bool empty() const { return values_.empty(); }
  double front_nm() const { return wavelengths_nm_.front(); }
  double back_nm() const { return wavelengths_nm_.back(); }

  /// Linear interpolation; zero outside the sampled range (a lamp emits and a filter passes nothing there).
  double at(double wavelength_nm) const;
  /// As at(), but the end values carry on outside the range (reflectances).
  double at_extended(double wavelength_nm) const;
  /// The integral over [from, to] of the piecewise linear curve, in value·nm.
  double integral(double from_nm, double to_nm) const;
  Spectrum scaled(double factor) const;

 private:
  std::vector<double> wavelengths_nm_, values_;
};

/// The width [nm] that each sample of a wavelength grid stands for (trapezoid rule; a single sample: 1 nm).
std::vector<double> band_widths_nm(std::span<const double> wavelengths_nm);

}  // namespace petzval
