// SPDX-License-Identifier: BSD-3-Clause
#include "clip.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <optional>
#include <vector>

#include "command.h"

extern char** environ;

namespace petzval::app {

namespace {

/// Runs ffmpeg, which prints its errors itself. \returns its exit code, or nothing if it cannot be started.
std::optional<int> ffmpeg(std::vector<std::string> words) {
  words.insert(words.begin(), {"ffmpeg", "-nostdin", "-loglevel", "error"});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  // What it prints is no result of ours.
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  const int failed = posix_spawnp(&child, "ffmpeg", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) return {};
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
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
