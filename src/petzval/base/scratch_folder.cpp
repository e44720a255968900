// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/scratch_folder.h>

#include <cstdlib>
#include <filesystem>

namespace petzval {

ScratchFolder::ScratchFolder() {
  const char* const chosen = std::getenv("TMPDIR");
  path_ = chosen != nullptr && *chosen != '\0' ? chosen : "/var/tmp";
  path_ += "/petzval-XXXXXX";
  if (mkdtemp(path_.data()) == nullptr) throw Failure(path_ + ": no folder can be made there");
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace petzval
