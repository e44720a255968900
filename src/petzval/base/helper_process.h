// SPDX-License-Identifier: BSD-3-Clause
// Work that may crash, done by a program of its own: for libraries that damaged files crash or keep busy for
// ever.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace petzval {

struct HelperLimits {
  double processor_s = 60;
  std::size_t memory_bytes = std::size_t{4} << 30;  ///< beyond what the program itself takes
};

enum class HelperEnd { finished, crashed, endless };

/// Path of a helper program of Petzval's. It is looked for in ../../libexec/petzval, seen from the default
/// data directory (set_default_data_directory). \throws Failure if it is not there.
std::string helper_program(const std::string& name);

/// Runs a program with these words and waits for its end. What it prints goes nowhere; what it makes it
/// writes to files that it is told of, or to its descriptor 3, which is `descriptor` if that is not negative.
/// \returns `finished` if it ended well, `endless` if it took more processor time than the limit, `crashed`
/// for all other ends. \throws InputError, Failure with the message of the exception that ended the program's
/// work (help()); Failure if it cannot be started.
HelperEnd run_helper(const std::string& program, const std::vector<std::string>& words, int descriptor = -1,
                     const HelperLimits& limits = {});

/// What a helper program does: `work` within the limits of run_helper(), whose exceptions go to the caller.
/// \returns what main() returns.
int help(const std::function<void()>& work);

}  // namespace petzval
