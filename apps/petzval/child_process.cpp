// SPDX-License-Identifier: BSD-3-Clause
#include "child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

extern char** environ;

namespace petzval::app {

namespace {

std::string taken_from(const std::string& path) {
  std::string bytes = read_whole_file(path);
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  return bytes;
}

}  // namespace

ChildOutcome run_again(const std::vector<std::string>& arguments, const std::string& out_path,
                       const std::string& error_path) {
  std::vector<std::string> words{"petzval"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  constexpr int create = O_WRONLY | O_CREAT | O_TRUNC, mode = 0644;
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, out_path.c_str(), create, mode);
  posix_spawn_file_actions_addopen(&actions, 2, error_path.c_str(), create, mode);
  pid_t child = 0;
  const int refused = posix_spawn(&child, "/proc/self/exe", &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (refused != 0)
    throw Failure(fmt::format("the program cannot be started again: {}", std::strerror(refused)));
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) throw Failure(fmt::format("waiting for a point: {}", std::strerror(errno)));
  ChildOutcome outcome;
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  outcome.out = taken_from(out_path);
  outcome.error = taken_from(error_path);
  return outcome;
}

}  // namespace petzval::app
