// SPDX-License-Identifier: BSD-3-Clause
#include "clip.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>

#include <optional>
#include <utility>
#include <vector>

#include "command.h"
#include "other_program.h"

namespace petzval::app {

namespace {

std::optional<int> ffmpeg(std::vector<std::string> words) {
  words.insert(words.begin(), {"ffmpeg", "-nostdin", "-loglevel", "error"});
  return run_other_program(std::move(words));
}

}  // namespace

void require_clip_maker(const std::string& path) {
  require_extension(path, {".mp4", ".webm", ".gif"}, "a film");
  if (ffmpeg({"-version"}) != 0)
    throw InputError(
        path,
        "needs the program ffmpeg (Debian: apt install ffmpeg); without it the pictures alone can be had");
}

void write_clip(const std::string& path, const std::string& pictures, double frames_per_second) {
  const std::string extension = path.substr(path.rfind('.'));
  WholeFile file(path);
  // ffmpeg goes by the name; sides of most films are even.
  const std::string format = extension == ".gif" ? "gif" : extension == ".webm" ? "webm" : "mp4";
  std::vector<std::string> words{"-y", "-framerate", fmt::format("{}", frames_per_second), "-i", pictures};
  if (format != "gif")
    words.insert(words.end(), {"-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"});
  words.insert(words.end(), {"-f", format, file.temporary_path()});
  if (ffmpeg(words) != 0) throw Failure(fmt::format("{}: ffmpeg could not write it", path));
  file.commit();
}

}  // namespace petzval::app
