// SPDX-License-Identifier: BSD-3-Clause
// A lens known only by what it does to rays.
#pragma once

#include <petzval/lens/transfer_data.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace petzval {

struct Lens;

/// Rays in, rays out: from a rear plane behind the lens to a front plane before it, as polynomials, and which
/// of them pass. Goossens, Lyu, Ko, Wan, Farrell and Wandell, "Ray-transfer functions for camera simulation
/// of 3D scenes with hidden lens design", Optics Express 30 (2022) 24031.
///
/// A lens holds one at a surface, the front plane; the next surface is the rear plane. Its stop is where rays
/// are limited; with ellipses that is an idea more than a place, and its coordinates are those in which every
/// ellipse is the circle of the axis.
struct RayTransfer {
  struct Ellipses {
    double plane_mm = 0;  ///< in front of the rear plane
    /// By the place on the rear plane, evenly from 0.
    std::vector<double> positions_mm, radius_x_mm, radius_y_mm, centre_y_mm;
  };
  struct Band {
    double wavelength_nm = 0;
    /// Of each output, of each term. Outputs: invariants have front place by place, front place by direction,
    /// front direction by place, front direction by direction, then place in each aperture by place and by
    /// direction; turned ones x, y, dx, dy.
    std::vector<std::vector<double>> coefficients;
    std::optional<Ellipses> ellipses;
  };

  double length_mm = 0;          ///< from the front plane to the rear plane
  double unit_mm = 1;            ///< of places in the variables
  double largest_radius_mm = 0;  ///< on the rear plane: what goes farther out is lost
  TransferVariables variables = TransferVariables::invariants;
  std::vector<std::array<int, 3>> terms;  ///< powers of the three variables
  std::vector<double> aperture_radii_mm;  ///< the stop first; with ellipses it alone
  std::vector<Band> bands;                ///< by wavelength; one: the lens has no dispersion

  /// Linear between the bands for two of them, by the polynomial in 1/λ² through all for more.
  /// \throws InputError for a wavelength that they do not reach.
  std::shared_ptr<const TransferData<double>> at(double wavelength_nm) const;

  /// Height and slope (of light) at the front plane to those at the rear plane, determinant 1; and the stop:
  /// its height is h1 y + h2 u of the ray at the rear plane.
  struct Paraxial {
    double a = 1, b = 0, c = 0, d = 1, h1 = 1, h2 = 0;
  };
  Paraxial paraxial(double wavelength_nm) const;

  std::size_t polynomial_terms() const { return terms.size(); }

 private:
  friend std::shared_ptr<const RayTransfer> made_ready(RayTransfer transfer);
  struct Cache;
  std::shared_ptr<Cache> cache_;
};

/// Checks it. \throws InputError that says which entry is wrong: sizes, numbers that are not finite, a domain
/// that is empty, polynomials that fold (two rays of the rear plane become one in front).
std::shared_ptr<const RayTransfer> made_ready(RayTransfer transfer);

/// A ray on a plane: place [mm], and direction cosines of travel against the light.
struct TransferRay {
  double x = 0, y = 0, l = 0, m = 0;
};
/// A ray of the rear plane with what becomes of it; `passes` all apertures.
struct TransferredRay {
  TransferRay rear, front;
  bool passes = false;
};
TransferredRay carried_back(const TransferData<double>& data, const TransferRay& rear);

/// Rays of the rear plane that pass, from all over the domain, mirror images left out: places (0, y) at
/// `radii` heights from the axis to the edge, about `across`² directions each.
std::vector<TransferRay> domain_rays(const TransferData<double>& data, double largest_radius_mm,
                                     std::size_t radii, std::size_t across);

/// A transfer in invariants written in r, dx and dy, its domain by ellipses, as ISET has it: the same rays,
/// and at each place an ellipse as high and as wide. Others are returned as they are.
RayTransfer turned_form(const RayTransfer& transfer);

/// Of a lens that has no glass to speak of.
bool is_ray_transfer(const Lens& lens);
/// \throws InputError "<what> need(s) the surfaces of a lens, and <name> is known by its ray transfer alone".
void require_glass(const Lens& lens, const char* what);

}  // namespace petzval
