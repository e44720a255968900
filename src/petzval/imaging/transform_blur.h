// SPDX-License-Identifier: BSD-3-Clause
// The product convolution by Fourier transforms.
#pragma once

#include <petzval/base/unset_vector.h>
#include <petzval/imaging/cell_plane.h>
#include <petzval/imaging/node_kernel.h>
#include <petzval/imaging/product_layout.h>
#include <petzval/imaging/product_plan.h>
#include <petzval/imaging/tile_blur.h>

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace petzval {

/// The sums of ProductBlur by Fourier transforms (tile_blur.h). Pairs of mirrored places, whose kernels are
/// the same, are real and imaginary part of one tile. Transfer functions that do not fit into memory together
/// (ProductPlan::rows_held) are made for some rows of tiles at a time, whenever light is blurred.
class TransformBlur {
 public:
  /// Transfer functions of kernels that are shared by mirrored places, of the nodes that are needed: [node
  /// down][node across].
  using KernelSet = UnsetVector<float, AlignedAllocator<float>>;
  /// As many as kernel_set_count() says.
  using KernelSets = std::vector<KernelSet>;

  /// Makes the transfer functions of all nodes. \param grid  of the source planes. \param memory  of another
  /// blur that is no longer needed, to be used again. \param psfs  outlive the blur if the plan holds some
  /// rows only.
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
  /// Rows of tiles, and the transfer functions of their nodes.
  struct Strip {
    int first_row = 0, end_row = 0;
    const KernelSets* sets = nullptr;
  };
  static std::vector<QuadrantPair> pairs_of(std::size_t set, std::size_t set_count);
  /// Those of some sets in rows of tiles, in the order in which they are added to the result.
  std::vector<TileRun> runs(std::size_t first_set, std::size_t end_set, const Strip& strip) const;
  void blur_runs(const std::vector<TileRun>& all, const Strip& strip, const CellPlane& source, int margin,
                 CellPlane& result) const;
  void blur_strip_by_strip(const CellPlane& source, int margin, CellPlane& result) const;
  std::size_t nodes_across() const { return phases() * static_cast<std::size_t>(tiles_across_) + 1; }
  std::size_t nodes_down() const { return phases() * static_cast<std::size_t>(tiles_down_) + 1; }
  /// The needed nodes before a row of nodes.
  std::size_t slots_before(std::size_t row) const { return slots_[row * nodes_across()]; }
  std::size_t phases() const { return nodes_.size() - 1; }
  NodeKernels node_kernels(const PsfField& psfs, std::size_t set) const;
  /// Writes the transfer functions of rows of nodes, where they are needed.
  void make_otfs(const NodeKernels& kernels, std::size_t first_row, std::size_t end_row, float* out) const;
  TileMixture mixture_of(const Strip& strip, std::size_t set, int tile) const;
  void add(const float* blurred, const QuadrantPair& pair, int tile, int margin, CellPlane& result) const;

  ProductPlan plan_;
  const PsfField* psfs_;
  SensorGeometry grid_;
  OutwardAxis across_, down_;
  TileTransform transform_;
  int radius_, tiles_across_, tiles_down_;
  std::vector<double> nodes_;
  std::vector<char> needed_;        ///< nodes of tiles in the plan's zone: [down][across]
  std::vector<std::size_t> slots_;  ///< how many of those come before each node; one more for all
  AlignedVector<float> weights_;    ///< [node][cell along a side]
  KernelSets sets_;
};

}  // namespace petzval
