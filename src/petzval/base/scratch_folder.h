// SPDX-License-Identifier: BSD-3-Clause
// A folder for files that are needed for a moment.
#pragma once

#include <string>

namespace petzval {

/// An empty folder in $TMPDIR (else /var/tmp) that goes with what is in it.
class ScratchFolder {
 public:
  /// \throws Failure where none can be made.
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace petzval
