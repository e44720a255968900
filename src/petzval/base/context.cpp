// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/context.h>
#include <petzval/base/stop.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <mutex>

namespace petzval {

namespace {

using Clock = std::chrono::steady_clock;
constexpr Clock::duration between_questions = std::chrono::milliseconds(50);

thread_local Listener* listener_of_thread = nullptr;

}  // namespace

/// The callback of a context, asked by all threads that work for it.
class Listener {
 public:
  Listener(const Context& context, Listener* outer) : context_(context), outer_(outer) {}

  void tell(double fraction, const std::string& what) {
    if (context_.progress) {
      const std::lock_guard lock(mutex_);
      fraction_ = fraction, what_ = what;
      ask();
    }
    check();
  }

  void check() {
    if (stopped_.load(std::memory_order_relaxed)) throw Cancelled();
    if (context_.progress &&
        Clock::now().time_since_epoch().count() >= due_.load(std::memory_order_relaxed)) {
      // While one thread asks, the others work.
      const std::unique_lock lock(mutex_, std::try_to_lock);
      if (lock) ask();
    }
    if (stopped_.load(std::memory_order_relaxed)) throw Cancelled();
    if (outer_) outer_->check();
  }

 private:
  void ask() {
    if (!context_.progress(fraction_, what_)) stopped_.store(true, std::memory_order_relaxed);
    due_.store((Clock::now() + between_questions).time_since_epoch().count(), std::memory_order_relaxed);
  }

  const Context& context_;
  Listener* outer_;
  std::mutex mutex_;
  double fraction_ = 0;
  std::string what_;
  std::atomic<bool> stopped_ = false;
  std::atomic<Clock::rep> due_ = 0;  ///< when the callback is asked again
};

Listener* current_listener() {
  return listener_of_thread;
}

ListenerScope::ListenerScope(Listener* listener) : before_(listener_of_thread) {
  listener_of_thread = listener;
}

ListenerScope::~ListenerScope() {
  listener_of_thread = before_;
}

void check_stop() {
  if (listener_of_thread) listener_of_thread->check();
}

void send_note(const Context& context, const std::string& note) {
  if (context.note) context.note(note);
}

void run_within(const Context& context, const std::function<void(const ProgressCallback& progress)>& work) {
  Listener listener(context, current_listener());
  const auto run = [&] {
    const ListenerScope scope(&listener);
    listener.check();
    work([&](double fraction, const std::string& what) { listener.tell(fraction, what); });
  };
  if (context.threads <= 0) return run();
  tbb::task_arena arena(context.threads);
  arena.execute(run);
}

}  // namespace petzval
