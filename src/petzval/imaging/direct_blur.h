// SPDX-License-Identifier: BSD-3-Clause
// The product convolution without transforms, for PSFs of a few cells.
#pragma once

#include <petzval/imaging/cell_plane.h>
#include <petzval/imaging/product_layout.h>
#include <petzval/imaging/product_plan.h>
#include <petzval/imaging/psf_kernel.h>

#include <cstddef>
#include <vector>

namespace petzval {

/// The same sums as ProductBlur, gathered directly: every cell of the result takes from the cells about it,
/// by their own mixtures of kernels. The mixture along the rows of a tile is made once a row; that along its
/// columns goes with the light, so that a cell costs nodes · (2 · radius + 1)² products and not nodes² as
/// many.
class DirectBlur {
 public:
  /// Makes the kernels of all nodes. \param grid  of the source planes.
  DirectBlur(const PsfField& psfs, const SensorGeometry& grid, const ProductPlan& plan);

  /// As ProductBlur::blur().
  CellPlane blur(const CellPlane& source, int margin) const;

  const ProductPlan& plan() const { return plan_; }

 private:
  friend class DirectStrip;
  std::size_t taps() const { return static_cast<std::size_t>(2 * radius_ + 1); }
  std::size_t nodes_across() const {
    return (nodes_.size() - 1) * static_cast<std::size_t>(tiles_across_) + 1;
  }
  const float* kernel(std::size_t set, std::size_t node_down, std::size_t node_across) const {
    return sets_[set].data() + (node_down * nodes_across() + node_across) * taps() * taps();
  }

  ProductPlan plan_;
  SensorGeometry grid_;
  OutwardAxis across_, down_;
  int radius_, tiles_across_, tiles_down_;
  std::vector<double> nodes_;
  std::vector<float> weights_;            ///< [node][cell along a side of a tile]
  std::vector<std::vector<float>> sets_;  ///< kernels, as ProductBlur has their transforms
};

}  // namespace petzval
