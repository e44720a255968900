// SPDX-License-Identifier: BSD-3-Clause
// The share of what comes off a line that is good, as a count of some of it tells.
#pragma once

#include <cstddef>

namespace petzval {

struct Yield {
  double share = 0, low = 0, high = 0;  ///< and its 95 % interval
};

/// Clopper and Pearson, Biometrika 26 (1934) 404. \param all  above 0.
Yield yield_of(std::size_t good, std::size_t all);

}  // namespace petzval
