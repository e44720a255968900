// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/context.h>
#include <petzval/base/parallel.h>
#include <petzval/base/stop.h>
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>

namespace petzval {

namespace {

/// A loop in an item of another one ends early when that one is given up for what another of its items threw.
/// TBB then returns as if all had been done; what the loop was to make must not be used.
template <typename Loop>
void run_whole(const Loop& loop) {
  tbb::task_group_context group;
  loop(group);
  if (group.is_group_execution_cancelled()) throw Cancelled();
}

}  // namespace

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body) {
  Listener* const listener = current_listener();
  const auto item = [&](std::size_t i) {
    const ListenerScope scope(listener);
    check_stop();
    body(i);
  };
  run_whole([&](tbb::task_group_context& group) { tbb::parallel_for(std::size_t{0}, count, item, group); });
}

void parallel_tasks(std::size_t count, const std::function<void(std::size_t)>& body) {
  Listener* const listener = current_listener();
  const tbb::blocked_range<std::size_t> all(0, count);
  const auto items = [&](const tbb::blocked_range<std::size_t>& range) {
    const ListenerScope scope(listener);
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      check_stop();
      body(i);
    }
  };
  run_whole([&](tbb::task_group_context& group) {
    tbb::parallel_for(all, items, tbb::simple_partitioner(), group);
  });
}

void parallel_stages(std::size_t count, std::size_t slots, const Stages& stages) {
  Listener* const listener = current_listener();
  // Items end in order, so that the one that had a slot before has ended when the next begins.
  std::size_t next = 0;
  const auto begin = [&](tbb::flow_control& control) {
    if (next == count) {
      control.stop();
      return count;
    }
    const ListenerScope scope(listener);
    check_stop();
    stages.begin(next, next % slots);
    return next++;
  };
  const auto work = [&](std::size_t item) {
    const ListenerScope scope(listener);
    stages.work(item, item % slots);
    return item;
  };
  const auto end = [&](std::size_t item) {
    const ListenerScope scope(listener);
    stages.end(item, item % slots);
  };
  const auto all = tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, begin) &
                   tbb::make_filter<std::size_t, std::size_t>(tbb::filter_mode::parallel, work) &
                   tbb::make_filter<std::size_t, void>(tbb::filter_mode::serial_in_order, end);
  run_whole([&](tbb::task_group_context& group) { tbb::parallel_pipeline(slots, all, group); });
}

struct ThreadLimit::Impl {
  tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads) {
  if (threads > 0)
    impl_ = std::unique_ptr<Impl>(
        new Impl{{tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)}});
}

ThreadLimit::~ThreadLimit() = default;

int thread_count() {
  const auto of_process = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return std::min(static_cast<int>(of_process), tbb::this_task_arena::max_concurrency());
}

}  // namespace petzval
