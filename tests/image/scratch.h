// SPDX-License-Identifier: BSD-3-Clause
// Files that a test makes and that go away with it.
#pragma once

#include <gtest/gtest.h>
#include <petzval/base/whole_file.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace petzval::test {

/// A folder of its own, removed at the end.
class Scratch {
 public:
  Scratch() : folder_(testing::TempDir() + "petzval-" + std::to_string(getpid()) + "-" + name()) {
    std::filesystem::create_directories(folder_);
  }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  std::string path(const std::string& file) const { return (std::filesystem::path(folder_) / file).string(); }
  std::string with(const std::string& file, std::string_view bytes) const {
    // Quickly, for thousands of files: no flush to disk, and no truncation, which some file systems flush
    // too.
    std::filesystem::remove(path(file));
    std::ofstream(path(file), std::ios::binary) << bytes;
    return path(file);
  }
  bool is_empty() const { return std::filesystem::is_empty(folder_); }

 private:
  static std::string name() {
    std::string text = testing::UnitTest::GetInstance()->current_test_info()->name();
    for (char& c : text)
      if (c == '/') c = '-';
    return text;
  }
  std::string folder_;
};

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
