// SPDX-License-Identifier: BSD-3-Clause
// The plots of the bench, on a thread of their own.
#pragma once

#include <petzval/live/bench.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace petzval {

/// What is to be plotted.
struct PlotWish {
  std::int64_t id = 0;
  std::string key = {};  ///< says everything of the lens
  CoatedLens lens = {};
  std::vector<std::string> analyses = {};
  int threads = 0;      ///< that the whole bench has; slow plots take half of them
  bool finely = false;  ///< of the MTF, as many frequencies as a smooth curve needs; others are smooth anyway
};

/// Makes the plots of the newest wish while the bench goes on, so that none of them delays the rays of the
/// next move. A plot that has not been shown for a second is finished before it gives way to a newer wish;
/// one that was shown as it is, is left out.
class BenchPlots {
 public:
  /// \param send  is called from the thread of the plots.
  explicit BenchPlots(SendReply send);
  ~BenchPlots();
  BenchPlots(const BenchPlots&) = delete;
  BenchPlots& operator=(const BenchPlots&) = delete;

  void wish(PlotWish wish);
  /// Waits a moment for plots that were quick the last time, which the picture's threads would hold up.
  void let_quick_ones_pass(const std::function<bool()>& stop);
  /// Waits until all that was wished for is shown. \returns false if `stop` said so before.
  bool wait(const std::function<bool()>& stop);

 private:
  using Clock = std::chrono::steady_clock;

  void work();
  void show(const PlotWish& wish);
  /// \param again  only smoother than before: what the hand waited for was that.
  void plot(const PlotWish& wish, const std::string& name, bool again);
  bool gives_way(const std::string& name);
  /// As they were the last time; unless that is known, they are.
  bool are_quick(const std::vector<std::string>& analyses) const;

  const SendReply send_;
  std::mutex mutex_;
  std::condition_variable woken_;
  std::optional<PlotWish> wished_;  ///< not begun yet
  bool ending_ = false, busy_ = false, quick_ = true;
  std::map<std::string, double> took_ms_;
  std::map<std::string, std::string> shown_;  ///< analysis → key; of the thread alone, as the next
  std::map<std::string, Clock::time_point> shown_at_;
  std::thread thread_;
};

}  // namespace petzval
