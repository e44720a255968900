// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/isolated.h>
#include <tbb/task_arena.h>

namespace petzval {

void run_isolated(const std::function<void()>& work) {
  tbb::this_task_arena::isolate(work);
}

}  // namespace petzval
