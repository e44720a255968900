// SPDX-License-Identifier: BSD-3-Clause
// Work that may crash, done in a process of its own.
#pragma once

#include <cstddef>
#include <functional>

namespace petzval {

/// What a child may take beyond what its parent has.
struct ChildLimits {
  double processor_s = 60;
  std::size_t memory_bytes = std::size_t{4} << 30;
};

enum class ChildEnd { finished, crashed, endless };

/// Runs `work` in a copy of this process, for libraries that damaged files crash or keep busy for ever. What
/// it makes it writes to files that were open before; what it prints goes nowhere, and neither destructors
/// nor exit handlers of the parent run in it. Only this thread is copied: work must not wait for others (no
/// parallel loops). \returns `finished` if work returned, `endless` if it took more processor time than the
/// limit, `crashed` for all other ends. \throws InputError, Failure with the message of what work threw (the
/// first few thousand characters of it); Failure if there can be no child.
ChildEnd run_in_child(const std::function<void()>& work, const ChildLimits& limits = {});

}  // namespace petzval
