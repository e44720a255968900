// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/lens/transfer_faults.h>
#include <petzval/lens/transfer_limits.h>
#include <petzval/lens/transfer_terms.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// Less of phase space than this share is a fold: lenses keep all of it, poor fits a few per cent.
constexpr double least_etendue = 0.1;

/// How much of phase space a ray's neighbours keep: the determinant of the map.
double etendue_at(const TransferData<double>& data, const TransferRay& ray, double step_mm) {
  constexpr double step = 1e-5;
  Eigen::Matrix4d slopes;
  for (int v = 0; v < 4; ++v) {
    TransferRay high = ray, low = ray;
    double TransferRay::*const which[] = {&TransferRay::x, &TransferRay::y, &TransferRay::l, &TransferRay::m};
    const double h = v < 2 ? step_mm * step : step;
    high.*which[v] += h, low.*which[v] -= h;
    const TransferRay a = carried_back(data, high).front, b = carried_back(data, low).front;
    slopes.col(v) = Eigen::Vector4d(a.x - b.x, a.y - b.y, a.l - b.l, a.m - b.m) / (2 * h);
  }
  return slopes.determinant();
}

void check_numbers(const RayTransfer& t) {
  const auto positive = [](double value) { return std::isfinite(value) && value > 0; };
  if (!positive(t.length_mm)) throw InputError("its length from plane to plane must be positive, in mm");
  if (!positive(t.unit_mm) || !positive(t.largest_radius_mm))
    throw InputError("its unit and its largest radius must be positive, in mm");
  if (t.bands.empty() || t.bands.size() > most_transfer_bands)
    throw InputError(
        fmt::format("it has {} wavelengths; 1 to {} are right", t.bands.size(), most_transfer_bands));
  if (t.terms.empty()) throw InputError("it has no terms; at least those of first order are needed");
  for (const TransferPowers& powers : t.terms)
    for (const int power : powers)
      if (power < 0 || output_degree(t.variables, powers) > static_cast<int>(most_transfer_degree))
        throw InputError(
            fmt::format("a term with the powers [{}, {}, {}]; they are 0 or more, and of degree {} "
                        "together at most",
                        powers[0], powers[1], powers[2], most_transfer_degree));
  if (closed(t.terms).size() > most_transfer_terms)
    throw InputError(fmt::format("it has more terms than the {} that are traced", most_transfer_terms));
  if (t.aperture_radii_mm.empty() || t.aperture_radii_mm.size() > most_transfer_apertures ||
      !std::all_of(t.aperture_radii_mm.begin(), t.aperture_radii_mm.end(), positive))
    throw InputError(
        fmt::format("it must have 1 to {} apertures with positive radii in mm", most_transfer_apertures));
  double last_nm = 0;
  for (const RayTransfer::Band& band : t.bands) {
    if (!(positive(band.wavelength_nm) && band.wavelength_nm > last_nm))
      throw InputError("its wavelengths must be positive, in nm, each longer than the last");
    last_nm = band.wavelength_nm;
    if (band.ellipses.has_value() != t.bands.front().ellipses.has_value())
      throw InputError("all of its wavelengths must have ellipses, or none");
    if (band.coefficients.size() != outputs_of(t))
      throw InputError(fmt::format("it has {} polynomials at {:g} nm; {} are right", band.coefficients.size(),
                                   band.wavelength_nm, outputs_of(t)));
    for (const std::vector<double>& each : band.coefficients) {
      if (each.size() != t.terms.size())
        throw InputError(fmt::format("a polynomial at {:g} nm has {} coefficients for {} terms",
                                     band.wavelength_nm, each.size(), t.terms.size()));
      if (!std::all_of(each.begin(), each.end(), [](double c) { return std::isfinite(c); }))
        throw InputError("its coefficients must be finite");
    }
  }
}

void check_ellipses(const RayTransfer& t) {
  for (const RayTransfer::Band& band : t.bands) {
    if (!band.ellipses) continue;
    const RayTransfer::Ellipses& e = *band.ellipses;
    const std::size_t count = e.positions_mm.size();
    if (count < 2 || e.radius_x_mm.size() != count || e.radius_y_mm.size() != count ||
        e.centre_y_mm.size() != count)
      throw InputError(
          "the ellipses that pass must have as many radii and centres as positions, two or more");
    if (!(std::isfinite(e.plane_mm) && e.plane_mm != 0))
      throw InputError(
          "the ellipses must stand at a distance from the rear plane that is a number and not 0");
    const double step = e.positions_mm.back() / static_cast<double>(count - 1);
    for (std::size_t i = 0; i < count; ++i) {
      if (!(std::abs(e.positions_mm[i] - step * static_cast<double>(i)) < 1e-3 * step))
        throw InputError("positions of ellipses must go up in even steps from 0");
      if (!(std::isfinite(e.radius_x_mm[i]) && std::isfinite(e.radius_y_mm[i]) && e.radius_x_mm[i] >= 0 &&
            e.radius_y_mm[i] >= 0 && std::isfinite(e.centre_y_mm[i])))
        throw InputError("radii of ellipses must be 0 or more, and their centres numbers, in mm");
    }
    if (!(e.radius_x_mm[0] > 0 && e.radius_y_mm[0] > 0))
      throw InputError("its domain is empty: no ray of the axis passes");
  }
}

}  // namespace

void require_sound(const RayTransfer& transfer) {
  check_numbers(transfer);
  check_ellipses(transfer);
}

void require_unfolded(const RayTransfer& t, const TransferData<double>& data, double nm) {
  const std::vector<TransferRay> rays = domain_rays(data, t.largest_radius_mm, check_radii, check_across);
  if (rays.empty()) throw InputError("its domain is empty: no ray passes");
  for (const TransferRay& ray : rays) {
    // On the axis itself turned polynomials have no slope.
    if (ray.y < 0.05 * t.largest_radius_mm && t.variables == TransferVariables::turned) continue;
    const TransferRay front = carried_back(data, ray).front;
    if (!(front.l * front.l + front.m * front.m < 1))
      throw InputError(
          fmt::format("its polynomials at {:g} nm turn a ray {:.3g} mm from the axis round: "
                      "direction cosines beyond 1",
                      nm, ray.y));
    const double kept = etendue_at(data, ray, t.largest_radius_mm);
    if (!(kept > least_etendue && kept < 1 / least_etendue))
      throw InputError(
          fmt::format("its polynomials at {:g} nm fold {:.3g} mm from the axis: of the light there, {:.3g} "
                      "arrives where all of it should",
                      nm, ray.y, kept));
  }
}

}  // namespace petzval
