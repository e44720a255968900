// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/context.h>
#include <petzval/base/isolated.h>
#include <petzval/base/parallel.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace petzval {
namespace {

TEST(RunIsolated, NoItemOfTheLoopAroundBeginsWithinIt) {
  // Waits are what is tested: eight threads have them on any machine.
  const ThreadLimit eight(8);
  thread_local bool inside = false;
  std::atomic<int> within{0}, done{0};
  run_within({.threads = 8}, [&](const ProgressCallback&) {
    parallel_tasks(200, [&](std::size_t) {
      if (inside) ++within;
      inside = true;
      run_isolated([&] {
        parallel_tasks(8, [&](std::size_t) {
          std::this_thread::sleep_for(std::chrono::microseconds(100));
          ++done;
        });
      });
      inside = false;
    });
  });
  EXPECT_EQ(within, 0);
  EXPECT_EQ(done, 200 * 8);
}

}  // namespace
}  // namespace petzval
