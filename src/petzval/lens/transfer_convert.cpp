// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/lens/ray_transfer.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace petzval {

namespace {

using TermPowers = std::array<int, 3>;
using Polynomial = std::map<TermPowers, double>;

double binomial(int n, int k) {
  double result = 1;
  for (int i = 1; i <= k; ++i) result = result * (n - k + i) / i;
  return result;
}

/// Adds c A^a B^b C^c r^i dx^j dy^k, where A = r²/u², B = r dy/u and C = dx² + dy².
void add_expanded(const TermPowers& invariants, const TermPowers& times, double unit_mm, double coefficient,
                  Polynomial& to) {
  const auto [a, b, c] = invariants;
  const double scale = coefficient * std::pow(unit_mm, -(2 * a + b));
  for (int j = 0; j <= c; ++j)
    to[{2 * a + b + times[0], 2 * j + times[1], b + 2 * (c - j) + times[2]}] += scale * binomial(c, j);
}

/// x, y, dx, dy in front, in the frame in which the place is (0, r).
std::array<Polynomial, 4> expanded(const RayTransfer& transfer, const RayTransfer::Band& band) {
  std::array<Polynomial, 4> all;
  for (std::size_t t = 0; t < transfer.terms.size(); ++t)
    for (std::size_t pair = 0; pair < 2; ++pair) {
      const double by_place = band.coefficients[2 * pair][t],
                   by_direction = band.coefficients[2 * pair + 1][t];
      add_expanded(transfer.terms[t], {0, 1, 0}, transfer.unit_mm, by_direction, all[2 * pair]);
      add_expanded(transfer.terms[t], {1, 0, 0}, transfer.unit_mm, by_place, all[2 * pair + 1]);
      add_expanded(transfer.terms[t], {0, 0, 1}, transfer.unit_mm, by_direction, all[2 * pair + 1]);
    }
  return all;
}

/// Places on the rear plane at which ellipses are given, and directions across each.
constexpr std::size_t ellipse_places = 51, ellipse_across = 96;

RayTransfer::Ellipses ellipses_of(const RayTransfer& transfer, double wavelength_nm) {
  RayTransfer::Ellipses e;
  const RayTransfer::Paraxial paraxial = transfer.paraxial(wavelength_nm);
  // On the exit pupil ellipses move least with the place.
  const double pupil_mm = -paraxial.h2 / paraxial.h1;
  e.plane_mm = std::isfinite(pupil_mm) && pupil_mm != 0 ? pupil_mm : transfer.length_mm;
  const double largest = transfer.largest_radius_mm;
  std::map<double, std::vector<std::array<double, 2>>> points;
  for (const TransferRay& ray :
       domain_rays(*transfer.at(wavelength_nm), largest, ellipse_places, ellipse_across)) {
    const double along = e.plane_mm / std::sqrt(1 - ray.l * ray.l - ray.m * ray.m);
    points[ray.y].push_back({ray.l * along, ray.y + ray.m * along});
  }
  for (std::size_t i = 0; i < ellipse_places; ++i) {
    const double y = largest * static_cast<double>(i) / static_cast<double>(ellipse_places - 1);
    e.positions_mm.push_back(y);
    const auto found = points.find(y);
    double low = 0, high = 0, wide = 0;
    if (found != points.end()) {
      low = high = found->second.front()[1];
      for (const auto& [px, py] : found->second) {
        low = std::min(low, py), high = std::max(high, py), wide = std::max(wide, std::abs(px));
      }
    }
    e.centre_y_mm.push_back(i == 0 ? 0 : 0.5 * (low + high));
    e.radius_y_mm.push_back(0.5 * (high - low));
    e.radius_x_mm.push_back(wide);
  }
  return e;
}

}  // namespace

RayTransfer turned_form(const RayTransfer& transfer) {
  if (transfer.variables == TransferVariables::turned) return transfer;
  RayTransfer result;
  result.length_mm = transfer.length_mm;
  result.largest_radius_mm = transfer.largest_radius_mm;
  result.variables = TransferVariables::turned;
  std::vector<std::array<Polynomial, 4>> bands;
  std::map<TermPowers, bool> all;
  for (const RayTransfer::Band& band : transfer.bands) {
    bands.push_back(expanded(transfer, band));
    for (const Polynomial& polynomial : bands.back())
      for (const auto& [powers, unused] : polynomial) all[powers] = true;
  }
  for (const auto& [powers, unused] : all) result.terms.push_back(powers);
  for (std::size_t b = 0; b < bands.size(); ++b) {
    RayTransfer::Band band{transfer.bands[b].wavelength_nm, {}, {}};
    for (const Polynomial& polynomial : bands[b]) {
      std::vector<double> coefficients;
      for (const TermPowers& powers : result.terms) {
        const auto found = polynomial.find(powers);
        coefficients.push_back(found == polynomial.end() ? 0 : found->second);
      }
      band.coefficients.push_back(std::move(coefficients));
    }
    band.ellipses = ellipses_of(transfer, band.wavelength_nm);
    result.bands.push_back(std::move(band));
  }
  result.aperture_radii_mm = {result.bands.front().ellipses->radius_x_mm.front()};
  return result;
}

}  // namespace petzval
