// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/node_kernel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace petzval {

std::array<double, 2> place_mm(const PsfField& psfs, const OutwardAxis& across, const OutwardAxis& down,
                               double column, double row, const Quadrant& quadrant) {
  const double cell_mm = psfs.cell_um() * mm_per_um;
  const double x_mm = across.position(column) * cell_mm, y_mm = down.position(row) * cell_mm;
  return {quadrant.right ? -x_mm : x_mm, quadrant.below ? y_mm : -y_mm};  // columns run along −x'
}

Kernel kernel_at_node(const PsfField& psfs, const OutwardAxis& across, const OutwardAxis& down, double column,
                      double row, const Quadrant& quadrant) {
  const std::array<double, 2> place = place_mm(psfs, across, down, column, row, quadrant);
  Kernel kernel = psfs.kernel_at(place[0], place[1]);
  if (!quadrant.right)
    for (int i = -kernel.radius; i <= kernel.radius; ++i)
      for (int j = 1; j <= kernel.radius; ++j) std::swap(kernel.at(i, j), kernel.at(i, -j));
  if (!quadrant.below)
    for (int i = 1; i <= kernel.radius; ++i)
      for (int j = -kernel.radius; j <= kernel.radius; ++j) std::swap(kernel.at(i, j), kernel.at(-i, j));
  return kernel;
}

NodeKernels::NodeKernels(const PsfField& psfs, const OutwardAxis& across, const OutwardAxis& down,
                         std::vector<double> places, std::size_t nodes_across, std::size_t nodes_down,
                         const Quadrant& quadrant, const std::vector<char>& needed)
    : psfs_(psfs),
      across_(across),
      down_(down),
      places_(std::move(places)),
      nodes_across_(nodes_across),
      nodes_down_(nodes_down),
      quadrant_(quadrant),
      diagonal_(psfs.symmetry() == KernelSymmetry::mirrored && across.position(0) == down.position(0)) {
  std::vector<std::array<double, 2>> places_mm;
  for (std::size_t j = 0; j < nodes_down_; ++j)
    for (std::size_t i = 0; i < nodes_across_; ++i)
      if (needed[j * nodes_across_ + i] != 0)
        places_mm.push_back(place_mm(psfs, across_, down_, places_[i], places_[j], quadrant));
  psfs.prepare(places_mm);

  constexpr double most_bytes = 256e6;
  const auto size = static_cast<std::size_t>(2 * psfs.radius() + 1), weights = size * size;
  if (!diagonal_ || double(count()) * double(weights) * sizeof(float) > most_bytes) return;
  weights_.resize(count() * weights);
  parallel_for(nodes_across_ * nodes_down_, [&](std::size_t node) {
    const std::size_t i = node % nodes_across_, j = node / nodes_across_;
    const bool has_image = j < nodes_across_ && i < nodes_down_;  // (j, i), which is the same transposed
    if (j > i && has_image) return;
    if (needed[node] == 0 && !(has_image && needed[i * nodes_across_ + j] != 0)) return;
    const Kernel kernel = made(i, j);
    std::copy(kernel.weights.begin(), kernel.weights.end(), weights_.data() + index(i, j) * weights);
  });
}

std::size_t NodeKernels::count() const {
  const std::size_t square = std::min(nodes_across_, nodes_down_),
                    rest = std::max(nodes_across_, nodes_down_) - square;
  return square * (square + 1) / 2 + rest * square;
}

std::size_t NodeKernels::index(std::size_t node_across, std::size_t node_down) const {
  // Rows of a triangle, and behind its square the rows of the rest.
  const std::size_t square = std::min(nodes_across_, nodes_down_);
  const std::size_t far = std::max(node_across, node_down), near = std::min(node_across, node_down);
  return far < square ? far * (far + 1) / 2 + near
                      : square * (square + 1) / 2 + (far - square) * square + near;
}

Kernel NodeKernels::made(std::size_t node_across, std::size_t node_down) const {
  return kernel_at_node(psfs_, across_, down_, places_[node_across], places_[node_down], quadrant_);
}

void NodeKernels::lay(std::size_t node_across, std::size_t node_down, double scale, float* out) const {
  if (weights_.empty()) {
    for (const double weight : made(node_across, node_down).weights)
      *out++ = static_cast<float>(scale * weight);
    return;
  }
  const auto size = static_cast<std::size_t>(2 * psfs_.radius() + 1);
  const float* weights = weights_.data() + index(node_across, node_down) * size * size;
  const bool transposed = node_down > node_across && node_down < nodes_across_ && node_across < nodes_down_;
  const std::size_t per_row = transposed ? 1 : size, per_column = transposed ? size : 1;
  const auto factor = static_cast<float>(scale);
  for (std::size_t row = 0; row < size; ++row)
    for (std::size_t column = 0; column < size; ++column)
      *out++ = factor * weights[row * per_row + column * per_column];
}

std::vector<float> cell_weights(const std::vector<double>& nodes, int tile) {
  const auto cells = static_cast<std::size_t>(tile);
  std::vector<float> result(nodes.size() * cells);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const std::vector<double> weights = lagrange_weights(nodes, double(cell) / tile);
    for (std::size_t a = 0; a < nodes.size(); ++a) result[a * cells + cell] = static_cast<float>(weights[a]);
  }
  return result;
}

}  // namespace petzval
