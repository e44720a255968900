// SPDX-License-Identifier: BSD-3-Clause
// The thread of one page: the newest state counts, and what was begun for an older one is given up.
#pragma once

#include <petzval/live/bench.h>

#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>

namespace petzval {

/// Takes messages from the server's thread, works on its own, and sends replies through `send`, which is
/// called from that thread and from that of the plots.
class BenchWorker {
 public:
  BenchWorker(const LiveStart& start, int threads, SendReply send);
  /// Waits for the thread, which ends within a twentieth of a second of work.
  ~BenchWorker();
  BenchWorker(const BenchWorker&) = delete;
  BenchWorker& operator=(const BenchWorker&) = delete;

  /// A message as it came. \returns false if so many wait that the page cannot be a right one.
  bool take(std::string message, bool binary);
  /// No more replies; the thread ends soon.
  void end();

 private:
  struct Raw {
    std::string bytes;
    bool binary = false;
  };

  void work();
  /// The next thing to do; nothing at the end.
  bool wait_for_work();
  void do_raw(const Raw& raw, Bench& bench);
  void show_newest(Bench& bench);
  Context context();

  const LiveStart start_;
  const int threads_;
  const SendReply send_;
  std::mutex mutex_;
  std::condition_variable woken_;
  std::deque<Raw> waiting_;
  std::optional<BenchState> newest_;  ///< not shown to its end; of the worker's thread alone
  std::atomic<bool> ending_ = false, something_new_ = false;
  std::thread thread_;
};

}  // namespace petzval
