// SPDX-License-Identifier: BSD-3-Clause
// The vignetted pupil: which rays of a pencil pass every aperture.
#pragma once

#include <petzval/trace/pencil.h>

#include <array>
#include <optional>
#include <vector>

namespace petzval {

/// The region of a pencil's (u, v) that passes, as a curve around an inner point: `radius[i]` at azimuth(i),
/// counted from +v towards +u, so that (u, v) = centre + radius·(sin φ, cos φ). Of a centred lens with a
/// round stop it is mirror symmetric: centre_u = 0 and radius[i] = radius[n−1−i]. Found along azimuths by
/// root finding on the clearance of real rays at the real apertures; nothing is counted on a grid.
///
/// A stop with blades has no mirror image: its azimuths go round once, not half, and are Gauss-Legendre nodes
/// between the corners of the polygon, so that sums over them converge as if there were none. Nor has a lens
/// with poses; azimuths of its round stop go round once, evenly.
///
/// Otherwise the azimuths are those of a round pupil stretched along u: φ = atan2(s sin ψ, cos ψ), ψ = 2π(i +
/// ½)/n. A pupil that vignetting has narrowed to a sliver is sampled along its whole rim.
struct PupilBoundary {
  double centre_u = 0, centre_v = 0;
  double chief_u = 0, chief_v = 0;  ///< of the chief ray
  double stretch = 1;               ///< s: width along u over height along v
  std::vector<double> radius;
  std::vector<double> turns, turn_weights;  ///< ψ and dψ where there is no mirror image; empty: even ones

  /// Whether the half u ≥ 0 says everything.
  bool mirrored() const { return turns.empty(); }
  /// How many entries of `radius` do: half of them, or all.
  std::size_t own() const { return mirrored() ? radius.size() / 2 : radius.size(); }
  double azimuth(std::size_t i) const;
  /// (u, v) on the curve.
  std::array<double, 2> rim(std::size_t i) const;
  /// dφ of one sample; they sum to 2π.
  double azimuth_weight(std::size_t i) const;
  /// ∬ du dv inside the curve, ½ ∮ radius² dφ [mm² or sr].
  double area() const;
};

/// \param chief_v   from aim_chief_ray or ChiefRayMarch, chief_u from aim_at_stop; the search for the region
/// starts there. \param azimuths  even, ≥ 8; with blades at least so many. The corners where two apertures
/// meet make the area converge as 1/azimuths². \returns nothing when no ray of the pencil passes. \throws
/// InputError for an odd or small number of azimuths.
std::optional<PupilBoundary> find_pupil(const Tracer& tracer, const Pencil& pencil, double chief_v,
                                        int azimuths, Tracer::Clip clip = Tracer::Clip::apertures,
                                        double chief_u = 0);

/// Polar quadrature inside a boundary: Gauss-Legendre in radius × the boundary's azimuths. Of a mirrored
/// boundary only the half u ≥ 0, each node standing for its mirror image too. The weights (du dv) sum to
/// area().
struct PupilNode {
  double u, v, weight;
};
std::vector<PupilNode> pupil_nodes(const PupilBoundary& boundary, int radial_nodes);

}  // namespace petzval
