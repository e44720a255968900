// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/staged_files.h>
#include <petzval/base/whole_file.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>

namespace petzval {

namespace fs = std::filesystem;

namespace {

/// What the names of this run's staging folders begin with.
std::string staging_prefix() {
  return fmt::format(".petzval-{}-", getpid());
}

/// \param path  of the output, for the message.
std::string make_staging_folder(const fs::path& beside, const std::string& path) {
  static std::atomic<unsigned> counter{0};
  const fs::path folder = beside / fmt::format("{}{}", staging_prefix(), counter++);
  std::error_code error;
  fs::create_directory(folder, error);
  if (error) throw Failure(fmt::format("{}: cannot be written: {}", path, error.message()));
  return folder.string();
}

}  // namespace

StagedFiles::~StagedFiles() {
  std::error_code ignored;
  for (const auto& [beside, folder] : folders_) fs::remove_all(folder, ignored);
}

std::string StagedFiles::stage(const std::string& path) {
  // Its checks, and the file behind a link.
  const std::string final_path = WholeFile(path).path();
  const fs::path beside = fs::path(final_path).parent_path();
  auto [folder, is_new] = folders_.try_emplace(beside.string());
  if (is_new) {
    try {
      folder->second = make_staging_folder(beside, path);
    } catch (...) {
      folders_.erase(folder);
      throw;
    }
  }
  return files_[final_path] = (fs::path(folder->second) / fs::path(final_path).filename()).string();
}

void StagedFiles::commit() {
  for (const auto& [path, staged] : files_) {
    std::error_code error;
    fs::rename(staged, path, error);
    if (error) throw Failure(fmt::format("{}: cannot be written: {}", path, error.message()));
  }
  files_.clear();
}

std::string with_final_names(std::string message) {
  const std::string prefix = staging_prefix();
  for (std::size_t at; (at = message.find(prefix)) != std::string::npos;) {
    const std::size_t slash = message.find('/', at);
    message.erase(at, slash == std::string::npos ? prefix.size() : slash + 1 - at);
  }
  return message;
}

}  // namespace petzval
