// SPDX-License-Identifier: BSD-3-Clause
#include "call.h"

#include <nanobind/stl/string.h>
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>

namespace nb = nanobind;

namespace petzval::python {

namespace {

/// SIGINTs that came while a call watched for them.
std::atomic<unsigned> interrupts = 0;
static_assert(std::atomic<unsigned>::is_always_lock_free);

struct sigaction handler_before;  // of Python
int watching = 0;                 ///< calls of the main thread, one within another's callback

/// Python's handler is told too: it notes the signal, and the main thread raises KeyboardInterrupt later.
void on_interrupt(int number, siginfo_t* info, void* place) {
  interrupts.fetch_add(1);
  if (handler_before.sa_flags & SA_SIGINFO)
    handler_before.sa_sigaction(number, info, place);
  else
    handler_before.sa_handler(number);
}

bool is_main_thread() {
  return syscall(SYS_gettid) == getpid();
}

bool has_handler(const struct sigaction& action) {
  return (action.sa_flags & SA_SIGINFO) || (action.sa_handler != SIG_DFL && action.sa_handler != SIG_IGN);
}

/// \returns whether SIGINT is watched for.
bool watch() {
  if (!is_main_thread()) return false;
  if (watching == 0) {
    if (sigaction(SIGINT, nullptr, &handler_before) != 0 || !has_handler(handler_before)) return false;
    struct sigaction ours = handler_before;
    ours.sa_flags |= SA_SIGINFO;
    ours.sa_sigaction = on_interrupt;
    if (sigaction(SIGINT, &ours, nullptr) != 0) return false;
  }
  ++watching;
  return true;
}

void unwatch() {
  if (--watching > 0) return;
  struct sigaction now;
  // A callback may have set another handler: that one stays.
  if (sigaction(SIGINT, nullptr, &now) == 0 && (now.sa_flags & SA_SIGINFO) &&
      now.sa_sigaction == on_interrupt)
    sigaction(SIGINT, &handler_before, nullptr);
}

void warn(const std::string& text) {
  const nb::gil_scoped_acquire locked;
  const nb::module_ errors = nb::module_::import_("petzval._errors");
  const nb::object in_python = errors.attr("with_keywords")(text.c_str());
  const auto level = nb::cast<Py_ssize_t>(errors.attr("frames_to_caller")());
  if (PyErr_WarnEx(errors.attr("Note").ptr(), nb::cast<const char*>(in_python), level) != 0)
    throw nb::python_error();
}

}  // namespace

Call::Call(const CallOptions& options) : progress_(options.progress), watches_(watch()) {
  seen_ = interrupts.load();
  context_.threads = options.threads;
  context_.seed = options.seed;
  context_.note = warn;
  if (watches_ || !progress_.is_none())
    context_.progress = [this](double fraction, const std::string& what) { return ask(fraction, what); };
}

Call::~Call() {
  if (watches_) unwatch();
}

bool Call::ask(double fraction, const std::string& what) {
  if (watches_ && interrupts.load() != seen_) return false;
  if (progress_.is_none()) return true;
  const nb::gil_scoped_acquire locked;
  const nb::object answer = progress_(fraction, what);
  return !answer.is(nb::bool_(false));
}

void Call::raise_if_interrupted() {
  if (PyErr_CheckSignals() != 0) throw nb::python_error();
}

}  // namespace petzval::python
