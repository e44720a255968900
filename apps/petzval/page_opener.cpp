// SPDX-License-Identifier: BSD-3-Clause
#include "page_opener.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <petzval/base/whole_file.h>
#include <spawn.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

extern char** environ;

namespace petzval::app {

bool PageOpener::open(const std::string& url) {
  if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY")) return false;
  std::string file = folder_.path() + "/open-petzval.html";
  write_whole_file(
      file, fmt::format("<!doctype html><meta charset=\"utf-8\"><title>Petzval</title>\n"
                        "<meta http-equiv=\"refresh\" content=\"0;url={0}\"><a href=\"{0}\">Petzval</a>\n",
                        url));
  std::string program = "xdg-open";
  char* const words[] = {program.data(), file.data(), nullptr};
  // Some browsers stay in the foreground: it is not waited for.
  std::signal(SIGCHLD, SIG_IGN);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failed = posix_spawnp(&child, program.c_str(), &actions, nullptr, words, environ);
  posix_spawn_file_actions_destroy(&actions);
  return failed == 0;
}

}  // namespace petzval::app
