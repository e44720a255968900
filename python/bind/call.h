// SPDX-License-Identifier: BSD-3-Clause
// Long calls: without the GIL, with progress, and ended by Ctrl-C.
#pragma once

#include <nanobind/nanobind.h>
#include <petzval/base/context.h>

#include <cstdint>
#include <optional>

namespace petzval::python {

/// How a long call works, as the keywords `threads`, `seed` and `progress` say.
struct CallOptions {
  int threads = 0;
  std::uint64_t seed = 1;
  nanobind::object progress = nanobind::none();  ///< progress(fraction, what); False: stop
};

/// Does `work(context)` without the GIL and gives what it gives. Notes become warnings of petzval.Note. In
/// the main thread SIGINT ends the work, and then what Python's handler of it raises is raised. What the work
/// reads must not be altered by other threads meanwhile: the caller copies lenses and the like.
class Call {
 public:
  explicit Call(const CallOptions& options = {});
  ~Call();
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  template <typename Work>
  auto operator()(const Work& work) -> decltype(work(std::declval<const Context&>())) {
    try {
      const nanobind::gil_scoped_release unlocked;
      return work(context_);
    } catch (const Cancelled&) {
      raise_if_interrupted();
      throw;
    }
  }

 private:
  static void raise_if_interrupted();
  bool ask(double fraction, const std::string& what);

  nanobind::object progress_;
  Context context_;
  bool watches_ = false;  ///< SIGINT
  unsigned seen_ = 0;     ///< interrupts before the call
};

}  // namespace petzval::python
