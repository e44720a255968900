// SPDX-License-Identifier: BSD-3-Clause
#include "clip_folder.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/version.h>
#include <petzval/base/whole_file.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <utility>

#include "sweep_result.h"

namespace petzval::app {

nlohmann::ordered_json asked_for(const CLI::App& command, const std::string& folder) {
  constexpr std::array<std::string_view, 5> of_no_matter{"--threads", "--quiet", "--json", "--output",
                                                         "--help"};
  nlohmann::ordered_json asked = nlohmann::ordered_json::object();
  std::vector<std::string> words;
  // CLI11 gives options that may be altered only.
  for (CLI::Option* option : const_cast<CLI::App&>(command).get_options({}))
    if (option->count() > 0 && std::ranges::find(of_no_matter, option->get_name()) == of_no_matter.end()) {
      asked[option->get_name()] = option->results();
      words.insert(words.end(), option->results().begin(), option->results().end());
    }
  if (const nlohmann::ordered_json sums = checksums_of_files(words, folder); !sums.empty())
    asked["checksums"] = sums;
  return asked;
}

ClipFolder::ClipFolder(std::string folder, std::vector<std::string> formats,
                       const nlohmann::ordered_json& facts)
    : folder_(std::move(folder)), formats_(std::move(formats)) {
  std::error_code failed;
  std::filesystem::create_directories(folder_, failed);
  if (failed) throw InputError(folder_, "cannot be made: " + failed.message());
  nlohmann::ordered_json head = {{"format", "petzval-clip/1"},
                                 {"made_by", fmt::format("petzval {}", version())}};
  head.update(facts);
  const std::string text = head.dump(2) + "\n", name = path("clip.json");
  if (!std::filesystem::exists(name))
    write_whole_file(name, text);
  else if (read_whole_file(name) != text)
    throw InputError(name,
                     "is of another clip; the same options and files, or another folder, would be right");
}

bool ClipFolder::has(int frame) const {
  return std::ranges::all_of(formats_, [&](const std::string& extension) {
    return std::filesystem::exists(path(frame, extension));
  });
}

std::string ClipFolder::path(int frame, const std::string& extension) const {
  return path(fmt::format("frame-{:06}.{}", frame, extension));
}

std::string ClipFolder::path(const std::string& name) const {
  return (std::filesystem::path(folder_) / name).string();
}

}  // namespace petzval::app
