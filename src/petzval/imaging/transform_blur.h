// SPDX-License-Identifier: BSD-3-Clause
// The product convolution by Fourier transforms.
#pragma once

#include <petzval/base/unset_vector.h>
#include <petzval/imaging/cell_plane.h>
#include <petzval/imaging/product_layout.h>
#include <petzval/imaging/product_plan.h>
#include <petzval/imaging/tile_blur.h>

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace petzval {

/// The sums of ProductBlur by Fourier transforms (tile_blur.h). Pairs of mirrored places, whose kernels are
/// the same, are real and imaginary part of one tile.
class TransformBlur {
 public:
  /// Transfer functions of kernels that are shared by mirrored places: [node down][node across].
  using KernelSet = UnsetVector<float, AlignedAllocator<float>>;
  /// As many as kernel_set_count() says.
  using KernelSets = std::vector<KernelSet>;

  /// Makes the transfer functions of all nodes. \param grid  of the source planes. \param memory  of another
  /// blur that is no longer needed, to be used again.
  TransformBlur(const PsfField& psfs, const SensorGeometry& grid, const ProductPlan& plan,
                KernelSets memory = {});
  KernelSets take_memory() && { return std::move(sets_); }

  /// As ProductBlur::blur().
  CellPlane blur(const CellPlane& source, int margin) const;

  const ProductPlan& plan() const { return plan_; }

 private:
  /// Two quadrants that share all kernels, as real and imaginary part; or one alone, the other part dark.
  struct QuadrantPair {
    Quadrant real;
    std::optional<Quadrant> imaginary = {};
  };
  /// Tiles [first, end) of a pair of quadrants, counted row by row, which are added to the result together.
  struct TileRun {
    std::size_t set = 0;
    QuadrantPair pair;
    int first = 0, end = 0;
  };
  class Light;
  static std::vector<QuadrantPair> pairs_of(std::size_t set, std::size_t set_count);
  /// All runs in the order in which they are added to the result.
  std::vector<TileRun> runs() const;
  std::size_t nodes_across() const { return phases() * static_cast<std::size_t>(tiles_across_) + 1; }
  std::size_t nodes_down() const { return phases() * static_cast<std::size_t>(tiles_down_) + 1; }
  std::size_t phases() const { return nodes_.size() - 1; }
  void make_kernels(const PsfField& psfs, const Quadrant& quadrant, KernelSet& set) const;
  TileMixture mixture_of(std::size_t set, int tile) const;
  void add(const float* blurred, const QuadrantPair& pair, int tile, int margin, CellPlane& result) const;

  ProductPlan plan_;
  SensorGeometry grid_;
  OutwardAxis across_, down_;
  TileTransform transform_;
  int radius_, tiles_across_, tiles_down_;
  std::vector<double> nodes_;
  AlignedVector<float> weights_;  ///< [node][cell along a side]
  KernelSets sets_;
};

}  // namespace petzval
