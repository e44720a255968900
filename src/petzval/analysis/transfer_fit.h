// SPDX-License-Identifier: BSD-3-Clause
// A ray transfer of a lens that is traced.
#pragma once

#include <petzval/analysis/ray_table.h>
#include <petzval/lens/lens.h>
#include <petzval/lens/ray_transfer.h>

#include <optional>
#include <vector>

namespace petzval {

struct TransferFitRequest {
  std::vector<double> wavelengths_nm = {};  ///< a band each; empty: the lens's own, or all of the table
  /// What rays held out may be off by on the front plane [mm], and in direction by this over the focal
  /// length.
  double tolerance_mm = 1e-4;
  /// Invariants multiplied, at most: rays to the power 2·degree + 1; absent: the least that meets the
  /// tolerance.
  std::optional<int> degree = {};
  /// Light that lands within it counts; absent: the largest of the lens's fields, and 2 % more; of a table,
  /// that of its rays.
  std::optional<double> film_radius_mm = {};
};

/// Of rays held out, those of their own film heights and places in the pupil, over all wavelengths.
struct TransferAccuracy {
  double median_mm = 0, worst_mm = 0;    ///< front place
  double median_rad = 0, worst_rad = 0;  ///< front direction
  /// By how much the light that a film point collects is off, at the worst of some heights, as a share of it;
  /// a table does not tell.
  std::optional<double> worst_light;
  std::size_t rays = 0;
};

struct TransferFit {
  Lens lens;  ///< front plane, rear plane, film; else as the lens it was fitted to
  TransferAccuracy accuracy;
  int degree = 0;
  std::size_t terms = 0;         ///< of each of the four polynomials that carry a ray
  double determinant_error = 0;  ///< of the paraxial part, at the worst wavelength
};

/// Fits one to rays from film points through the pupil that each of them sees, and a little beyond its rim.
/// Method: place and direction in front are a q + b p with a, b polynomials in q·q, q·p and p·p of the ray at
/// the rear plane, which makes them round and mirror symmetric; by least squares, the first order fixed to
/// the paraxial matrix, so that its determinant is 1. Apertures that limit light, six at most, have
/// polynomials of the place in them, and their own radii; light beyond the film radius does not pass. Terms
/// that move no ray by a twentieth of the tolerance are left out, if the tolerance is still met. \throws
/// InputError for a lens with poses, blades at the stop, glass up to the film, and where no degree meets the
/// tolerance.
TransferFit fit_transfer(const Lens& lens, const TransferFitRequest& request = {});

/// Fits one to rays that another program traced; every fourth ray of a wavelength is held out. The first
/// order is that of a fit to the rays, its determinant then made 1. \throws InputError where there are too
/// few rays, and where no degree meets the tolerance.
///
///     const TransferFit box = fit_transfer(read_ray_table("rays.csv"));
///     write_lens(box.lens, "box.json");
///
TransferFit fit_transfer(const RayTable& table, const TransferFitRequest& request = {});

/// The rays that fit_transfer() fits a lens to, and those that it holds out.
RayTable ray_table(const Lens& lens, const TransferFitRequest& request = {});

}  // namespace petzval
