// SPDX-License-Identifier: BSD-3-Clause
// The product convolution by Fourier transforms.
#pragma once

#include <petzval/base/unset_vector.h>
#include <petzval/imaging/cell_plane.h>
#include <petzval/imaging/lane_blur.h>
#include <petzval/imaging/product_layout.h>
#include <petzval/imaging/product_plan.h>

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace petzval {

/// The sums of ProductBlur by Fourier transforms. Pairs of mirrored places, whose kernels are the same, are
/// real and imaginary part of one transform, and the lanes of a vector are tiles side by side (lane_blur.h).
class TransformBlur {
 public:
  /// Transfer functions of kernels that are shared by mirrored places: [phase][frequency]{re, im}[node], of
  /// each pair of columns of frequencies one.
  using KernelSet = UnsetVector<float, AlignedAllocator<float>>;
  /// One if the PSFs are mirror symmetric, else two.
  using KernelSets = std::vector<KernelSet>;

  /// Makes the transfer functions of all nodes. \param grid  of the source planes. \param memory  of another
  /// blur that is no longer needed, to be used again.
  TransformBlur(const PsfField& psfs, const SensorGeometry& grid, const ProductPlan& plan,
                KernelSets memory = {});
  KernelSets take_memory() && { return std::move(sets_); }

  /// As ProductBlur::blur().
  CellPlane blur(const CellPlane& source, int margin) const;

  const ProductPlan& plan() const { return plan_; }

  /// One of the four quadrants: right of the axis, below it.
  struct Quadrant {
    bool right, below;
  };
  /// Two quadrants that share all kernels, as real and imaginary part.
  using QuadrantPair = std::array<Quadrant, 2>;

 private:
  friend class TileIo;
  /// Tiles that are blurred at a time: those of the lanes from the first on, in some pairs of quadrants.
  struct Item {
    std::size_t set, first_lane;
    std::vector<QuadrantPair> pairs;
  };
  /// All tiles in the order in which they are added to the result.
  std::vector<Item> items_for(std::size_t threads) const;
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
  KernelSets sets_;
};

}  // namespace petzval
