// SPDX-License-Identifier: BSD-3-Clause
// The folder of a sweep: what in it is the sweep's, and what is the user's.
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace petzval::app {

/// A folder whose sweep.json says that a sweep made it, and which files are the sweep's. Other files are
/// never replaced nor removed. sweep.json is written before the first point, so that a sweep that is killed
/// can go on.
class SweepFolder {
 public:
  /// Makes the folder where there is none. \param planned  names of the files that may be written. \throws
  /// InputError if one of them is there and no sweep's, saying what would be right.
  SweepFolder(std::string path, std::set<std::string> planned);
  /// Unless something was kept, the files of an older sweep come back, and a folder that was made goes.
  ~SweepFolder();
  SweepFolder(const SweepFolder&) = delete;
  SweepFolder& operator=(const SweepFolder&) = delete;

  /// Whether a file is one of those that this sweep or the one before it wrote here, or will write.
  bool owns(const std::string& file) const;
  /// What remember_scene() was given, by this sweep or the one before it.
  const nlohmann::ordered_json& scene() const { return scene_; }
  void remember_scene(nlohmann::ordered_json scene);
  /// Whether no finished sweep's files would be replaced.
  bool is_new() const { return is_new_; }
  /// There is a point to keep.
  void keep();
  /// Writes sweep.json with the rows, and removes files of this sweep and of the one before it that are not
  /// among `written`.
  void finish(const nlohmann::ordered_json& rows, const std::set<std::string>& written);

 private:
  void set_old_aside() const;
  void bring_old_back() const;
  void write_unfinished() const;
  void write(const nlohmann::ordered_json& rows, const std::set<std::string>& files, bool finished) const;

  std::string path_, before_, made_;  ///< before_: sweep.json as it was; made_: the topmost folder made
  std::set<std::string> planned_, old_;
  nlohmann::ordered_json scene_;
  bool is_new_ = true, kept_ = false;
};

}  // namespace petzval::app
