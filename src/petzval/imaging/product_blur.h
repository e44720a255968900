// SPDX-License-Identifier: BSD-3-Clause
// Shift-variant blur by product convolution: fast, with an error that the user sets.
#pragma once

#include <petzval/imaging/direct_blur.h>
#include <petzval/imaging/transform_blur.h>

#include <memory>
#include <utility>
#include <variant>

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
/// places if the PSFs are mirror symmetric. Product convolution: Nagy & O'Leary 1998 (SIAM J. Sci. Comput.
/// 19, 1063) with piecewise constant and linear weights; Escande & Weiss 2017 (J. Math. Imaging Vis. 59, 31).
///
/// A plan may have larger tiles nearer to the axis. Between the zones light passes from one to the other
/// within some cells, its shares adding up to all of it.
///
/// The sums are made by Fourier transforms or directly, as the plan says. Cells of the ring that it names
/// get kernels of their own (blur_exact()).
class ProductBlur {
 public:
  /// Makes the kernels of all nodes. \param grid  of the source planes.
  /// \param psfs  outlive the blur. \param memory  of another blur, to be used again.
  ProductBlur(const PsfField& psfs, const SensorGeometry& grid, const ProductPlan& plan,
              TransformBlur::KernelSets memory = {})
      : psfs_(&psfs),
        by_(plan.direct ? By(std::in_place_type<DirectBlur>, psfs, grid, plan)
                        : By(std::in_place_type<TransformBlur>, psfs, grid, plan, std::move(memory))),
        inner_(plan.inner.empty() ? nullptr : std::make_unique<ProductBlur>(psfs, grid, plan.inner.front())) {
  }
  TransformBlur::KernelSets take_memory() && {
    auto* by_transforms = std::get_if<TransformBlur>(&by_);
    return by_transforms != nullptr ? std::move(*by_transforms).take_memory() : TransformBlur::KernelSets();
  }

  /// \param source  light before blur on the grid; nothing comes from outside it.
  /// \param margin  the result is the grid less this many cells on every side. Same bytes for any number of
  /// threads. \throws InputError if the source has another grid.
  CellPlane blur(const CellPlane& source, int margin) const;

  const ProductPlan& plan() const {
    return std::visit([](const auto& by) -> const ProductPlan& { return by.plan(); }, by_);
  }

 private:
  using By = std::variant<DirectBlur, TransformBlur>;
  CellPlane blur_by_product(CellPlane source, int margin) const;

  const PsfField* psfs_;
  By by_;
  std::unique_ptr<const ProductBlur> inner_;  ///< of the zone nearer to the axis; null without zones
};

}  // namespace petzval
