// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/product_layout.h>

#include <cmath>
#include <cstddef>
#include <numbers>

namespace petzval {

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
