// SPDX-License-Identifier: BSD-3-Clause
// How tiles cover a grid of cells, from the optical axis outwards, and where their kernels are taken.
#pragma once

#include <petzval/imaging/kernel_maker.h>

#include <cstddef>
#include <limits>
#include <vector>

namespace petzval {

/// Cells whose distance from the axis lies between two radii [cells].
struct CellRing {
  double from = std::numeric_limits<double>::infinity(), to = from;

  bool empty() const { return !(from < to); }
  bool holds(double radius) const { return radius >= from && radius < to; }
};
inline constexpr CellRing whole_frame{0, std::numeric_limits<double>::infinity()};

/// One of the four quarters of a grid about the axis.
struct Quadrant {
  bool right, below;
};
/// Sets of kernels that a grid needs, one for each of the quadrants that differ: 1, 2 or 4.
std::size_t kernel_set_count(KernelSymmetry symmetry);
/// The set that a quadrant's kernels belong to.
std::size_t kernel_set(const Quadrant& quadrant, std::size_t set_count);
/// The quadrants of a set; its kernels are made for the first of them.
std::vector<Quadrant> quadrants_of_set(std::size_t set, std::size_t set_count);

/// Cells along one axis of a grid, counted from the optical axis outwards on both sides. With an odd number
/// of cells the one in the middle belongs to both sides, half of its light to each.
class OutwardAxis {
 public:
  explicit OutwardAxis(int cells) : cells_(cells) {}
  /// On one side.
  int count() const { return (cells_ + 1) / 2; }
  /// Distance of a cell's centre from the axis [cells].
  double position(double outward) const { return odd() ? outward : outward + 0.5; }
  /// Of the cell in the grid, on the side of growing or falling numbers; beyond the grid too.
  int cell(int outward, bool growing) const {
    return growing ? cells_ / 2 + outward : (cells_ - 1) / 2 - outward;
  }
  float share(int outward) const { return odd() && outward == 0 ? 0.5F : 1.0F; }

 private:
  bool odd() const { return cells_ % 2 != 0; }
  int cells_;
};

/// Tiles of a quadrant that have cells in a ring.
class TilesInZone {
 public:
  TilesInZone(const CellRing& zone, const OutwardAxis& across, const OutwardAxis& down, int tile);
  /// Their share of all tiles.
  double share() const;
  /// Which nodes they need: [node down][node across]. \param phases  nodes from tile to tile.
  std::vector<char> nodes(std::size_t phases) const;

 private:
  std::size_t tiles_across_, tiles_down_;
  std::vector<char> taken_;  ///< [tile down][tile across]
};

/// Chebyshev-Lobatto nodes on [0, 1]: the ends and, between them, (1 − cos(πa/(n − 1)))/2. Neighbouring tiles
/// share the nodes between them, so that a kernel is made once for all of them, and mixtures of kernels go on
/// without a jump from one tile to the next.
std::vector<double> lobatto_nodes(int count);

/// The Lagrange polynomials of these nodes at `at`; they sum to 1.
std::vector<double> lagrange_weights(const std::vector<double>& nodes, double at);

}  // namespace petzval
