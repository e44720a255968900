// SPDX-License-Identifier: BSD-3-Clause
// How dense a medium is from place to place.
#pragma once

#include <petzval/render/media/lots.h>
#include <petzval/render/transform.h>

#include <array>
#include <optional>
#include <vector>

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
  double greatest() const;
  /// Across the box from corner to corner [scene units].
  double diagonal() const;

  /// What a walk has met of the collisions, real or not, whose density is a bound of the density.
  struct Walk {
    double bound_depth = 0;            ///< ∫ bound dt
    int collisions = 0;                ///< with the one that it ended at
    double survived = 1;               ///< ∏ (1 − density/bound) over those that were not real
    std::optional<double> stopped_at;  ///< distance of the first real one, if they stop
  };
  /// Collisions by the coefficient `per_density`. \param way  unit; up to `distance`, which may be infinite.
  Walk walk(Vector3 origin, Vector3 way, double distance, double per_density, bool stops, Lots& lots) const;

 private:
  class Blocks;
  double value(std::array<int, 3> cell) const;
  double at_unit(const std::array<double, 3>& p) const;
  double bound_of(std::array<int, 3> block) const;

  std::array<int, 3> size_, blocks_;
  std::vector<float> values_, bounds_;
  Transform world_from_unit_;  ///< from the unit cube
};

}  // namespace petzval::render
