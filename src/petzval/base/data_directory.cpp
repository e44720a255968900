// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/version.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <mutex>
#include <numeric>

namespace petzval {

namespace fs = std::filesystem;

namespace {

std::size_t edit_distance(const std::string& a, const std::string& b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = diagonal + (lower(a[i]) != lower(b[j]));
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

/// Without what options begin with, in small letters.
std::string bare(const std::string& name) {
  std::string bare = name.substr(std::min(name.find_first_not_of('-'), name.size()));
  std::transform(bare.begin(), bare.end(), bare.begin(), [](unsigned char c) { return std::tolower(c); });
  return bare;
}

/// How far a name is from what was written. People also remember a part of a name, as --pitch of
/// --pixel-pitch, or its beginning, as --vary of --variable: these count as one and two letters wrong.
std::size_t distance_between(const std::string& written, const std::string& name) {
  const std::size_t letters = edit_distance(written, name);
  const std::string part = bare(written), whole = bare(name);
  constexpr std::size_t short_part = 3;
  if (part.size() < short_part) return letters;
  if (whole.find(part) != whole.npos) return std::min(letters, std::size_t{1});
  const std::size_t same = static_cast<std::size_t>(
      std::mismatch(part.begin(), part.end(), whole.begin(), whole.end()).first - part.begin());
  return same >= short_part && 4 * same >= 3 * part.size() ? std::min(letters, std::size_t{2}) : letters;
}

/// What was said of the folder by whoever may say it.
struct DataFolders {
  std::string set, usual;
};

/// Read and altered by one thread at a time.
DataFolders data_folders(const std::function<void(DataFolders&)>& alter = {}) {
  static std::mutex mutex;
  static DataFolders folders;
  const std::lock_guard lock(mutex);
  if (alter) alter(folders);
  return folders;
}

bool holds_data(const std::string& path) {
  std::error_code error;
  return !path.empty() && fs::is_directory(fs::path(path) / "glass", error);
}

}  // namespace

const char* version() {
  return PETZVAL_VERSION;
}

std::string data_directory() {
  const DataFolders folders = data_folders();
  if (!folders.set.empty()) return folders.set;
  if (const char* given = std::getenv("PETZVAL_DATA"); given && *given) {
    if (!fs::is_directory(given)) throw InputError(given, "PETZVAL_DATA names no folder");
    return given;
  }
  if (holds_data(folders.usual)) return folders.usual;
  throw InputError(
      fmt::format("the bundled data is missing{}; the variable PETZVAL_DATA set to the folder that has "
                  "glass/ would be right",
                  folders.usual.empty() ? "" : fmt::format(" (looked in {})", folders.usual)));
}

void set_data_directory(const std::string& path) {
  if (!holds_data(path))
    throw InputError(path, "has no folder glass/; the folder of the bundled data has one");
  data_folders([&](DataFolders& folders) { folders.set = path; });
}

void set_default_data_directory(const std::string& path) {
  data_folders([&](DataFolders& folders) { folders.usual = path; });
}

std::string default_data_directory() {
  return data_folders().usual;
}

std::vector<std::string> bundled_names(const std::string& kind, const std::string& extension) {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(data_directory()) / kind, error))
    if (entry.path().extension() == extension) names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> nearest_names(const std::string& name, const std::vector<std::string>& candidates,
                                       std::size_t count) {
  std::vector<std::pair<std::size_t, std::string>> ranked;
  for (const std::string& candidate : candidates)
    ranked.emplace_back(distance_between(name, candidate), candidate);
  count = std::min(count, ranked.size());
  std::partial_sort(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(count), ranked.end());
  std::vector<std::string> nearest;
  for (std::size_t i = 0; i < count; ++i) nearest.push_back(ranked[i].second);
  return nearest;
}

std::vector<std::string> bundled_folders(const std::string& kind) {
  std::vector<std::string> folders{kind};
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(data_directory()) / kind, error))
    if (entry.is_directory(error)) folders.push_back(kind + "/" + entry.path().filename().string());
  std::sort(folders.begin(), folders.end());
  return folders;
}

std::vector<std::string> all_bundled_names(const std::string& kind, const std::string& extension) {
  std::vector<std::string> names;
  for (const std::string& folder : bundled_folders(kind))
    for (std::string& name : bundled_names(folder, extension)) names.push_back(std::move(name));
  return names;
}

std::string find_data_file(const std::string& kind, const std::string& extension,
                           const std::string& path_or_name, const std::string& what) {
  std::error_code error;
  if (fs::is_regular_file(path_or_name, error)) return path_or_name;
  if (path_or_name.empty()) throw InputError(fmt::format("an empty name for a {}", what));
  for (const std::string& folder : bundled_folders(kind)) {
    const fs::path bundled = fs::path(data_directory()) / folder / (path_or_name + extension);
    if (path_or_name.find('/') == std::string::npos && fs::is_regular_file(bundled, error))
      return bundled.string();
  }
  if (fs::is_directory(path_or_name, error))
    throw InputError(path_or_name, fmt::format("is a folder; the {} wanted is a file", what));
  const std::vector<std::string> near = nearest_names(path_or_name, all_bundled_names(kind, extension));
  throw InputError(path_or_name,
                   fmt::format("no such file, and no bundled {} of that name; the nearest are {}", what,
                               fmt::join(near, ", ")));
}

}  // namespace petzval
