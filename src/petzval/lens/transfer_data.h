// SPDX-License-Identifier: BSD-3-Clause
// What the arithmetic of a ray transfer works with, in double or float, at one wavelength.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace petzval {

/// In which variables polynomials are written. A ray on a plane is (x, y, l, m): its place q [mm] and the
/// direction cosines p of its travel.
///
/// - invariants: A = q·q/u², B = q·p/u, C = p·p, u = unit_mm; what comes out is a q + b p, a and b
///   polynomials. Round and mirror symmetric by construction.
/// - turned: r = |q|, dx, dy, the frame turned about the axis until the place is (0, r); what comes out is
///   turned back. ISET's files.
enum class TransferVariables : std::uint8_t { invariants, turned };

/// Several polynomials in three variables that share their terms.
template <class T>
struct TransferPolynomials {
  /// A term is an earlier one times a variable; the first is 1.
  struct Step {
    std::uint16_t from = 0;
    std::uint8_t variable = 0;
    std::uint8_t degree = 0;  ///< power of the ray's length (q, p) → (tq, tp) that the output grows with
  };
  TransferVariables variables = TransferVariables::invariants;
  T per_unit = 1;               ///< 1/unit_mm
  std::size_t outputs = 4;      ///< polynomials
  std::vector<Step> steps;      ///< by degree
  std::vector<T> coefficients;  ///< outputs of each step, one step after the other
};

/// Which rays pass, by ellipses on a plane, with the place on the rear plane.
template <class T>
struct TransferEllipses {
  T plane_mm = 0;                               ///< in front of the rear plane
  T per_step = 0;                               ///< knots per mm of place
  std::vector<T> radius_x, radius_y, centre_y;  ///< [mm] at each knot; empty: there are none

  bool any() const { return !radius_x.empty(); }
};

/// A ray transfer at one wavelength. Rays of the rear plane have polynomials that take them to the front
/// plane, against the light, and to each aperture; the other way is found by iteration.
template <class T>
struct TransferData {
  T length_mm = 0;                ///< from the front plane to the rear plane
  TransferPolynomials<T> back;    ///< front place and direction, and places in apertures
  TransferPolynomials<T> start;   ///< about the inverse of it: rear place and direction by those in front
  TransferEllipses<T> ellipses;   ///< of the stop, whose coordinates they scale
  T stop_radius = 1;              ///< in the stop's coordinates [mm]
  std::vector<T> other_radii_sq;  ///< of the apertures beside the stop [mm²]
  /// About the front place of the middle of the light that travels with p: p Σ centre[k] (p·p)^k.
  std::vector<T> centre;
  /// ∫ f·dg/dt over 0 ≤ t ≤ 1 is Σ path_weights[i·n + k] f(path_at[i])·g(path_at[k]).
  std::vector<T> path_at, path_weights;
  /// What the inverse may leave of a ray: the polynomials of ISET jump at the axis by so much.
  T jump_mm = 0, jump = 0;
};

/// Rounds to float.
TransferData<float> in_float(const TransferData<double>& from);

}  // namespace petzval
