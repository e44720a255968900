// SPDX-License-Identifier: BSD-3-Clause
// How fine the product convolution must be for the error that the user allows.
#pragma once

#include <petzval/imaging/kernel_error.h>
#include <petzval/imaging/psf_kernel.h>
#include <petzval/sensor/sensor.h>

#include <optional>
#include <vector>

namespace petzval {

/// Tiles, nodes and transforms of a product convolution.
struct ProductPlan {
  int tile = 0;                         ///< cells along a side
  int nodes = 2;                        ///< along a side of a tile
  int transform = 0;                    ///< cells along a side; tile + 2 · kernel radius fit into it
  bool direct = false;                  ///< sums are gathered (DirectBlur); else by transforms (ProductBlur)
  CellRing exact = {};                  ///< of source cells with kernels of their own
  CellRing zone = whole_frame;          ///< of source cells that the tiles serve
  std::vector<ProductPlan> inner = {};  ///< none, or one with larger tiles for the cells nearer to the axis
  /// Relative L2 error against the exact method, estimated for a texture whose contrast is 1 at every
  /// frequency: noise with a standard deviation as large as its mean. Edges and smoother pictures come out
  /// better; an image of single points in darkness up to 1/√Σh² worse, h the kernel.
  double estimated_error = 0;
  KernelError error_at_places = {};  ///< what the estimate goes by,
  RimError rim_error = {};           ///< and what it adds for the rim
  /// By the cost model [ns of one core of the machine that it was measured on]: filtering, and making the
  /// transfer functions.
  double filter_ns = 0, kernels_ns = 0;
  double exact_ns = 0;  ///< of the cells with kernels of their own

  double kernel_bytes = 0;  ///< that the kernels or their transfer functions take at a time
  int rows_held = 0;        ///< rows of tiles whose transfer functions are held at a time; 0: all

  /// The PSFs are still wanted when the blur is made.
  bool wants_psfs() const {
    return !exact.empty() || rows_held != 0 || (!inner.empty() && inner.front().wants_psfs());
  }
  double total_ns() const {
    return filter_ns + kernels_ns + exact_ns + (inner.empty() ? 0 : inner.front().total_ns());
  }
  /// Cells within which light passes from the tiles of one zone to those of the next.
  static constexpr double fade = 16;
};

struct ProductOptions {
  double tolerance = 1e-3;          ///< relative L2 error, 1e-6 to 1
  int nodes = 0;                    ///< along a side of a tile, 2 to 6; 0: chosen
  int tile = 0;                     ///< cells along a side; 0: chosen
  std::optional<bool> direct = {};  ///< gathered or by transforms; absent: as the cost model says

  /// Nothing is left to be chosen.
  bool layout_given() const { return tile != 0 && nodes != 0; }
  /// \throws InputError saying what would be right.
  void validate() const;
};

/// The cheapest plan by the cost model whose estimated error is within the tolerance; nothing if PSFs are too
/// large for the transforms of lanes, or change so fast that no tile is small enough. \param grid  of the
/// source. \param hint  what served a neighbouring band or layer: it is kept if, by a few places, it still
/// serves; a `transform` of 0 there stands for the smallest that takes its tiles.
std::optional<ProductPlan> plan_product(const PsfField& psfs, const SourceGrid& grid,
                                        const ProductOptions& options,
                                        const std::optional<ProductPlan>& hint = {});

/// Sections that fade into each other (SectionOptions::blend), which take PSFs of any size, each
/// with a transform of its own: the largest whose estimated error is within the tolerance. `transform` stays
/// 0.
ProductPlan plan_blended(const PsfField& psfs, const SourceGrid& grid, const ProductOptions& options);

}  // namespace petzval
