// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/helper_process.h>
#include <petzval/base/nameless_file.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>

namespace petzval {

namespace {

constexpr int exit_finished = 0, exit_wrong_input = 3, exit_failed = 4;  // sanitizers end with 1
constexpr int work_descriptor = 3;
constexpr const char* limits_variable = "PETZVAL_HELPER_LIMITS";

/// posix_spawn's list of what to do to the files of a program before it begins.
class FileActions {
 public:
  FileActions() { posix_spawn_file_actions_init(&actions_); }
  ~FileActions() { posix_spawn_file_actions_destroy(&actions_); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;

  void nowhere(int descriptor, int flags) {
    posix_spawn_file_actions_addopen(&actions_, descriptor, "/dev/null", flags, 0);
  }
  void as(int descriptor, int wanted) { posix_spawn_file_actions_adddup2(&actions_, descriptor, wanted); }
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

/// Signals as they are by default, and none held back, whatever this program does with them.
class PlainSignals {
 public:
  PlainSignals() {
    posix_spawnattr_init(&attributes_);
    sigset_t all, none;
    sigfillset(&all);
    sigemptyset(&none);
    posix_spawnattr_setsigdefault(&attributes_, &all);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  }
  ~PlainSignals() { posix_spawnattr_destroy(&attributes_); }
  PlainSignals(const PlainSignals&) = delete;
  PlainSignals& operator=(const PlainSignals&) = delete;

  const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_;
};

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> result;
  for (std::string& word : words) result.push_back(word.data());
  result.push_back(nullptr);
  return result;
}

std::vector<std::string> environment_with(const HelperLimits& limits) {
  const std::string name = std::string(limits_variable) + "=";
  std::vector<std::string> all;
  for (char** entry = environ; *entry != nullptr; ++entry)
    if (!std::string_view(*entry).starts_with(name)) all.emplace_back(*entry);
  all.push_back(fmt::format("{}{:.0f} {}", name, std::ceil(limits.processor_s), limits.memory_bytes));
  return all;
}

std::string text_of(const NamelessFile& file) {
  std::array<char, 4096> text{};
  const ssize_t size = pread(file.descriptor(), text.data(), text.size(), 0);
  return {text.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0))};
}

void limit_to(int resource, rlim_t soft) {
  rlimit limit{};
  getrlimit(resource, &limit);
  limit.rlim_cur = std::min(soft, limit.rlim_max);
  setrlimit(resource, &limit);
}

/// Address space of this process [bytes]; a sanitizer's shadow is in it.
std::size_t address_space() {
  unsigned long pages = 0;
  if (std::FILE* const file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%lu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

void apply_limits() {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // it has nobody else to work for
  limit_to(RLIMIT_CORE, 0);
  unsigned long processor_s = 0, memory_bytes = 0;
  const char* text = std::getenv(limits_variable);
  if (text == nullptr || std::sscanf(text, "%lu %lu", &processor_s, &memory_bytes) != 2) return;
  limit_to(RLIMIT_CPU, processor_s);
  if (const std::size_t present = address_space(); present > 0) limit_to(RLIMIT_AS, present + memory_bytes);
}

/// The message of an exception goes to standard output, which is a file of whoever waits.
int say(const char* message, int end) {
  const std::size_t length = std::min<std::size_t>(std::strlen(message), 4096);
  return write(STDOUT_FILENO, message, length) == static_cast<ssize_t>(length) ? end : exit_failed;
}

}  // namespace

std::string helper_program(const std::string& name) {
  namespace fs = std::filesystem;
  const fs::path path =
      (fs::path(default_data_directory()) / ".." / ".." / "libexec" / "petzval" / name).lexically_normal();
  std::error_code error;
  if (!fs::is_regular_file(path, error))
    throw Failure(
        fmt::format("{} is missing, a part of Petzval's installation; install it again", path.string()));
  return path.string();
}

HelperEnd run_helper(const std::string& program, const std::vector<std::string>& words, int descriptor,
                     const HelperLimits& limits) {
  const NamelessFile message;
  if (!message) throw Failure("there is no room for files in $TMPDIR or /var/tmp");
  FileActions files;
  files.nowhere(STDIN_FILENO, O_RDONLY);
  files.nowhere(STDERR_FILENO, O_WRONLY);
  // A descriptor that lies where another is wanted would be lost.
  const int low = descriptor < 0 ? -1 : fcntl(descriptor, F_DUPFD_CLOEXEC, 10);
  const int said = fcntl(message.descriptor(), F_DUPFD_CLOEXEC, 10);
  files.as(said, STDOUT_FILENO);
  if (low >= 0) files.as(low, work_descriptor);
  std::vector<std::string> arguments{program}, environment = environment_with(limits);
  arguments.insert(arguments.end(), words.begin(), words.end());
  pid_t child = 0;
  const int failed = posix_spawn(&child, program.c_str(), files.get(), PlainSignals().get(),
                                 pointers(arguments).data(), pointers(environment).data());
  close(said);
  if (low >= 0) close(low);
  if (failed != 0) throw Failure(fmt::format("{} cannot be started: {}", program, std::strerror(failed)));
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR)
      throw Failure(fmt::format("a process cannot be waited for: {}", std::strerror(errno)));
  if (WIFSIGNALED(status)) return WTERMSIG(status) == SIGXCPU ? HelperEnd::endless : HelperEnd::crashed;
  const int end = WEXITSTATUS(status);
  if (end == exit_wrong_input) throw InputError(text_of(message));
  if (end == exit_failed) throw Failure(text_of(message));
  return end == exit_finished ? HelperEnd::finished : HelperEnd::crashed;
}

int help(const std::function<void()>& work) {
  try {
    apply_limits();
    work();
    return exit_finished;
  } catch (const InputError& error) {
    return say(error.what(), exit_wrong_input);
  } catch (const std::exception& error) {
    return say(error.what(), exit_failed);
  } catch (...) {
    return say("unknown exception", exit_failed);
  }
}

}  // namespace petzval
