// SPDX-License-Identifier: BSD-3-Clause
// Python as a second reader and writer of files.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "scratch.h"

namespace petzval::test {

/// The Python of the system, which has the system's numpy; else the first one on the path.
inline std::string python() {
  return std::filesystem::exists("/usr/bin/python3") ? "/usr/bin/python3" : "python3";
}

/// True if `python -c statement` runs: "import numpy", or "" for Python itself.
inline bool python_runs(const std::string& statement) {
  return std::system((python() + " -c '" + statement + "' >/dev/null 2>&1").c_str()) == 0;
}

/// Runs a script. \returns its exit status.
inline int run_python(const Scratch& scratch, const std::string& script, const std::string& arguments) {
  return std::system((python() + " '" + scratch.with("script.py", script) + "' " + arguments).c_str());
}

}  // namespace petzval::test
