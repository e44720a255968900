// SPDX-License-Identifier: BSD-3-Clause
// Kernels at the nodes of tiles, as seen from the axis outwards.
#pragma once

#include <petzval/base/unset_vector.h>
#include <petzval/imaging/product_layout.h>
#include <petzval/imaging/psf_kernel.h>

#include <array>
#include <cstddef>
#include <vector>

namespace petzval {

/// Where a cell of a quadrant lies in image space, x' and y'.
std::array<double, 2> place_mm(const PsfField& psfs, const OutwardAxis& across, const OutwardAxis& down,
                               double column, double row, const Quadrant& quadrant);

/// The kernel at a place of a quadrant, counted from the axis [cells], rows and columns growing outwards.
Kernel kernel_at_node(const PsfField& psfs, const OutwardAxis& across, const OutwardAxis& down, double column,
                      double row, const Quadrant& quadrant);

/// The kernels at nodes that lie at the same places along both axes, one of which may go on farther. Where
/// the places of PSFs are mirror symmetric about the diagonal too, a kernel and its transpose are made once.
class NodeKernels {
 public:
  /// \param places  of nodes, increasing [cells]. \param nodes_across, nodes_down  so many of them.
  /// \param needed  those that are asked for, [down][across].
  NodeKernels(const PsfField& psfs, const OutwardAxis& across, const OutwardAxis& down,
              std::vector<double> places, std::size_t nodes_across, std::size_t nodes_down,
              const Quadrant& quadrant, const std::vector<char>& needed);
  /// Writes scale · weights to `out`. From any thread.
  void lay(std::size_t node_across, std::size_t node_down, double scale, float* out) const;

 private:
  Kernel made(std::size_t node_across, std::size_t node_down) const;
  std::size_t count() const;
  /// Of a node, or of its mirror image.
  std::size_t index(std::size_t node_across, std::size_t node_down) const;

  const PsfField& psfs_;
  OutwardAxis across_, down_;
  std::vector<double> places_;
  std::size_t nodes_across_, nodes_down_;
  Quadrant quadrant_;
  bool diagonal_;
  UnsetVector<float> weights_;  ///< empty where there is no symmetry to gain by
};

/// The Lagrange polynomials of the nodes at the cells along a side of a tile: [node][cell].
std::vector<float> cell_weights(const std::vector<double>& nodes, int tile);

}  // namespace petzval
