// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/glass/glass_file.h>
#include <petzval/glass/packed_catalogue.h>

#include <algorithm>
#include <filesystem>

namespace petzval {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t largest_glass_file = std::size_t{64} << 20;
constexpr std::size_t most_files = 20'000;

/// "CATALOGUE:NAME" leaves no room for colons and blanks.
std::string as_name(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c <= ' ' || c == ':' || c == 0x7F; }, '_');
  return text;
}

std::string extension_of(const fs::path& path) {
  return upper_case(path.extension().string());
}

bool is_yaml(const fs::path& path) {
  return extension_of(path) == ".YML" || extension_of(path) == ".YAML";
}

GlassFile read_one(const fs::path& path, const std::string& yaml_catalogue) {
  const std::string bytes = read_whole_file(path.string(), largest_glass_file),
                    stem = as_name(path.stem().string());
  if (is_yaml(path)) return read_glass_yaml(bytes, path.string(), yaml_catalogue, stem);
  if (extension_of(path) == ".AGF") return read_agf(bytes, path.string(), upper_case(stem));
  throw InputError(path.string(),
                   "is not a glass file that is read here; .agf, .yml and folders of them are");
}

void append(GlassFile& all, GlassFile&& more) {
  std::move(more.glasses.begin(), more.glasses.end(), std::back_inserter(all.glasses));
  std::move(more.notes.begin(), more.notes.end(), std::back_inserter(all.notes));
}

}  // namespace

GlassFile read_glass_files(const std::string& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return read_one(path, "USER");
  const std::string folder = as_name(fs::canonical(path).filename().string());
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(path))
    if (is_yaml(entry.path()) || extension_of(entry.path()) == ".AGF") files.push_back(entry.path());
  if (files.empty()) throw InputError(path, "is a folder without .agf and .yml files");
  if (files.size() > most_files)
    throw InputError(path, fmt::format("is a folder of {} glass files", files.size()));
  std::sort(files.begin(), files.end());
  GlassFile all;
  for (const fs::path& file : files) append(all, read_one(file, upper_case(folder)));
  return all;
}

}  // namespace petzval
