// SPDX-License-Identifier: BSD-3-Clause
// Lens files that live as long as a test.
#pragma once

#include <petzval/lens/lens_file.h>

#include <string>
#include <string_view>

#include "scratch.h"

namespace petzval::testing {

/// A file in a folder of its own. Without contents there is only its path.
class ScratchFile {
 public:
  explicit ScratchFile(const std::string& name, std::string_view contents = {}) : path_(scratch_.path(name)) {
    if (!contents.empty()) scratch_.with(name, contents);
  }
  const std::string& path() const { return path_; }

 private:
  test::Scratch scratch_;
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
