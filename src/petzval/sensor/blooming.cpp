// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/sensor/blooming.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace petzval {

void bloom_column(std::span<double> electrons, double capacity_e) {
  std::vector<double> half(electrons.size());
  for (std::size_t i = 0; i < electrons.size(); ++i) {
    half[i] = std::max(electrons[i] - capacity_e, 0.0) / 2;
    electrons[i] = std::min(electrons[i], capacity_e);
  }
  double flowing = 0;
  const auto pass = [&](std::size_t i) {
    const double held = std::min(flowing, capacity_e - electrons[i]);
    electrons[i] += held;
    flowing += half[i] - held;
  };
  for (std::size_t i = 0; i < electrons.size(); ++i) pass(i);
  flowing = 0;
  for (std::size_t i = electrons.size(); i-- > 0;) pass(i);
}

}  // namespace petzval
