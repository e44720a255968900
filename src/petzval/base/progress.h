// SPDX-License-Identifier: BSD-3-Clause
// Progress of long work, told to whoever listens.
#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <string>

namespace petzval {

/// Told about long work: `fraction` in [0, 1], `what` a short noun ("lens data table", "blur", "light").
/// Called from any thread. What it throws ends the work. Library functions take a `const ProgressCallback&`
/// and accept an empty one.
using ProgressCallback = std::function<void(double fraction, const std::string& what)>;

/// A bar on stderr for work that lasts over two seconds; where stderr is no terminal, a line every ten
/// seconds.
class ProgressBar {
 public:
  /// \param enabled  false (--quiet) keeps it silent whatever stderr is.
  explicit ProgressBar(bool enabled = true);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void update(double fraction, const std::string& what);
  /// A callback that updates this bar; the bar must outlive it.
  ProgressCallback callback();

 private:
  bool enabled_, terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_, last_;
  std::mutex mutex_;
};

}  // namespace petzval
