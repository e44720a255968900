// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/product_layout.h>

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
