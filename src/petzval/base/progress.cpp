// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/progress.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace petzval {

ProgressBar::ProgressBar(bool enabled)
    : enabled_(enabled),
      terminal_(isatty(STDERR_FILENO) != 0),
      start_(std::chrono::steady_clock::now()),
      last_(start_) {}

ProgressBar::~ProgressBar() {
  if (drawn_ && terminal_) std::fputs("\r\033[K", stderr);
}

void ProgressBar::update(double fraction, const std::string& what) {
  if (!enabled_) return;
  const std::lock_guard lock(mutex_);
  using namespace std::chrono_literals;
  const auto now = std::chrono::steady_clock::now();
  const std::chrono::steady_clock::duration between = terminal_ ? 100ms : 10s;
  if (now - start_ < 2s || now - last_ < between) return;
  last_ = now;
  drawn_ = true;
  fraction = std::clamp(fraction, 0.0, 1.0);
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  std::string line = fmt::format("{:3.0f} % {} {:.0f} s", 100 * fraction, what, elapsed);
  if (fraction > 0.02) line += fmt::format(", about {:.0f} s left", elapsed * (1 - fraction) / fraction);
  const int filled = static_cast<int>(fraction * 30);
  fmt::print(stderr, "{}{}{}",
             terminal_ ? fmt::format("\r\033[K[{:<30}] ", std::string(filled, '=')) : "petzval: ", line,
             terminal_ ? "" : "\n");
  std::fflush(stderr);
}

ProgressCallback ProgressBar::callback() {
  return [this](double fraction, const std::string& what) { update(fraction, what); };
}

}  // namespace petzval
