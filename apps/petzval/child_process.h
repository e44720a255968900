// SPDX-License-Identifier: BSD-3-Clause
// Running this program again, as another process: its failure is then no failure of ours.
#pragma once

#include <string>
#include <vector>

namespace petzval::app {

struct ChildOutcome {
  int exit_code = 0;  ///< 128 + the signal that ended it
  std::string out, error;
};

/// Runs this program with these arguments and waits for it. \param out_path, error_path  files for its stdout
/// and stderr, read back and removed. \throws Failure if it cannot be started.
ChildOutcome run_again(const std::vector<std::string>& arguments, const std::string& out_path,
                       const std::string& error_path);

}  // namespace petzval::app
