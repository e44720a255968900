// SPDX-License-Identifier: BSD-3-Clause
// Lens files that live as long as a test.
#pragma once

#include <petzval/base/whole_file.h>
#include <petzval/lens/lens_file.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace petzval::testing {

class ScratchFile {
 public:
  explicit ScratchFile(const std::string& name, std::string_view contents = {})
      : folder_(std::filesystem::temp_directory_path() / ("petzval-lens-test-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    path_ = (folder_ / name).string();
    // Not write_whole_file(): it waits for the disk.
    if (!contents.empty())
      std::ofstream(path_, std::ios::binary)
          .write(contents.data(), static_cast<std::streamsize>(contents.size()));
  }
  ~ScratchFile() { std::filesystem::remove_all(folder_); }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::filesystem::path folder_;
  std::string path_;
};

inline LensFile read_text(const std::string& name, std::string_view contents,
                          const LensReadOptions& options = {}) {
  ScratchFile file(name, contents);
  return read_lens(file.path(), options);
}

/// Writes a lens and reads it again.
inline Lens through_file(const Lens& lens, const std::string& name) {
  ScratchFile file(name);
  write_lens(lens, file.path());
  return read_lens(file.path()).lens;
}

}  // namespace petzval::testing
