// SPDX-License-Identifier: BSD-3-Clause
// Rays that a ray transfer is fitted to: of a lens, or of a table that another program made.
#pragma once

#include <petzval/analysis/transfer_fit.h>

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

namespace petzval {

constexpr int highest_transfer_degree = 7;

/// One ray at the rear plane and what the lens makes of it.
struct TransferSample {
  TransferRay rear, front;
  std::vector<std::array<double, 2>> at_apertures;  ///< and on the film, last
};

/// Everything that a fit of some terms needs, by wavelength.
struct TransferSamples {
  std::vector<double> wavelengths_nm;
  std::vector<std::vector<TransferSample>> fitted, held;  ///< held out: what the fit is judged by
  std::vector<std::optional<Eigen::Matrix2d>> first;      ///< order, against the light; absent: not known
  double unit_mm = 0;                                     ///< the largest radius on the rear plane
  double film_radius_mm = 0;
  std::vector<double> radii_mm;  ///< of the apertures, without the film
};

/// Rays from film points through the pupil and a little beyond its rim. \throws InputError for a request
/// without sense, and for a lens that has no ray transfer.
TransferSamples transfer_samples(const Lens& lens, const TransferFitRequest& request);

/// Rays of a table, every fourth of those that pass held out. \throws InputError for a request without sense,
/// and for too few rays.
TransferSamples transfer_samples(const RayTable& table, const TransferFitRequest& request);

}  // namespace petzval
