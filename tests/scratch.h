// SPDX-License-Identifier: BSD-3-Clause
// Files that a test makes and that go away with it.
#pragma once

#include <petzval/base/scratch_folder.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace petzval::test {

/// A new folder, removed at the end. Tests run side by side, and so may two runs of all of them: a name that
/// two of them share is a file that one removes while the other reads it.
class Scratch {
 public:
  Scratch() {}  // not defaulted: members of fixtures are const
  std::filesystem::path folder() const { return folder_.path(); }
  std::string path(const std::string& file) const { return (folder() / file).string(); }
  /// Writes a file. \returns its path.
  std::string with(const std::string& file, std::string_view bytes) const {
    // Quickly, for thousands of files: no flush to disk, and no truncation, which some file systems flush
    // too.
    std::filesystem::remove(path(file));
    std::ofstream(path(file), std::ios::binary) << bytes;
    return path(file);
  }
  bool is_empty() const { return std::filesystem::is_empty(folder()); }

 private:
  ScratchFolder folder_;
};

}  // namespace petzval::test
