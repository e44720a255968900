// SPDX-License-Identifier: BSD-3-Clause
// Shift-variant blur by product convolution: fast, with an error that the user sets.
#pragma once

#include <petzval/base/progress.h>
#include <petzval/imaging/cell_plane.h>
#include <petzval/imaging/lane_blur.h>
#include <petzval/imaging/product_layout.h>
#include <petzval/imaging/product_plan.h>

#include <array>
#include <vector>

namespace petzval {

/// A plane's blur, ready to be applied to any light on that plane:
///
///     y = Σ_tiles Σ_ab h(x_a, y_b) ∗ [ℓ_a(x) ℓ_b(y) · light]
///
/// with ℓ the Lagrange polynomials of n Chebyshev-Lobatto nodes along each side of a tile: every source cell
/// has its own mixture of the n² kernels at the nodes of its tile. The mixture is indexed by the source, as
/// the physics is, and since Σℓ = 1 and every kernel sums to 1 the energy is exact. From three nodes on
/// weights can be negative: a mixture may go below zero by about the tolerance times its peak, which is left
/// as it is, so that the energy stays exact.
///
/// Tiles lie symmetric about the axis. A kernel serves the place opposite the axis too, and all four mirrored
/// places if the PSFs are mirror symmetric; pairs of them are real and imaginary part of one transform, and
/// the lanes of a vector are tiles side by side (lane_blur.h). Product convolution: Nagy & O'Leary 1998 (SIAM
/// J. Sci. Comput. 19, 1063) with piecewise constant and linear weights; Escande & Weiss 2017 (J. Math.
/// Imaging Vis. 59, 31).
class ProductBlur {
 public:
  /// Makes the transfer functions of all nodes. \param grid  of the source planes.
  ProductBlur(const PsfField& psfs, const SensorGeometry& grid, const ProductPlan& plan);

  /// \param source  light before blur on the grid; nothing comes from outside it.
  /// \param margin  the result is the grid less this many cells on every side. Same bytes for any number of
  /// threads. \throws InputError if the source has another grid.
  CellPlane blur(const CellPlane& source, int margin) const;

  const ProductPlan& plan() const { return plan_; }

 private:
  friend class ProductTileIo;
  /// Transfer functions of kernels that are shared by mirrored places: [phase][frequency]{re, im}[node].
  struct KernelSet {
    AlignedVector<float> otfs;
  };
  /// Lanes are counted over tiles row by row, with one idle lane at the end of each row, so that the next
  /// node along either side is always the same number of lanes away.
  std::size_t lanes_per_row() const { return static_cast<std::size_t>(tiles_across_) + 1; }
  std::size_t tile_lanes() const { return lanes_per_row() * static_cast<std::size_t>(tiles_down_); }
  std::size_t phase_floats() const;
  void make_kernels(const PsfField& psfs, bool mirrored, KernelSet& set) const;
  std::vector<const float*> otfs_of(const KernelSet& set, std::size_t first_lane) const;

  ProductPlan plan_;
  SensorGeometry grid_;
  OutwardAxis across_, down_;
  LaneTransform transform_;
  int radius_, tiles_across_, tiles_down_;
  std::size_t batches_, nodes_padded_;
  std::vector<double> nodes_;
  AlignedVector<float> weights_;  ///< [node][cell along a side]
  std::vector<KernelSet> sets_;   ///< one if the PSFs are mirror symmetric, else two
};

}  // namespace petzval
