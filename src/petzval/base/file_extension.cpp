// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/file_extension.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace petzval {

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace petzval
