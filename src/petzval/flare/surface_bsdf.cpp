// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/flare/surface_bsdf.h>
#include <petzval/numeric/bessel.h>
#include <petzval/numeric/quadrature.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr int density_steps = 1000;
constexpr double least_tau = 1e-6;
const double log_least = std::log(least_tau);
const double log_step = -log_least / density_steps;
/// Stands for the logarithm of nothing.
constexpr double log_nothing = -690;

/// ∫ of 2π p τ dτ over a step that begins at τ, where p is a power of τ.
double ring_sum(double log_tau, double log_density, double log_next, double length) {
  const double power = (log_next - log_density) / log_step + 2;
  const double start = 2 * pi * std::exp(log_density + 2 * log_tau);
  constexpr double tiny = 1e-9;
  return start * (std::abs(power) < tiny ? length : std::expm1(power * length) / power);
}

double harvey(double tau, double l, double s) {
  return std::pow(1 + tau * tau / (l * l), s / 2);
}

double table_value(const std::vector<std::pair<double, double>>& table, double tau) {
  const double angle = degrees(std::asin(std::min(tau, 1.0)));
  if (tau > 1 || angle > table.back().first) return 0;
  if (angle <= table.front().first) return table.front().second;
  const auto above =
      std::ranges::find_if(table, [&](const std::pair<double, double>& row) { return row.first >= angle; });
  const auto below = above - 1;
  const double from = std::log(std::sin(radians(below->first))),
               to = std::log(std::sin(radians(above->first)));
  const double share = (std::log(tau) - from) / (to - from);
  return std::exp(std::log(below->second) * (1 - share) + std::log(above->second) * share);
}

/// Of Airy's pattern of a disc, (2 J₁(x)/x)², whose fringes beyond x are taken at their mean.
double airy(double x) {
  constexpr double fifth_fringe = 17;
  if (x > fifth_fringe) return 4 / (pi * x * x * x);
  const double value = jinc(x);
  return value * value;
}

/// Discs of 1 µm to the level, weighed by what they cover.
RadialDensity dust_density(double level, double wavelength_nm) {
  constexpr int sizes = 200;
  constexpr double slope = 0.926;
  const double top = std::log10(level);
  const QuadratureRule rule = gauss_legendre(sizes, 0, top);
  std::vector<double> diameters, weights;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double log_d = rule.nodes[i];
    diameters.push_back(std::pow(10, log_d) / (wavelength_nm * mm_per_nm * um_per_mm));
    weights.push_back(rule.weights[i] * log_d * std::pow(10, 2 * log_d - slope * log_d * log_d));
  }
  return RadialDensity([&](double tau) {
    double sum = 0;
    for (std::size_t i = 0; i < diameters.size(); ++i)
      sum += weights[i] * diameters[i] * diameters[i] * airy(pi * diameters[i] * tau);
    return sum;
  });
}

}  // namespace

RadialDensity::RadialDensity(const std::function<double(double)>& shape) {
  for (int i = 0; i <= density_steps; ++i) {
    const double value = shape(std::exp(log_least + i * log_step));
    log_.push_back(value > 0 ? std::max(std::log(value), log_nothing) : log_nothing);
  }
  sum_.push_back(pi * least_tau * least_tau * std::exp(log_[0]));
  for (std::size_t i = 0; i < density_steps; ++i)
    sum_.push_back(sum_.back() +
                   ring_sum(log_least + static_cast<double>(i) * log_step, log_[i], log_[i + 1], log_step));
  total_ = sum_.back();
  for (double& each : log_) each -= std::log(total_);
  for (double& each : sum_) each /= total_;
}

double RadialDensity::at(double tau) const {
  if (tau > 1 || log_.empty()) return 0;
  if (tau <= least_tau) return std::exp(log_[0]);
  const double place = (std::log(tau) - log_least) / log_step;
  const std::size_t i = std::min(static_cast<std::size_t>(place), std::size_t{density_steps - 1});
  const double share = place - static_cast<double>(i);
  return std::exp(log_[i] * (1 - share) + log_[i + 1] * share);
}

double RadialDensity::within(double tau) const {
  if (log_.empty()) return 0;
  if (tau >= 1) return 1;
  if (tau <= least_tau) return pi * tau * tau * std::exp(log_[0]);
  const double place = (std::log(tau) - log_least) / log_step;
  const std::size_t i = std::min(static_cast<std::size_t>(place), std::size_t{density_steps - 1});
  const double rest = (place - static_cast<double>(i)) * log_step;
  return sum_[i] + ring_sum(log_least + static_cast<double>(i) * log_step, log_[i], log_[i + 1], rest);
}

SurfaceBsdf::SurfaceBsdf(const Scatter& scatter, double wavelength_nm, double index_before,
                         double index_after, bool mirror)
    : index_before_(index_before), index_after_(mirror ? -index_before : index_after) {
  scatter.validate();
  // The same irregularities at this wavelength: angles with λ, light per angle² with λ⁻⁴.
  const double ratio = scatter.wavelength_nm / wavelength_nm;
  if (scatter.table.empty() && scatter.has_polish())
    polish_shape_ = RadialDensity([&](double tau) { return harvey(tau * ratio, scatter.l, scatter.s); });
  else if (scatter.has_polish())
    polish_shape_ = RadialDensity([&](double tau) { return table_value(scatter.table, tau * ratio); });
  if (scatter.roughness_nm)
    roughness_waves_ = *scatter.roughness_nm / wavelength_nm;
  else if (scatter.has_polish())
    constant_polish_ = std::pow(ratio, 4) * scatter.b0_per_sr.value_or(1) * polish_shape_.total();
  dust_ = scatter.dust_share();
  if (dust_ > 0) dust_shape_ = dust_density(scatter.dust_level(), wavelength_nm);
  if (!(constant_polish_ + 2 * dust_ < 1))
    throw InputError(fmt::format(
        "a surface that scatters {:.3g} of the light of {:g} nm; less than all of it would be right",
        constant_polish_ + 2 * dust_, wavelength_nm));
}

ScatterShares SurfaceBsdf::shares(double cosine_before, double cosine_after) const {
  ScatterShares result{constant_polish_, dust_, dust_};
  if (roughness_waves_ > 0) {
    const double waves = roughness_waves_ * (index_before_ * cosine_before - index_after_ * cosine_after);
    result.polish = -std::expm1(-std::pow(2 * pi * waves, 2)) * (1 - 2 * dust_);
  }
  return result;
}

double SurfaceBsdf::at(const ScatterShares& shares, double tau) const {
  double sum = 0;
  if (shares.polish > 0) sum += shares.polish * polish_shape_.at(tau);
  if (shares.dust > 0) sum += shares.dust * dust_shape_.at(tau);
  return sum;
}

double SurfaceBsdf::within(const ScatterShares& shares, double tau) const {
  return shares.polish * polish_shape_.within(tau) + shares.dust * dust_shape_.within(tau);
}

}  // namespace petzval
