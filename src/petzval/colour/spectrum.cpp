// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/colour/spectrum.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace petzval {

namespace {

/// Linear interpolation; `wavelength` lies within the grid, which has at least one sample.
double interpolated(const std::vector<double>& grid, const std::vector<double>& values, double wavelength) {
  const auto upper = std::upper_bound(grid.begin(), grid.end(), wavelength);
  const auto i = static_cast<std::size_t>(upper - grid.begin());
  if (i == grid.size()) return values.back();
  const double t = (wavelength - grid[i - 1]) / (grid[i] - grid[i - 1]);
  return values[i - 1] + t * (values[i] - values[i - 1]);
}

}  // namespace

Spectrum::Spectrum(std::vector<double> wavelengths_nm, std::vector<double> values)
    : wavelengths_nm_(std::move(wavelengths_nm)), values_(std::move(values)) {
  if (wavelengths_nm_.size() != values_.size())
    throw InputError(
        fmt::format("a spectrum has {} wavelengths but {} values", wavelengths_nm_.size(), values_.size()));
  if (values_.empty()) throw InputError("a spectrum needs at least one sample");
  for (std::size_t i = 0; i < values_.size(); ++i) {
    if (!std::isfinite(wavelengths_nm_[i]) || wavelengths_nm_[i] <= 0)
      throw InputError(
          fmt::format("a wavelength of {} nm; it must be positive and finite", wavelengths_nm_[i]));
    if (i > 0 && wavelengths_nm_[i] <= wavelengths_nm_[i - 1])
      throw InputError(fmt::format("wavelengths must increase, but {} nm comes after {} nm",
                                   wavelengths_nm_[i], wavelengths_nm_[i - 1]));
    if (!std::isfinite(values_[i]))
      throw InputError(
          fmt::format("the value at {} nm is {}; it must be finite", wavelengths_nm_[i], values_[i]));
  }
}

double Spectrum::at(double wavelength_nm) const {
  if (empty() || !(wavelength_nm >= front_nm() && wavelength_nm <= back_nm())) return 0;
  return interpolated(wavelengths_nm_, values_, wavelength_nm);
}

double Spectrum::at_extended(double wavelength_nm) const {
  if (empty()) return 0;
  return interpolated(wavelengths_nm_, values_, std::clamp(wavelength_nm, front_nm(), back_nm()));
}

double Spectrum::integral(double from_nm, double to_nm) const {
  if (empty()) return 0;
  if (from_nm > to_nm) return -integral(to_nm, from_nm);
  double sum = 0;
  for (std::size_t i = 1; i < values_.size(); ++i) {
    const double a = std::max(from_nm, wavelengths_nm_[i - 1]);
    const double b = std::min(to_nm, wavelengths_nm_[i]);
    if (a < b) sum += 0.5 * (b - a) * (at(a) + at(b));
  }
  return sum;
}

Spectrum Spectrum::scaled(double factor) const {
  std::vector<double> values = values_;
  for (double& value : values) value *= factor;
  return Spectrum(wavelengths_nm_, std::move(values));
}

std::vector<double> band_widths_nm(std::span<const double> wavelengths_nm) {
  const std::size_t count = wavelengths_nm.size();
  if (count == 1) return {1.0};
  std::vector<double> widths(count, 0.0);
  for (std::size_t i = 1; i < count; ++i) {
    const double half = 0.5 * (wavelengths_nm[i] - wavelengths_nm[i - 1]);
    widths[i - 1] += half;
    widths[i] += half;
  }
  return widths;
}

}  // namespace petzval
