// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/live/bench_worker.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

namespace petzval {

namespace {

/// More messages than a page sends while one is looked at; more bytes than an upload and what comes with it.
constexpr std::size_t most_waiting = 512, most_waiting_bytes = most_upload_bytes + 8 * most_message_bytes;

/// Pictures come one after the other: the memory of the last is kept for the next, until the hand rests.
void keep_memory() {
#ifdef __GLIBC__
  constexpr int largest_plane = 1 << 25, kept = 1 << 28;  // bytes
  mallopt(M_MMAP_THRESHOLD, largest_plane);
  mallopt(M_TRIM_THRESHOLD, kept);
#endif
}

/// What the last pictures took and nothing needs any more.
void give_back_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

std::string refusal(const std::string& text) {
  return nlohmann::json{{"kind", "refused"}, {"text", text}}.dump(-1, ' ', false,
                                                                  nlohmann::json::error_handler_t::replace);
}

}  // namespace

BenchWorker::BenchWorker(const LiveStart& start, int threads, SendReply send)
    : start_(start), threads_(threads), send_(std::move(send)), thread_([this] { work(); }) {}

BenchWorker::~BenchWorker() {
  end();
  thread_.join();
}

void BenchWorker::end() {
  // Not between what work() reads of one and writes to the other, which would let a picture go on to its end.
  const std::lock_guard lock(mutex_);
  ending_ = true;
  something_new_ = true;
  woken_.notify_all();
}

bool BenchWorker::take(std::string message, bool binary) {
  const std::lock_guard lock(mutex_);
  std::size_t bytes = message.size();
  for (const Raw& raw : waiting_) bytes += raw.bytes.size();
  if (waiting_.size() >= most_waiting || bytes > most_waiting_bytes) return false;
  waiting_.push_back({std::move(message), binary});
  something_new_ = true;
  woken_.notify_all();
  return true;
}

Context BenchWorker::context() {
  Context context;
  context.threads = threads_;
  context.progress = [this](double, const std::string&) { return !something_new_; };
  return context;
}

bool BenchWorker::wait_for_work() {
  constexpr std::chrono::seconds pause{1};
  std::unique_lock lock(mutex_);
  const auto is_there = [this] { return ending_ || !waiting_.empty() || newest_; };
  if (!woken_.wait_for(lock, pause, is_there)) {
    lock.unlock();
    give_back_memory();
    lock.lock();
    woken_.wait(lock, is_there);
  }
  return !ending_;
}

void BenchWorker::do_raw(const Raw& raw, Bench& bench) {
  if (raw.binary) return bench.take(parse_live_upload(raw.bytes));
  LiveMessage message = parse_live_message(raw.bytes, bench.names());
  if (auto* state = std::get_if<BenchState>(&message)) {
    newest_ = std::move(*state);
  } else if (std::holds_alternative<LiveGreeting>(message)) {
    bench.greet();
  } else if (const auto* lens = std::get_if<LensWish>(&message)) {
    bench.send_lens(*lens);
  } else if (const auto* glass = std::get_if<GlassWish>(&message)) {
    bench.send_glasses(*glass);
  } else if (const auto* focus = std::get_if<FocusWish>(&message)) {
    bench.focus(*focus);
  } else {
    bench.save(std::get<SaveWish>(message), context());
  }
}

void BenchWorker::show_newest(Bench& bench) {
  BenchQuestions ask;
  ask.newer = [this] { return something_new_.load(); };
  ask.ended = [this] { return ending_.load(); };
  ask.rests = [this](std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    return !woken_.wait_for(lock, time, [this] { return ending_ || !waiting_.empty(); });
  };
  const BenchState state = *newest_;
  bench.show(state, threads_, ask);
  newest_.reset();
}

void BenchWorker::work() {
  keep_memory();
  Bench bench(start_, [this](LiveReply reply) {
    if (!ending_) send_(std::move(reply));
  });
  while (wait_for_work()) {
    std::deque<Raw> messages;
    {
      const std::lock_guard lock(mutex_);
      messages.swap(waiting_);
      something_new_ = ending_.load();
    }
    for (const Raw& raw : messages) {
      try {
        do_raw(raw, bench);
      } catch (const Cancelled&) {
        // A file that was to be saved when something new came: it is asked for again.
        send_({refusal("the work was stopped by something newer"), {}});
      } catch (const std::exception& error) {
        if (!ending_) send_({refusal(error.what()), {}});
      }
    }
    if (!newest_ || ending_) continue;
    try {
      show_newest(bench);
    } catch (const Cancelled&) {
      // Something new came; what is unfinished is gone on with after it, or replaced by it.
    } catch (const std::exception& error) {
      newest_.reset();
      send_({refusal(error.what()), {}});
    }
  }
}

}  // namespace petzval
