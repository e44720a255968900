// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/product_layout.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace petzval {

std::size_t kernel_set_count(KernelSymmetry symmetry) {
  switch (symmetry) {
    case KernelSymmetry::mirrored:
      return 1;
    case KernelSymmetry::turned:
      return 2;
    case KernelSymmetry::none:
      break;
  }
  return 4;
}

std::size_t kernel_set(const Quadrant& quadrant, std::size_t set_count) {
  if (set_count == 1) return 0;
  if (set_count == 2) return quadrant.right == quadrant.below ? 0 : 1;
  return (quadrant.right ? 0U : 1U) + (quadrant.below ? 0U : 2U);
}

std::vector<Quadrant> quadrants_of_set(std::size_t set, std::size_t set_count) {
  std::vector<Quadrant> quadrants;
  for (const Quadrant quadrant :
       {Quadrant{true, true}, Quadrant{false, true}, Quadrant{true, false}, Quadrant{false, false}})
    if (kernel_set(quadrant, set_count) == set) quadrants.push_back(quadrant);
  return quadrants;
}

TilesInZone::TilesInZone(const CellRing& zone, const OutwardAxis& across, const OutwardAxis& down, int tile)
    : tiles_across_(static_cast<std::size_t>((across.count() + tile - 1) / tile)),
      tiles_down_(static_cast<std::size_t>((down.count() + tile - 1) / tile)),
      taken_(tiles_across_ * tiles_down_) {
  for (std::size_t row = 0; row < tiles_down_; ++row)
    for (std::size_t column = 0; column < tiles_across_; ++column) {
      const auto radius = [&](int into) {
        const double x = across.position(double(column) * tile + into),
                     y = down.position(double(row) * tile + into);
        return std::sqrt(x * x + y * y);  // std::hypot() is slower
      };
      taken_[row * tiles_across_ + column] = radius(0) < zone.to && radius(tile - 1) >= zone.from;
    }
}

double TilesInZone::share() const {
  return double(std::count(taken_.begin(), taken_.end(), 1)) / double(taken_.size());
}

std::vector<char> TilesInZone::nodes(std::size_t phases) const {
  const std::size_t across = phases * tiles_across_ + 1;
  std::vector<char> needed(across * (phases * tiles_down_ + 1));
  for (std::size_t tile = 0; tile < taken_.size(); ++tile) {
    if (taken_[tile] == 0) continue;
    const std::size_t first = tile / tiles_across_ * phases * across + tile % tiles_across_ * phases;
    for (std::size_t row = 0; row <= phases; ++row)
      std::fill_n(needed.begin() + static_cast<std::ptrdiff_t>(first + row * across), phases + 1, 1);
  }
  return needed;
}

std::vector<double> lobatto_nodes(int count) {
  std::vector<double> nodes;
  for (int a = 0; a < count; ++a) nodes.push_back((1 - std::cos(std::numbers::pi * a / (count - 1))) / 2);
  return nodes;
}

std::vector<double> lagrange_weights(const std::vector<double>& nodes, double at) {
  std::vector<double> weights(nodes.size(), 1.0);
  for (std::size_t a = 0; a < nodes.size(); ++a)
    for (std::size_t b = 0; b < nodes.size(); ++b)
      if (b != a) weights[a] *= (at - nodes[b]) / (nodes[a] - nodes[b]);
  return weights;
}

}  // namespace petzval
