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

/// A file with a name, for libraries that ask where a link leads (HDF5) and readers that look at its ending.
class NamedFile {
 public:
  /// \param ending  of the name, ".npz"
  explicit NamedFile(std::string_view bytes, std::string_view ending = {});
  ~NamedFile();
  NamedFile(const NamedFile&) = delete;
  NamedFile& operator=(const NamedFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace petzval::fuzz
