// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel_tasks.h>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace petzval {

void parallel_tasks(std::size_t count, const std::function<void(std::size_t)>& body) {
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, count),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) body(i);
      },
      tbb::simple_partitioner());
}

}  // namespace petzval
