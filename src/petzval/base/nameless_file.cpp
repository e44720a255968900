// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <fmt/format.h>
#include <petzval/base/nameless_file.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

namespace petzval {

NamelessFile::NamelessFile() {
  const char* chosen = std::getenv("TMPDIR");
  std::string path = chosen != nullptr && *chosen != '\0' ? chosen : "/var/tmp";
  descriptor_ = open(path.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor_ >= 0) return;
  // File systems without O_TMPFILE.
  path += "/petzval-XXXXXX";
  descriptor_ = mkostemp(path.data(), O_CLOEXEC);
  if (descriptor_ >= 0) unlink(path.c_str());
}

NamelessFile::NamelessFile(const std::string& folder) {
  constexpr mode_t as_any_output = 0666;  // less the umask
  descriptor_ = open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, as_any_output);
}

bool NamelessFile::link(const std::string& path) const {
  const std::string self = fmt::format("/proc/self/fd/{}", descriptor_);
  return linkat(AT_FDCWD, self.c_str(), AT_FDCWD, path.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

NamelessFile::~NamelessFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

}  // namespace petzval
