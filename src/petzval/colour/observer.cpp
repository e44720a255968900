// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/colour/observer.h>
#include <petzval/colour/spectra_files.h>

#include <algorithm>
#include <utility>

namespace petzval {

namespace {

Observer read_cie_1931() {
  const SpectrumSet set = read_spectrum_set("cie_1931_xyz");
  return Observer(set.find("x_bar"), set.find("y_bar"), set.find("z_bar"));
}

}  // namespace

Chromaticity chromaticity(Xyz colour) {
  const double sum = colour.x + colour.y + colour.z;
  if (sum == 0) return {};
  return {colour.x / sum, colour.y / sum};
}

Xyz xyz_of(Chromaticity c) {
  if (!(c.y > 0))
    throw InputError(fmt::format("no colour has the chromaticity y = {}; it must be positive", c.y));
  return {c.x / c.y, 1.0, (1.0 - c.x - c.y) / c.y};
}

Observer::Observer(Spectrum x_bar, Spectrum y_bar, Spectrum z_bar)
    : x_bar_(std::move(x_bar)), y_bar_(std::move(y_bar)), z_bar_(std::move(z_bar)) {
  if (x_bar_.empty() || x_bar_.wavelengths_nm() != y_bar_.wavelengths_nm() ||
      x_bar_.wavelengths_nm() != z_bar_.wavelengths_nm())
    throw InputError("the three colour-matching functions of an observer must have the same wavelengths");
}

const Observer& Observer::cie_1931() {
  static const Observer observer = read_cie_1931();
  return observer;
}

Xyz Observer::at(double wavelength_nm) const {
  return {x_bar_.at(wavelength_nm), y_bar_.at(wavelength_nm), z_bar_.at(wavelength_nm)};
}

std::vector<Xyz> Observer::weights(std::span<const double> wavelengths_nm) const {
  if (wavelengths_nm.size() == 1) return {at(wavelengths_nm[0])};
  std::vector<Xyz> weights(wavelengths_nm.size());
  const std::vector<double>& table = x_bar_.wavelengths_nm();
  for (std::size_t i = 1; i < wavelengths_nm.size(); ++i) {
    const double left = wavelengths_nm[i - 1], right = wavelengths_nm[i];
    // Between neighbouring breakpoints of either curve hat times observer is a parabola: Simpson's rule is
    // exact.
    double a = std::max(left, table.front());
    while (a < std::min(right, table.back())) {
      const double b = std::min(right, *std::upper_bound(table.begin(), table.end(), a));
      const double middle = 0.5 * (a + b), step = (b - a) / 6.0;
      for (const auto& [wavelength, share] : {std::pair{a, step}, {middle, 4 * step}, {b, step}}) {
        const double t = (wavelength - left) / (right - left);
        weights[i - 1] = weights[i - 1] + (share * (1 - t)) * at(wavelength);
        weights[i] = weights[i] + (share * t) * at(wavelength);
      }
      a = b;
    }
  }
  return weights;
}

Xyz Observer::xyz(const Spectrum& spectrum) const {
  const std::vector<Xyz> weight = weights(spectrum.wavelengths_nm());
  Xyz sum;
  for (std::size_t i = 0; i < weight.size(); ++i) sum = sum + spectrum.values()[i] * weight[i];
  return sum;
}

double luminance(const Spectrum& radiance) {
  return lumens_per_watt * Observer::cie_1931().xyz(radiance).y;
}

}  // namespace petzval
