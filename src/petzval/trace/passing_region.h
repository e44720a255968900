// SPDX-License-Identifier: BSD-3-Clause
// Which rays of a pencil pass every aperture, by a grid zoomed onto those that do: sees parts of a pupil that
// lie apart, and holes. Bounds for sampling, and a check of find_pupil; radiometry integrates PupilBoundary.
#pragma once

#include <petzval/trace/pencil.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace petzval {

/// A box of labels (u, v) of a pencil, mirror symmetric: |u| ≤ high_u.
struct LabelBox {
  double high_u, low_v, high_v;

  double middle_v() const { return 0.5 * (low_v + high_v); }
  LabelBox hull(const LabelBox& other) const {
    return {std::max(high_u, other.high_u), std::min(low_v, other.low_v), std::max(high_v, other.high_v)};
  }
};

struct PassingRegion {
  LabelBox box;           ///< holds every grid point that passes, and one cell around it
  double cell_u, cell_v;  ///< spacing of the grid
  /// Grid points (u, v) that pass and have a neighbour that does not; u > 0 only.
  std::vector<std::pair<double, double>> outline;
  double area;  ///< ∬ du dv of the cells that pass, both halves, to about a cell around the outline

  /// The grid's half u > 0, row after row from low v; `passes` is 1 or 0.
  int columns, rows;
  std::vector<std::uint8_t> passes;

  /// Pieces that the region falls into, both halves; cells that touch at a corner belong together.
  int parts() const;
  /// Whether it encloses rays that do not pass.
  bool has_hole() const;
};

/// Traced in float. Of a lens with poses what passes at u > 0, and its mirror image; Tracer::mirrored() has
/// the rest. Nothing where no ray of the pencil passes.
std::optional<PassingRegion> find_passing_region(const Tracer& tracer, const Pencil& pencil,
                                                 Tracer::Clip clip = Tracer::Clip::apertures);

}  // namespace petzval
