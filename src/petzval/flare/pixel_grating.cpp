// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/flare/pixel_grating.h>
#include <petzval/numeric/quadrature.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>

namespace petzval {

namespace {

/// Shares of the orders 0 to `most` along one side: the paraboloid is a sum over both sides, its transform a
/// product.
std::vector<double> side_shares(double sag_um, double wavelength_um, int most) {
  // Each side has half of the sag. Enough nodes for the phase and the highest order.
  const double phase = 4 * pi * (sag_um / 2) / wavelength_um;
  const QuadratureRule rule = gauss_legendre(32 + static_cast<int>(phase) + 4 * most, -0.5, 0.5);
  std::vector<double> shares;
  for (int order = 0; order <= most; ++order) {
    std::complex<double> sum = 0;
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      const double u = rule.nodes[i];
      sum += rule.weights[i] * std::polar(1.0, -phase * 4 * u * u - 2 * pi * order * u);
    }
    shares.push_back(std::norm(sum));
  }
  return shares;
}

}  // namespace

void SensorReflection::validate() const {
  if (!(reflectance >= 0 && reflectance <= 1))
    throw InputError(fmt::format("`sensor_reflectance` is {:g}; 0 to 1 would be right", reflectance));
  if (!(microlens_sag_um >= 0 && microlens_sag_um <= 100))
    throw InputError(fmt::format("microlenses {:g} um deep; 0 to 100 would be right", microlens_sag_um));
  if (microlens_sag_um > 0 && !(pitch_um > 0))
    throw InputError(fmt::format("microlenses {:g} um wide; more than 0 would be right", pitch_um));
}

SensorReflection reflection_of(const Sensor& sensor) {
  return {sensor.reflectance.value_or(0.0), sensor.geometry.pitch_um, sensor.microlens_sag_um};
}

std::vector<GratingOrder> pixel_grating_orders(const SensorReflection& sensor, double wavelength_nm,
                                               double neglected_share) {
  if (sensor.microlens_sag_um == 0) return {{0, 0, 1}};
  const double wavelength_um = wavelength_nm * 1e-3;
  // From one grazing direction to the other.
  const int most = static_cast<int>(2 * sensor.pitch_um / wavelength_um);
  const std::vector<double> shares = side_shares(sensor.microlens_sag_um, wavelength_um, most);
  std::vector<GratingOrder> orders;
  for (int up = -most; up <= most; ++up)
    for (int right = -most; right <= most; ++right)
      orders.push_back({right, up,
                        shares[static_cast<std::size_t>(std::abs(right))] *
                            shares[static_cast<std::size_t>(std::abs(up))]});
  std::ranges::stable_sort(orders, [](const auto& a, const auto& b) { return a.share > b.share; });
  double sum = 0;
  std::size_t kept = 0;
  while (kept < orders.size() && sum < 1 - neglected_share) sum += orders[kept++].share;
  orders.resize(kept);
  return orders;
}

}  // namespace petzval
