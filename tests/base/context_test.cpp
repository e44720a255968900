// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/context.h>
#include <petzval/base/parallel.h>
#include <petzval/base/stop.h>

#include <atomic>
#include <thread>

namespace petzval {
namespace {

TEST(Context, LetsWorkWithoutCallbacksRun) {
  EXPECT_EQ(result_within(Context(),
                          [](const ProgressCallback& progress) {
                            progress(0.5, "work");
                            return 42;
                          }),
            42);
}

TEST(Context, TellsProgress) {
  std::vector<std::pair<double, std::string>> told;
  Context context;
  context.progress = [&](double fraction, const std::string& what) {
    told.emplace_back(fraction, what);
    return true;
  };
  run_within(context, [](const ProgressCallback& progress) { progress(0.25, "light"); });
  ASSERT_FALSE(told.empty());
  EXPECT_NE(std::find(told.begin(), told.end(), std::pair(0.25, std::string("light"))), told.end());
}

TEST(Context, EndsALoopWhenTheCallbackSaysStop) {
  std::atomic<int> done = 0;
  Context context;
  context.progress = [&](double, const std::string&) { return done < 10; };
  const auto work = [&](const ProgressCallback&) {
    parallel_for(1'000'000, [&](std::size_t) {
      ++done;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    });
  };
  EXPECT_THROW(run_within(context, work), Cancelled);
  EXPECT_LT(done, 1'000'000);
}

TEST(Context, EndsTasksAndStagesToo) {
  const auto stop_later = [](std::atomic<int>& done) {
    Context context;
    context.progress = [&](double, const std::string&) { return done < 10; };
    return context;
  };
  const auto millisecond = [](std::atomic<int>& done) {
    ++done;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  std::atomic<int> tasks = 0, staged = 0;
  EXPECT_THROW(run_within(stop_later(tasks),
                          [&](const ProgressCallback&) {
                            parallel_tasks(1'000'000, [&](std::size_t) { millisecond(tasks); });
                          }),
               Cancelled);
  EXPECT_THROW(run_within(stop_later(staged),
                          [&](const ProgressCallback&) {
                            const auto nothing = [](std::size_t, std::size_t) {};
                            parallel_stages(
                                1'000'000, 4,
                                {nothing, [&](std::size_t, std::size_t) { millisecond(staged); }, nothing});
                          }),
               Cancelled);
}

TEST(Context, StopsBeforeAnythingIsDone) {
  Context context;
  context.progress = [](double, const std::string&) { return false; };
  bool begun = false;
  EXPECT_THROW(run_within(context, [&](const ProgressCallback&) { begun = true; }), Cancelled);
  EXPECT_FALSE(begun);
}

TEST(Context, LeavesWorkThatIsDoneWhenStopComesTooLate) {
  bool wanted = true;
  Context context;
  context.progress = [&](double, const std::string&) { return wanted; };
  // As if a file were in its place: to say that nothing was done would be wrong.
  EXPECT_NO_THROW(run_within(context, [&](const ProgressCallback&) {
    wanted = false;
    std::this_thread::sleep_for(std::chrono::milliseconds(60));  // so that it would be asked
  }));
}

TEST(Context, AnOuterContextStopsTheInnerOne) {
  std::atomic<int> done = 0;
  Context outer;
  outer.progress = [&](double, const std::string&) { return done < 10; };
  EXPECT_THROW(run_within(outer,
                          [&](const ProgressCallback&) {
                            run_within(Context(), [&](const ProgressCallback&) {
                              for (;;) {
                                ++done;
                                std::this_thread::sleep_for(std::chrono::milliseconds(1));
                                check_stop();
                              }
                            });
                          }),
               Cancelled);
}

TEST(Context, HoldsItsThreads) {
  Context one;
  one.threads = 1;
  run_within(one, [](const ProgressCallback&) {
    EXPECT_EQ(thread_count(), 1);
    std::atomic<int> at_once = 0;
    parallel_for(1000, [&](std::size_t) {
      EXPECT_EQ(++at_once, 1);
      --at_once;
    });
  });
}

TEST(Context, IsForgottenWhenTheWorkEnds) {
  Context context;
  context.progress = [](double, const std::string&) { return true; };
  run_within(context, [](const ProgressCallback&) { EXPECT_NE(current_listener(), nullptr); });
  EXPECT_EQ(current_listener(), nullptr);
  check_stop();  // nobody is asked
}

TEST(Context, TellsNotesToWhoListens) {
  send_note(Context(), "nobody listens");
  std::string heard;
  Context context;
  context.note = [&](const std::string& text) { heard = text; };
  send_note(context, "the sensor moved");
  EXPECT_EQ(heard, "the sensor moved");
}

}  // namespace
}  // namespace petzval
