// SPDX-License-Identifier: BSD-3-Clause
#include "sweep_folder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/version.h>
#include <petzval/base/whole_file.h>

#include <algorithm>
#include <array>
#include <filesystem>

namespace petzval::app {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

constexpr std::string_view maker = "petzval sweep";
constexpr const char* aside_name = ".sweep-before";

/// Whether a sweep writes files of such names: what a damaged sweep.json lists besides is left alone.
bool is_name_of_sweep(const std::string& name) {
  if (name == "index.html" || name == "sweep.csv" || name == "sweep.json" || name == "contact-sheet.png")
    return true;
  constexpr std::string_view prefix = "point-", figures = "0123456789";
  if (!name.starts_with(prefix)) return false;
  const std::size_t dot = name.find_first_not_of(figures, prefix.size());
  if (dot == name.npos || dot == prefix.size()) return false;
  constexpr std::array<std::string_view, 6> extensions{".png", ".json", ".exr", ".npy", ".dng", ".tif"};
  return std::ranges::find(extensions, std::string_view(name).substr(dot)) != extensions.end();
}

/// The files that a sweep.json lists; nothing if no sweep wrote it.
std::set<std::string> files_of(const std::string& text) {
  std::set<std::string> files;
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("made_by") || !json["made_by"].is_string() ||
      !json["made_by"].get<std::string>().starts_with(maker))
    return files;
  files.insert("sweep.json");
  if (json.contains("files") && json["files"].is_array())
    for (const Json& name : json["files"])
      if (name.is_string() && is_name_of_sweep(name.get<std::string>()))
        files.insert(name.get<std::string>());
  return files;
}

/// The topmost folder of a path that does not exist.
std::string topmost_missing(const fs::path& path) {
  std::error_code ignored;
  fs::path missing;
  for (fs::path at = path; !at.empty() && !fs::exists(at, ignored); at = at.parent_path()) missing = at;
  return missing.string();
}

void make_folder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw InputError(path, "cannot be made: " + error.message());
}

}  // namespace

SweepFolder::SweepFolder(std::string path, std::set<std::string> planned)
    : path_(std::move(path)), planned_(std::move(planned)) {
  planned_.insert("sweep.json");
  const std::string marked = path_ + "/sweep.json";
  std::error_code ignored;
  if (fs::exists(marked, ignored)) {
    before_ = read_whole_file(marked);
    old_ = files_of(before_);
    const Json json = old_.empty() ? Json() : Json::parse(before_, nullptr, false);
    if (json.is_object() && json.contains("scene")) scene_ = json["scene"];
    is_new_ = old_.empty() || (json.is_object() && json.value("finished", Json()) == false);
  }
  std::vector<std::string> strange;
  for (const std::string& name : planned_)
    if (!old_.contains(name) && fs::exists(fs::path(path_) / name, ignored)) strange.push_back(name);
  constexpr std::size_t most_named = 3;
  const bool more = strange.size() > most_named;
  if (more) strange.resize(most_named);
  if (!strange.empty())
    throw InputError(path_,
                     fmt::format("holds {}{}, which no sweep has made here; another folder would be right",
                                 fmt::join(strange, ", "), more ? " and more" : ""));
  made_ = topmost_missing(fs::path(path_).lexically_normal());
  make_folder(path_);
  if (!old_.empty()) set_old_aside();
  write_unfinished();
}

SweepFolder::~SweepFolder() {
  if (kept_) return;
  std::error_code ignored;
  try {
    if (old_.empty())
      fs::remove(path_ + "/sweep.json", ignored);
    else
      write_whole_file(path_ + "/sweep.json", before_);
  } catch (const Error&) {  // a full disk: the files are listed still
  }
  bring_old_back();
  if (made_.empty()) return;
  for (fs::path at = fs::path(path_).lexically_normal(); !at.empty(); at = at.parent_path()) {
    if (at.has_filename() && !fs::remove(at, ignored)) return;
    if (at == made_) return;
  }
}

void SweepFolder::set_old_aside() const {
  const fs::path folder(path_), aside = folder / aside_name;
  std::error_code error;
  fs::remove_all(aside, error);  // of a sweep that was killed
  fs::create_directory(aside, error);
  for (const std::string& name : old_) {
    if (!planned_.contains(name) || !fs::exists(folder / name, error)) continue;
    // Files are replaced, never written into, so a link keeps what was there.
    fs::create_hard_link(folder / name, aside / name, error);
    if (error) fs::copy_file(folder / name, aside / name, error);
    if (error)
      throw Failure(fmt::format("{}: the sweep before cannot be set aside: {}", path_, error.message()));
  }
}

void SweepFolder::bring_old_back() const {
  const fs::path folder(path_), aside = folder / aside_name;
  std::error_code ignored;
  for (const std::string& name : old_)
    if (name != "sweep.json" && fs::exists(aside / name, ignored))
      fs::rename(aside / name, folder / name, ignored);
  fs::remove_all(aside, ignored);
}

void SweepFolder::keep() {
  if (!kept_ && !old_.empty()) {
    std::error_code ignored;
    fs::remove_all(fs::path(path_) / aside_name, ignored);
  }
  kept_ = true;
}

void SweepFolder::remember_scene(Json scene) {
  scene_ = std::move(scene);
  write_unfinished();
}

void SweepFolder::write_unfinished() const {
  std::set<std::string> both = old_;
  both.insert(planned_.begin(), planned_.end());
  write(Json::array(), both, false);
}

bool SweepFolder::owns(const std::string& file) const {
  std::error_code ignored;
  const fs::path path(file), parent = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const std::string name = path.filename().string();
  return (planned_.contains(name) || old_.contains(name)) && fs::equivalent(parent, path_, ignored);
}

void SweepFolder::finish(const Json& rows, const std::set<std::string>& written) {
  std::set<std::string> files = written;
  files.insert("sweep.json");
  for (const std::set<std::string>* names : {&old_, &planned_})
    for (const std::string& name : *names) {
      std::error_code ignored;
      if (!files.contains(name)) fs::remove(fs::path(path_) / name, ignored);
    }
  write(rows, files, true);
  keep();
}

void SweepFolder::write(const Json& rows, const std::set<std::string>& files, bool finished) const {
  Json json = {{"made_by", fmt::format("{} {}", maker, version())}, {"finished", finished}, {"files", files}};
  if (!scene_.is_null()) json["scene"] = scene_;
  json["rows"] = rows;
  write_whole_file(path_ + "/sweep.json", json.dump(1) + "\n");
}

}  // namespace petzval::app
