// SPDX-License-Identifier: BSD-3-Clause
// The instruction sets of this machine, one at a time.
#pragma once

#include <hwy/targets.h>

#include <cstdint>
#include <vector>

namespace petzval::sample {

/// Holds the machine to one instruction set.
class OnlyTarget {
 public:
  explicit OnlyTarget(std::int64_t target) { hwy::SetSupportedTargetsForTest(target); }
  ~OnlyTarget() { hwy::SetSupportedTargetsForTest(0); }
};

inline std::vector<std::int64_t> targets_of_this_machine() {
  std::vector<std::int64_t> targets;
  for (int bit = 0; bit < 62; ++bit)
    if (hwy::SupportedTargets() & (std::int64_t{1} << bit)) targets.push_back(std::int64_t{1} << bit);
  return targets;
}

}  // namespace petzval::sample
