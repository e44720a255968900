// SPDX-License-Identifier: BSD-3-Clause
#include "scene_list.h"

#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/whole_file.h>

namespace petzval::app {

namespace {

/// The first line of a scene's file, which is a comment on what it is.
std::string description_of(const std::string& name) {
  const std::string text =
      read_whole_file(find_data_file("scenes", ".pbrt", name, "three-dimensional scene"));
  const std::size_t begin = text.find_first_not_of("# ");
  return text.substr(begin, text.find('\n', begin) - begin);
}

}  // namespace

nlohmann::ordered_json rows_of_worlds() {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const std::string& name : bundled_names("scenes", ".pbrt"))
    rows.push_back({{"name", name}, {"kind", "three-dimensional"}, {"description", description_of(name)}});
  return rows;
}

void print_scenes(const nlohmann::ordered_json& rows, bool json) {
  if (json) return fmt::print("{}\n", nlohmann::ordered_json{{"rows", rows}}.dump(2));
  for (const nlohmann::ordered_json& row : rows)
    fmt::print("{:<24}{}\n", row["name"].get<std::string>(), row["description"].get<std::string>());
}

}  // namespace petzval::app
