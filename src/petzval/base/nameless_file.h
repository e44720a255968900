// SPDX-License-Identifier: BSD-3-Clause
// Files without a name: room on disk that goes with who opened it.
#pragma once

#include <string>
#include <utility>

namespace petzval {

/// A file without a name in $TMPDIR (else /var/tmp), to be read and written, closed in programs that this one
/// starts.
class NamelessFile {
 public:
  NamelessFile();
  /// One in `folder` that link() may name, where the file system has such files.
  explicit NamelessFile(const std::string& folder);
  ~NamelessFile();
  NamelessFile(NamelessFile&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  NamelessFile& operator=(NamelessFile&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }

  /// Names the file, once, for whoever the folder's files are for. \return whether that was possible: nothing
  /// may have this name, and it must be for one of the second kind.
  bool link(const std::string& path) const;

  /// Negative where none could be had.
  int descriptor() const { return descriptor_; }
  explicit operator bool() const { return descriptor_ >= 0; }

 private:
  int descriptor_ = -1;
};

}  // namespace petzval
