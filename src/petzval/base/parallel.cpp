// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_pipeline.h>

namespace petzval {

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body) {
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) { body(i); });
}

void parallel_stages(std::size_t count, std::size_t slots, const Stages& stages) {
  // Items end in order, so that the one that had a slot before has ended when the next begins.
  std::size_t next = 0;
  const auto begin = [&](tbb::flow_control& control) {
    if (next == count) {
      control.stop();
      return count;
    }
    stages.begin(next, next % slots);
    return next++;
  };
  const auto work = [&](std::size_t item) {
    stages.work(item, item % slots);
    return item;
  };
  const auto end = [&](std::size_t item) { stages.end(item, item % slots); };
  tbb::parallel_pipeline(slots,
                         tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, begin) &
                             tbb::make_filter<std::size_t, std::size_t>(tbb::filter_mode::parallel, work) &
                             tbb::make_filter<std::size_t, void>(tbb::filter_mode::serial_in_order, end));
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
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

}  // namespace petzval
