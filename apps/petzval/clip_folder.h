// SPDX-License-Identifier: BSD-3-Clause
// The folder of a clip: frames that are there are kept, so that a clip that was stopped goes on.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli11.h"

namespace petzval::app {

/// What a command was asked for that alters the bytes of its files, with checksums of the files that it
/// names. \param folder  of the clip, whose own files do not count.
nlohmann::ordered_json asked_for(const CLI::App& command, const std::string& folder);

class ClipFolder {
 public:
  /// Opens a folder, or makes it. \param formats  extensions of a frame's files. \param facts  of the clip,
  /// kept in clip.json. \throws InputError for a folder that holds another clip.
  ClipFolder(std::string folder, std::vector<std::string> formats, const nlohmann::ordered_json& facts);

  bool has(int frame) const;
  /// "clip/frame-000012.png"
  std::string path(int frame, const std::string& extension) const;
  std::string path(const std::string& name) const;

 private:
  std::string folder_;
  std::vector<std::string> formats_;
};

}  // namespace petzval::app
