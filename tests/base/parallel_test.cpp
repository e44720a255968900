// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <thread>
#include <vector>

namespace petzval {
namespace {

TEST(ParallelFor, CallsEveryIndexOnce) {
  std::vector<std::atomic<int>> calls(1000);
  parallel_for(calls.size(), [&](std::size_t i) { ++calls[i]; });
  for (const std::atomic<int>& count : calls) EXPECT_EQ(count, 1);
  parallel_tasks(calls.size(), [&](std::size_t i) { ++calls[i]; });
  for (const std::atomic<int>& count : calls) EXPECT_EQ(count, 2);
  parallel_for(0, [](std::size_t) { FAIL() << "nothing to do"; });
  parallel_tasks(0, [](std::size_t) { FAIL() << "nothing to do"; });
}

TEST(ParallelFor, HandsOnExceptions) {
  EXPECT_THROW(parallel_for(100,
                            [](std::size_t i) {
                              if (i == 50) throw InputError("fifty");
                            }),
               InputError);
  EXPECT_THROW(parallel_tasks(100,
                              [](std::size_t i) {
                                if (i == 50) throw InputError("fifty");
                              }),
               InputError);
}

TEST(ParallelStages, BeginAndEndInOrderAndKeepTheirSlots) {
  constexpr std::size_t count = 100;
  for (const std::size_t slots : {1U, 2U, 5U}) {
    std::vector<int> busy(slots, 0);
    std::vector<std::size_t> begun, worked(count, 0), ended;
    std::atomic<std::size_t> at_once{0}, most{0};
    parallel_stages(count, slots,
                    {[&](std::size_t item, std::size_t slot) {
                       begun.push_back(item);
                       EXPECT_EQ(busy.at(slot)++, 0) << "the slot is another item's";
                     },
                     [&](std::size_t item, std::size_t slot) {
                       const std::size_t now = ++at_once;
                       for (std::size_t seen = most; seen < now && !most.compare_exchange_weak(seen, now);) {
                       }
                       EXPECT_EQ(busy.at(slot), 1);
                       parallel_for(10, [&](std::size_t) {});
                       worked[item] = item + 1;
                       --at_once;
                     },
                     [&](std::size_t item, std::size_t slot) {
                       EXPECT_EQ(worked[item], item + 1);
                       ended.push_back(item);
                       --busy.at(slot);
                     }});
    ASSERT_EQ(begun.size(), count);
    ASSERT_EQ(ended.size(), count);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(begun[i], i);
      EXPECT_EQ(ended[i], i);
    }
    EXPECT_LE(most, slots);
  }
  parallel_stages(0, 2, {[](auto...) { FAIL(); }, [](auto...) { FAIL(); }, [](auto...) { FAIL(); }});
}

TEST(ParallelStages, HandOnExceptionsOfAnyStage) {
  for (int failing = 0; failing < 3; ++failing) {
    const auto stage = [&](int number) {
      return [=](std::size_t item, std::size_t) {
        if (number == failing && item == 7) throw InputError("seven");
      };
    };
    EXPECT_THROW(parallel_stages(20, 3, {stage(0), stage(1), stage(2)}), InputError) << failing;
  }
}

using InnerLoop = std::function<void(std::size_t count, const std::function<void(std::size_t)>& body)>;

class LoopsInLoops : public ::testing::TestWithParam<InnerLoop> {};

TEST_P(LoopsInLoops, AreDoneWholeOrThrow) {
  const ThreadLimit two(2);
  constexpr std::size_t items = 400;
  int given_up = 0;
  for (int turn = 0; turn < 20; ++turn) {
    std::atomic<bool> inside = false;
    std::atomic<std::size_t> made = 0;
    bool returned = false;
    const auto pause = [] { std::this_thread::sleep_for(std::chrono::microseconds(50)); };
    EXPECT_THROW(parallel_tasks(2,
                                [&](std::size_t i) {
                                  if (i == 0) {
                                    // Until the other has begun its loop, if another thread does it at all.
                                    for (int k = 0; k < 1000 && !inside; ++k) pause();
                                    throw InputError("one of them fails");
                                  }
                                  GetParam()(items, [&](std::size_t) {
                                    inside = true;
                                    pause();
                                    ++made;
                                  });
                                  returned = true;
                                }),
                 InputError);
    EXPECT_TRUE(!returned || made == items) << made << " of " << items;
    given_up += inside && made < items ? 1 : 0;
  }
  EXPECT_GT(given_up, 0) << "loops of items that nobody needs any more";
}

INSTANTIATE_TEST_SUITE_P(All, LoopsInLoops,
                         ::testing::Values(InnerLoop(parallel_for), InnerLoop(parallel_tasks),
                                           InnerLoop([](std::size_t count, const auto& body) {
                                             const auto nothing = [](std::size_t, std::size_t) {};
                                             const auto work = [&](std::size_t i, std::size_t) { body(i); };
                                             parallel_stages(count, 2, {nothing, work, nothing});
                                           })));

TEST(ThreadLimit, HoldsWhileItLives) {
  const int before = thread_count();
  {
    const ThreadLimit one(1);
    EXPECT_EQ(thread_count(), 1);
  }
  EXPECT_EQ(thread_count(), before);
  const ThreadLimit all(0);
  EXPECT_EQ(thread_count(), before);
}

TEST(Errors, NameFileAndLine) {
  EXPECT_STREQ(InputError("lens.json", 12, "no stop").what(), "lens.json:12: no stop");
  EXPECT_STREQ(InputError("lens.json", "no stop").what(), "lens.json: no stop");
}

TEST(NearestNames, RankByEditDistanceWithoutCase) {
  const std::vector<std::string> names = {"N-BK7", "N-SF11", "N-BK10", "F2"};
  EXPECT_EQ(nearest_names("n-bk8", names, 2), (std::vector<std::string>{"N-BK7", "N-BK10"}));
  EXPECT_EQ(nearest_names("x", {}, 3), std::vector<std::string>{});
}

TEST(NearestNames, KnowNamesByAPartOrTheirBeginning) {
  const std::vector<std::string> options = {"--bits",        "--at",       "--black",
                                            "--pixel-pitch", "--variable", "--help"};
  EXPECT_EQ(nearest_names("--pitch", options, 1), std::vector<std::string>{"--pixel-pitch"});
  EXPECT_EQ(nearest_names("--vary", options, 1), std::vector<std::string>{"--variable"});
  EXPECT_EQ(nearest_names("--a", options, 1), std::vector<std::string>{"--at"});  // too short to be a part
}

TEST(DataFiles, ArePathsOrBundledNames) {
  EXPECT_NE(find_data_file("lenses", ".json", "edmund-54852", "lens").find("lenses/edmund-54852.json"),
            std::string::npos);
  try {
    find_data_file("lenses", ".json", "edmund-54851", "lens");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("edmund-54852"), std::string::npos) << error.what();
  }
  EXPECT_THROW(find_data_file("lenses", ".json", "", "lens"), InputError);
  EXPECT_THROW(find_data_file("lenses", ".json", "no/such/file.json", "lens"), InputError);
}

}  // namespace
}  // namespace petzval
