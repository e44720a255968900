// SPDX-License-Identifier: BSD-3-Clause
// Parallel work under a lock.
#pragma once

#include <functional>

namespace petzval {

/// Does `work`, whose parallel loops (base/parallel.h) meanwhile take up no items but their own. A thread
/// that waits for the end of an inner loop else takes up items of the loops around it. If it holds a lock
/// that such an item asks for, it waits for itself. So whatever has parallel loops and is done under a lock,
/// or within std::call_once, is done by this.
void run_isolated(const std::function<void()>& work);

}  // namespace petzval
