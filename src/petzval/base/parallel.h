// SPDX-License-Identifier: BSD-3-Clause
// Parallel loops whose result does not depend on the number of threads.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace petzval {

/// Calls `body(i)` once for each i in [0, count), on any thread, in any order. Bodies must write to places of
/// their own: sums are made afterwards, in order, so that bytes do not depend on the schedule. An exception
/// of a body ends the loop and is rethrown; loops within other bodies of it then throw, too. Before every
/// item the context that the loop runs in is asked whether to go on (base/context.h). \throws Cancelled.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body);

/// The same for bodies of a millisecond or more: they are handed out one by one. parallel_for() hands out
/// pieces of many, which costs less, but at the end one thread may have a piece left and the others nothing
/// to do.
void parallel_tasks(std::size_t count, const std::function<void(std::size_t)>& body);

/// What is done with every item, in a slot of its own [0, slots).
struct Stages {
  using Stage = std::function<void(std::size_t item, std::size_t slot)>;
  Stage begin, work, end;
};

/// Takes the items [0, count) through three stages, at most `slots` items at a time. `begin` and `end` are
/// called for one item after the other, in order, `work` for several at once; all may use parallel_for. An
/// item has its slot to itself from its beginning to its end. An exception ends everything and is rethrown.
void parallel_stages(std::size_t count, std::size_t slots, const Stages& stages);

/// While it lives, at most `threads` threads work in parallel loops anywhere in this process (0: as many as
/// the machine has): for tests and benchmarks. Callers of the library say it in their Context.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The number of threads that parallel_for may use now.
int thread_count();

}  // namespace petzval
