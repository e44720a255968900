// SPDX-License-Identifier: BSD-3-Clause
#include "memory_file.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "require.h"

namespace petzval::fuzz {

MemoryFile::MemoryFile(std::string_view bytes) : descriptor_(memfd_create("fuzz", 0)) {
  require(descriptor_ >= 0, "no file in memory");
  require(write(descriptor_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()),
          "a file in memory that cannot be written");
}

MemoryFile::~MemoryFile() {
  close(descriptor_);
}

std::string MemoryFile::path() const {
  return fmt::format("/proc/self/fd/{}", descriptor_);
}

NamedFile::NamedFile(std::string_view bytes, std::string_view ending)
    : path_((std::filesystem::temp_directory_path() / "petzval-fuzz-XXXXXX").string().append(ending)) {
  const int descriptor = mkstemps(path_.data(), static_cast<int>(ending.size()));
  require(
      descriptor >= 0 && write(descriptor, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()),
      "a file that cannot be written");
  close(descriptor);
}

NamedFile::~NamedFile() {
  unlink(path_.c_str());
}

}  // namespace petzval::fuzz
