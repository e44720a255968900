// SPDX-License-Identifier: BSD-3-Clause
// How long a stage of the bench takes.
#pragma once

#include <chrono>
#include <cmath>
#include <ctime>

namespace petzval {

/// From its construction on, in milliseconds to a tenth.
class StageTime {
 public:
  double ms() const {
    return tenths(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began_).count());
  }
  /// Of all processors and of whatever else the program does meanwhile.
  double cpu_ms() const {
    constexpr double ms_per_s = 1000;
    return tenths(static_cast<double>(std::clock() - worked_) * ms_per_s / CLOCKS_PER_SEC);
  }

 private:
  static double tenths(double value) { return std::round(value * 10) / 10; }

  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  std::clock_t worked_ = std::clock();
};

}  // namespace petzval
