// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <fmt/format.h>
#include <petzval/base/child_process.h>
#include <petzval/base/error.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>

namespace petzval {

namespace {

constexpr int exit_finished = 0, exit_wrong_input = 3, exit_failed = 4;  // sanitizers end with 1

/// What a child says to its parent: a zero-terminated message in memory that they share.
class Message {
 public:
  Message()
      : text_(static_cast<char*>(
            mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))) {
    if (text_ == MAP_FAILED) throw Failure("too little memory to start a process");
  }
  ~Message() { munmap(text_, size); }
  Message(const Message&) = delete;
  Message& operator=(const Message&) = delete;

  void say(const char* text) { std::strncpy(text_, text, size - 1); }
  std::string heard() const { return {text_, strnlen(text_, size)}; }

 private:
  static constexpr std::size_t size = 4096;
  char* text_;
};

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

void be_quiet() {
  const int nowhere = open("/dev/null", O_RDWR);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);  // the C library's last words about a broken heap
}

void apply(const ChildLimits& limits) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // it has nobody else to work for
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGTERM, SIGINT})
    std::signal(signal, SIG_DFL);
  limit_to(RLIMIT_CORE, 0);
  limit_to(RLIMIT_CPU, static_cast<rlim_t>(std::ceil(limits.processor_s)));
  if (const std::size_t present = address_space(); present > 0)
    limit_to(RLIMIT_AS, present + limits.memory_bytes);
}

[[noreturn]] void live(const std::function<void()>& work, const ChildLimits& limits, Message& message) {
  int end = exit_failed;
  try {
    be_quiet();
    apply(limits);
    work();
    end = exit_finished;
  } catch (const InputError& error) {
    message.say(error.what());
    end = exit_wrong_input;
  } catch (const std::exception& error) {
    message.say(error.what());
  } catch (...) {
    message.say("unknown exception");
  }
  _exit(end);
}

}  // namespace

ChildEnd run_in_child(const std::function<void()>& work, const ChildLimits& limits) {
  Message message;
  const pid_t child = fork();
  if (child < 0) throw Failure(fmt::format("no process can be started: {}", std::strerror(errno)));
  if (child == 0) live(work, limits, message);
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR)
      throw Failure(fmt::format("a process cannot be waited for: {}", std::strerror(errno)));
  if (WIFSIGNALED(status)) return WTERMSIG(status) == SIGXCPU ? ChildEnd::endless : ChildEnd::crashed;
  const int end = WEXITSTATUS(status);
  if (end == exit_wrong_input) throw InputError(message.heard());
  if (end == exit_failed) throw Failure(message.heard());
  return end == exit_finished ? ChildEnd::finished : ChildEnd::crashed;
}

}  // namespace petzval
