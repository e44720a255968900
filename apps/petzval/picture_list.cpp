// SPDX-License-Identifier: BSD-3-Clause
#include "picture_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>

#include <algorithm>
#include <filesystem>

namespace petzval::app {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> files_of(const std::string& folder, const std::vector<std::string>& extensions) {
  std::vector<std::string> files;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    std::error_code ignored;
    const std::string path = at->path().string();
    const bool sheet = at->path().filename() == "contact-sheet.png";  // what a sweep made of the others
    if (std::ranges::count(extensions, extension_of(path)) && !at->is_directory(ignored) && !sheet)
      files.push_back(path);
  }
  if (error) throw InputError(folder, fmt::format("the folder cannot be listed: {}", error.message()));
  if (files.empty())
    throw InputError(folder,
                     fmt::format("no picture is in this folder; {} are read", fmt::join(extensions, ", ")));
  std::ranges::sort(files);
  return files;
}

}  // namespace

std::vector<std::string> pictures_in(const std::vector<std::string>& files_and_folders,
                                     const std::vector<std::string>& extensions) {
  std::vector<std::string> files;
  for (const std::string& path : files_and_folders) {
    std::error_code error;
    if (!fs::is_directory(path, error)) {
      files.push_back(path);
      continue;
    }
    const std::vector<std::string> some = files_of(path, extensions);
    files.insert(files.end(), some.begin(), some.end());
  }
  return files;
}

}  // namespace petzval::app
