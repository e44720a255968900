// SPDX-License-Identifier: BSD-3-Clause
// Files for readers that want a path.
#pragma once

#include <string>
#include <string_view>

namespace petzval::fuzz {

/// Bytes as a file that has a path but no place on a disk.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view bytes);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string path() const;

 private:
  int descriptor_;
};

}  // namespace petzval::fuzz
