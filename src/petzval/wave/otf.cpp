// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/wave/otf.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

void require_positive(double value, const char* what) {
  if (!(value > 0) || !std::isfinite(value))
    throw InputError(fmt::format("{} of {}: a positive number is right", what, value));
}

}  // namespace

std::complex<double> Otf::at(double fx_cpmm, double fy_cpmm) const {
  std::complex<double> value;
  evaluate(fx_cpmm, {&fy_cpmm, 1}, {&value, 1});
  return value;
}

RadialOtf::RadialOtf(std::vector<double> table, double cutoff_cpmm, PsfTail tail, double reach_um)
    : table_(std::move(table)), cutoff_cpmm_(cutoff_cpmm), tail_(tail), reach_um_(reach_um) {
  if (table_.size() < 4) throw InputError("the table of an OTF needs at least four values");
  require_positive(cutoff_cpmm, "a cut-off frequency");
}

double RadialOtf::operator()(double frequency_cpmm) const {
  const double steps = static_cast<double>(table_.size() - 1);
  const double at = std::abs(frequency_cpmm) / cutoff_cpmm_ * steps;
  if (!(at < steps)) return 0;
  // The cubic through the four nearest values.
  const auto i = std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(at) - 1, 0,
                                            static_cast<std::ptrdiff_t>(table_.size()) - 4);
  const double* y = table_.data() + i;
  const double u = at - static_cast<double>(i);
  const double a = u, b = u - 1, c = u - 2, d = u - 3;
  return (-y[0] * b * c * d + 3 * y[1] * a * c * d - 3 * y[2] * a * b * d + y[3] * a * b * c) / 6;
}

void RadialOtf::evaluate(double fx_cpmm, std::span<const double> fy_cpmm,
                         std::span<std::complex<double>> values) const {
  for (std::size_t i = 0; i < fy_cpmm.size(); ++i)
    values[i] = (*this)(std::sqrt(fx_cpmm * fx_cpmm + fy_cpmm[i] * fy_cpmm[i]));
}

std::unique_ptr<RadialOtf> radial_pupil_otf(const RadialPupil& pupil, double wavelength_nm, double f_number) {
  require_positive(wavelength_nm, "a wavelength");
  require_positive(f_number, "an f-number");
  pupil.validate();
  const double unit_um = wavelength_nm * 1e-3 * f_number;  // λN
  const RadialTail tail = radial_tail(pupil);
  const double radius = geometric_radius(pupil);
  // Fine enough for the oscillations that aberrations bring: an error of 1e-11 with a cubic.
  const int steps = std::min(1 << 20, 4096 + 256 * static_cast<int>(std::ceil(radius)));
  return std::make_unique<RadialOtf>(radial_otf_table(pupil, steps), 1e3 / unit_um,
                                     PsfTail{tail.k3 * unit_um, tail.k5 * unit_um * unit_um * unit_um, 0},
                                     (radius + 2) * unit_um);
}

std::unique_ptr<RadialOtf> gaussian_otf(double sigma_um) {
  require_positive(sigma_um, "a standard deviation");
  // exp(−2π²σ²f²) falls to 1e-13 at f = 1.231/σ.
  constexpr int steps = 8192;
  const double cutoff = std::sqrt(std::log(1e13) / 2) / (pi * sigma_um);
  std::vector<double> table;
  for (int i = 0; i <= steps; ++i) {
    const double phase = pi * sigma_um * cutoff * i / steps;
    table.push_back(std::exp(-2 * phase * phase));
  }
  return std::make_unique<RadialOtf>(std::move(table), cutoff * 1e3, PsfTail{}, 8 * sigma_um);
}

MixedOtf::MixedOtf(std::vector<Part> parts) : parts_(std::move(parts)) {
  double sum = 0;
  for (const Part& part : parts_) {
    if (!(part.weight >= 0) || !std::isfinite(part.weight))
      throw InputError(fmt::format("a weight of {}: zero or a positive number is right", part.weight));
    sum += part.weight;
  }
  if (!(sum > 0))
    throw InputError("the weights of the wavelengths are all zero; one at least must be positive");
  for (Part& part : parts_) part.weight /= sum;
}

double MixedOtf::cutoff_cpmm() const {
  double largest = 0;
  for (const Part& part : parts_) largest = std::max(largest, part.otf->cutoff_cpmm());
  return largest;
}

void MixedOtf::evaluate(double fx_cpmm, std::span<const double> fy_cpmm,
                        std::span<std::complex<double>> values) const {
  std::fill(values.begin(), values.end(), 0);
  std::vector<std::complex<double>> one(values.size());
  for (const Part& part : parts_) {
    part.otf->evaluate(fx_cpmm, fy_cpmm, one);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += part.weight * one[i];
  }
}

PsfTail MixedOtf::tail() const {
  PsfTail sum;
  for (const Part& part : parts_) {
    const PsfTail one = part.otf->tail();
    sum.k3_um += part.weight * one.k3_um;
    sum.k5_um3 += part.weight * one.k5_um3;
    sum.settled_um = std::max(sum.settled_um, one.settled_um);
  }
  return sum;
}

double MixedOtf::reach_um() const {
  double largest = 0;
  for (const Part& part : parts_) largest = std::max(largest, part.otf->reach_um());
  return largest;
}

}  // namespace petzval
