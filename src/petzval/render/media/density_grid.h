// SPDX-License-Identifier: BSD-3-Clause
// How dense a medium is from place to place.
#pragma once

#include <petzval/render/media/grid_blocks.h>
#include <petzval/render/media/grid_samples.h>
#include <petzval/render/media/lots.h>
#include <petzval/render/transform.h>

#include <optional>

namespace petzval::render {

/// Samples at the centres of cells that fill a box, with straight lines between them that fall to 0 half a
/// cell outside of the outermost, and nothing outside of the box (pbrt-v4's "uniformgrid"). Light is followed
/// by null collisions (Woodcock 1965; Novák, Selle & Jarosz, ACM Trans. Graph. 33 (2014) 6), bounded from
/// above in blocks of cells.
class DensityGrid {
 public:
  /// \param size  cells along x, y and z. \param values  x fastest; none negative. \param low, high  corners
  /// of the box. \param world_from_medium  affine.
  DensityGrid(std::array<int, 3> size, std::vector<float> values, Vector3 low, Vector3 high,
              const Transform& world_from_medium);

  double at(Vector3 world) const;
  double at_unit(const UnitPlace& place) const { return samples_.at(place); }
  double greatest() const { return greatest_; }
  /// Across the box from corner to corner [scene units].
  double diagonal() const;

  /// One that may be real or not.
  struct Collision {
    UnitPlace place;
    double distance;
    double bound;  ///< of the density there
  };
  /// visit(collision) for collisions whose density is a bound of the density times `per_density`, until it
  /// returns false. \param way  unit; up to `distance`, which may be infinite. Returns ∫ bound dt to there.
  template <class Visit>
  double each_collision(Vector3 origin, Vector3 way, double distance, double per_density, Lots& lots,
                        Visit&& visit) const;

  /// What a walk has met of the collisions.
  struct Walk {
    double bound_depth = 0;            ///< ∫ bound dt
    int collisions = 0;                ///< with the one that it ended at
    double survived = 1;               ///< ∏ (1 − density/bound) over those that were not real
    std::optional<double> stopped_at;  ///< distance of the first real one, if they stop
  };
  /// As each_collision().
  Walk walk(Vector3 origin, Vector3 way, double distance, double per_density, bool stops, Lots& lots) const;

 private:
  double bound_of(std::array<int, 3> block) const;

  GridSamples samples_;
  std::array<int, 3> blocks_;
  std::vector<float> bounds_;
  double greatest_;
  Transform world_from_unit_;  ///< from the unit cube
};

template <class Visit>
double DensityGrid::each_collision(Vector3 origin, Vector3 way, double distance, double per_density,
                                   Lots& lots, Visit&& visit) const {
  const Vector3 from = world_from_unit_.inverse_point(origin),
                along = world_from_unit_.inverse_direction(way);
  double depth = 0;
  for (GridBlocks blocks(blocks_, {from.x, from.y, from.z}, {along.x, along.y, along.z}, distance);
       blocks.any(); blocks.advance()) {
    const auto bound = static_cast<double>(bounds_[blocks.index()]);
    if (!(bound > 0)) continue;
    const double end = blocks.to();
    for (double t = blocks.from();;) {
      const double free = per_density > 0 ? -std::log1p(-lots.next()) / (per_density * bound) : end - t;
      if (!(t + free < end)) {
        depth += bound * std::max(0.0, end - t);
        break;
      }
      t += free;
      depth += bound * free;
      const Collision collision{{from.x + t * along.x, from.y + t * along.y, from.z + t * along.z}, t, bound};
      if (!visit(collision)) return depth;
    }
  }
  return depth;
}

}  // namespace petzval::render
