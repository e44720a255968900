// SPDX-License-Identifier: BSD-3-Clause
// How much of a point's light falls within a circle.
#pragma once

#include <petzval/analysis/field_tables.h>
#include <petzval/wave/psf.h>

#include <span>
#include <vector>

namespace petzval {

/// Shares of all light (`captured` counts) within circles of these radii about (s, t) [µm]. Each value of the
/// PSF is light spread evenly over its cell; cells that a circle cuts are shared by area. NaN where the
/// circle leaves the window: nothing is known there. \throws InputError for a negative radius.
std::vector<double> encircled_energy(const Psf& psf, std::span<const double> radii_um, double s_um = 0,
                                     double t_um = 0);

/// 1 − J0²(πr/λN) − J1²(πr/λN): the Airy pattern's (Rayleigh 1881; Born & Wolf, section 8.5.2).
double airy_encircled_energy(double radius_um, double lambda_n_um);

struct EncircledEnergyRow {
  double field = 0, wavelength_nm = 0;
  double radius_um = 0;
  double encircled_energy = 0;
  double airy = 0;  ///< of a circular exit pupil of the same solid angle, without aberration
};

struct EncircledEnergyOptions {
  std::vector<double> radii_um;  ///< empty: 32 of them out to where the window ends
  bool about_centroid = true;    ///< else about the chief ray's point
};

/// Rows in the order fields × wavelengths × radii, from PSFs in cells of a third of the usual spacing, with
/// windows as wide as the largest radius. \throws InputError naming a field at which no ray passes, or for
/// radii that are negative or beyond 10 mm.
std::vector<EncircledEnergyRow> encircled_energy_table(const Lens& lens, const FieldTableRequest& request,
                                                       const EncircledEnergyOptions& options = {});

}  // namespace petzval
