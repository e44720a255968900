// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/encircled_energy.h>
#include <petzval/analysis/field_rows.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/analysis/pupil_rays.h>
#include <petzval/base/units.h>
#include <petzval/numeric/bessel.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

constexpr double largest_radius_um = 1e4;
constexpr std::size_t chosen_radii = 32;
constexpr int cells_per_usual = 3;
constexpr int most_cells = 1024;
/// Strips that a cell on the edge of a circle is cut into.
constexpr int strips = 32;

/// Share of the square of half-width ½ about (x, y) that lies within `radius` of the origin.
double share_inside(double x, double y, double radius) {
  const double half_diagonal = std::sqrt(0.5), distance = std::hypot(x, y);
  if (distance + half_diagonal <= radius) return 1;
  if (distance - half_diagonal >= radius) return 0;
  double share = 0;
  for (int i = 0; i < strips; ++i) {
    const double at = y - 0.5 + (i + 0.5) / strips, reach_sq = radius * radius - at * at;
    if (reach_sq <= 0) continue;
    const double reach = std::sqrt(reach_sq);
    share += std::max(0.0, std::min(x + 0.5, reach) - std::max(x - 0.5, -reach)) / strips;
  }
  return share;
}

struct Centre {
  double s_um = 0, t_um = 0;
};

Centre centroid(const Psf& psf) {
  Centre centre;
  for (int i = 0; i < psf.size; ++i)
    for (int j = 0; j < psf.size; ++j) {
      centre.s_um += psf.at(i, j) * (j - psf.size / 2) * psf.spacing_um;
      centre.t_um += psf.at(i, j) * (i - psf.size / 2) * psf.spacing_um;
    }
  return centre;
}

/// One field at one wavelength, with all its radii.
struct EncircledCurve {
  double field = 0, wavelength_nm = 0;
  std::vector<EncircledEnergyRow> rows;
};

/// The usual window in finer cells, or a wider one when a radius asks for it.
PsfOptions fine_window(const PsfPlan& usual, double radius_um) {
  const double width_um = std::max(usual.size * usual.spacing_um, 2.2 * radius_um);
  PsfOptions options;
  options.spacing_um =
      std::max(usual.spacing_um / (usual.samples_per_cell == 1 ? cells_per_usual : 1), width_um / most_cells);
  options.size = std::min(most_cells, static_cast<int>(std::ceil(width_um / options.spacing_um))) | 1;
  return options;
}

std::optional<EncircledCurve> curve_of(const FieldTracer& tracer, const ChiefRay& chief,
                                       const EncircledEnergyOptions& options) {
  const std::optional<PsfPlan> usual = plan_psf(tracer, chief);
  if (!usual) return {};
  std::vector<double> radii = options.radii_um;
  const double largest = radii.empty() ? 0 : *std::max_element(radii.begin(), radii.end());
  const std::optional<Psf> psf = point_spread(tracer, chief, fine_window(*usual, largest));
  if (!psf) return {};
  const Centre centre = options.about_centroid ? centroid(*psf) : Centre{};
  if (radii.empty()) {
    const double most = psf->half_width_um() - std::hypot(centre.s_um, centre.t_um) - psf->spacing_um;
    for (std::size_t i = 0; i < chosen_radii; ++i)
      radii.push_back(most * static_cast<double>(i) / (chosen_radii - 1));
  }
  const std::vector<double> shares = encircled_energy(*psf, radii, centre.s_um, centre.t_um);
  const double solid_angle = exit_solid_angle_sr(tracer, pupil_rays(tracer, chief));
  const double lambda_n_um =
      tracer.tracer().wavelength_nm() * mm_per_nm * std::sqrt(pi / (4 * solid_angle)) * um_per_mm;
  EncircledCurve curve;
  for (std::size_t i = 0; i < radii.size(); ++i)
    curve.rows.push_back({0, 0, radii[i], shares[i], airy_encircled_energy(radii[i], lambda_n_um)});
  return curve;
}

}  // namespace

std::vector<double> encircled_energy(const Psf& psf, std::span<const double> radii_um, double s_um,
                                     double t_um) {
  std::vector<double> shares;
  for (const double radius_um : radii_um) {
    if (!(radius_um >= 0))
      throw InputError(fmt::format("a radius of {} um; it must be zero or more", radius_um));
    // An even window reaches half a cell less on its upper sides.
    const double reach_um = psf.half_width_um() - (psf.size % 2 == 0 ? 0.5 * psf.spacing_um : 0) -
                            std::max(std::abs(s_um), std::abs(t_um));
    if (radius_um > reach_um) {
      shares.push_back(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    double sum = 0;
    for (int i = 0; i < psf.size; ++i)
      for (int j = 0; j < psf.size; ++j)
        sum +=
            psf.at(i, j) * share_inside(j - psf.size / 2 - s_um / psf.spacing_um,
                                        i - psf.size / 2 - t_um / psf.spacing_um, radius_um / psf.spacing_um);
    shares.push_back(psf.captured * sum);
  }
  return shares;
}

double airy_encircled_energy(double radius_um, double lambda_n_um) {
  const double x = pi * radius_um / lambda_n_um;
  const double j0 = bessel_j0(x), j1 = bessel_j1(x);
  return 1 - j0 * j0 - j1 * j1;
}

std::vector<EncircledEnergyRow> encircled_energy_table(const Lens& lens, const FieldTableRequest& request,
                                                       const EncircledEnergyOptions& options) {
  for (const double radius : options.radii_um)
    if (!(radius >= 0 && radius <= largest_radius_um))
      throw InputError(
          fmt::format("a radius of {:g} um; 0 to {:g} um would be right", radius, largest_radius_um));
  std::vector<EncircledEnergyRow> rows;
  for (EncircledCurve& curve : field_rows<EncircledCurve>(
           lens, request,
           [&](const FieldTracer&tracer, const ChiefRay&chief) { return curve_of(tracer, chief, options); }))
    for (EncircledEnergyRow& row : curve.rows) {
      row.field = curve.field;
      row.wavelength_nm = curve.wavelength_nm;
      rows.push_back(row);
    }
  return rows;
}

}  // namespace petzval
