// SPDX-License-Identifier: BSD-3-Clause
// Parallel loops over a few things that take long.
#pragma once

#include <cstddef>
#include <functional>

namespace petzval {

/// As parallel_for(), for bodies of a millisecond or more: they are handed out one by one. parallel_for()
/// hands out pieces of many, which costs less, but at the end one thread may have a piece left and the others
/// nothing to do.
void parallel_tasks(std::size_t count, const std::function<void(std::size_t)>& body);

}  // namespace petzval
