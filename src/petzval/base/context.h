// SPDX-License-Identifier: BSD-3-Clause
// How work is done: on how many threads, from which seed, and who hears of it and may stop it.
#pragma once

#include <petzval/base/error.h>
#include <petzval/base/progress.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace petzval {

/// What every long function of the library is given:
///
///     Context context;
///     context.seed = 7;
///     context.note = [](const std::string& text) { std::cerr << text << '\n'; };
///     context.progress = [&](double fraction, const std::string& what) { return !stop_button.pressed(); };
///
/// A default Context works on all cores, in silence. The same inputs and seed give the same bytes for any
/// number of threads.
struct Context {
  int threads = 0;         ///< at most this many work; 0: as many as the machine has
  std::uint64_t seed = 1;  ///< of everything random
  /// Told what the user should know; may be empty. One call at a time, from the calling thread.
  std::function<void(const std::string& text)> note = {};
  /// Told how far the work is, at least ten times a second; may be empty. `fraction` is in [0, 1], `what` a
  /// short noun ("lens data table", "blur", "light"). Returns whether to go on: after `false` the work ends
  /// with Cancelled. Called from any thread, one call at a time.
  std::function<bool(double fraction, const std::string& what)> progress = {};
};

/// The progress callback said stop. Files are as they were before the work began.
class Cancelled : public Error {
 public:
  Cancelled() : Error("the work was stopped") {}
};

/// Tells a note to whoever listens.
void send_note(const Context& context, const std::string& note);

/// Does `work` on at most `context.threads` threads. While it runs, every parallel loop in it asks the
/// context's callback whether to go on; work that is neither a loop nor short calls check_stop(). `progress`
/// tells the callback how far the work is. Contexts nest: the inner one's callback is asked, then the outer
/// one's. \throws Cancelled when one says stop before the work is done, and whatever `work` throws.
void run_within(const Context& context, const std::function<void(const ProgressCallback& progress)>& work);

/// The same for work with a result.
template <typename Work>
auto result_within(const Context& context, const Work& work) {
  std::optional<decltype(work(ProgressCallback()))> result;
  run_within(context, [&](const ProgressCallback& progress) { result.emplace(work(progress)); });
  return *std::move(result);
}

}  // namespace petzval
