// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/live/bench_json.h>
#include <petzval/live/bench_plots.h>
#include <petzval/live/stage_time.h>
#include <petzval/simulate/analysis.h>

#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>
#endif

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

namespace petzval {

using nlohmann::json;

namespace {

constexpr std::chrono::milliseconds glance{2};
/// For plots of this time or less the picture waits.
constexpr std::chrono::duration<double, std::milli> quick_time{40};

/// What the hand waits for comes first.
void step_back() {
#ifdef __linux__
  constexpr int niceness = 10;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), niceness);
#endif
}

constexpr const char *mtf_plot = "mtf", *finely_shown = "|finely";

/// What it shows, so that nothing is shown twice.
std::string key_of(const PlotWish& wish, const std::string& name) {
  return wish.finely && name == mtf_plot ? wish.key + finely_shown : wish.key;
}

AnalysisRequest plot_request(const Losses& losses, bool finely) {
  AnalysisRequest request;
  request.at.losses = losses;
  request.plots = true;
  request.polychromatic_mtf = true;
  request.mtf.frequencies_cpmm = {0, 10, 20, 40, 60, 80, 100};
  constexpr double smooth_step_cpmm = 2.5;
  if (finely) {
    const double last_cpmm = request.mtf.frequencies_cpmm.back();
    request.mtf.frequencies_cpmm.clear();
    for (int i = 0; i * smooth_step_cpmm <= last_cpmm; ++i)
      request.mtf.frequencies_cpmm.push_back(i * smooth_step_cpmm);
  }
  request.mtf.detail = PupilDetail::quick();  // closer than a plot's lines are thin
  return request;
}

std::string text_of(const json& message) {
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

BenchPlots::BenchPlots(SendReply send) : send_(std::move(send)), thread_([this] { work(); }) {}

BenchPlots::~BenchPlots() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  woken_.notify_all();
  thread_.join();
}

void BenchPlots::wish(PlotWish wish) {
  {
    const std::lock_guard lock(mutex_);
    quick_ = are_quick(wish.analyses);
    wished_ = std::move(wish);
  }
  woken_.notify_all();
}

bool BenchPlots::are_quick(const std::vector<std::string>& analyses) const {
  return std::ranges::all_of(analyses, [this](const std::string& name) {
    const auto found = took_ms_.find(name);
    return found == took_ms_.end() || found->second <= quick_time.count();
  });
}

void BenchPlots::let_quick_ones_pass(const std::function<bool()>& stop) {
  const auto end = Clock::now() + quick_time;
  std::unique_lock lock(mutex_);
  while (quick_ && (wished_ || busy_) && Clock::now() < end) {
    lock.unlock();
    if (stop()) return;
    lock.lock();
    woken_.wait_for(lock, glance, [this] { return !wished_ && !busy_; });
  }
}

bool BenchPlots::wait(const std::function<bool()>& stop) {
  std::unique_lock lock(mutex_);
  while (wished_ || busy_) {
    lock.unlock();
    if (stop()) return false;
    lock.lock();
    woken_.wait_for(lock, glance, [this] { return !wished_ && !busy_; });
  }
  return true;
}

void BenchPlots::work() {
  step_back();
  std::unique_lock lock(mutex_);
  while (true) {
    woken_.wait(lock, [this] { return ending_ || wished_; });
    if (ending_) return;
    const PlotWish wish = *std::exchange(wished_, std::nullopt);
    busy_ = true;
    lock.unlock();
    try {
      show(wish);
    } catch (const Cancelled&) {
      // Something newer is wished for, or nobody looks any more.
    }
    lock.lock();
    busy_ = false;
    woken_.notify_all();
  }
}

bool BenchPlots::gives_way(const std::string& name) {
  constexpr std::chrono::seconds moment{1};
  const auto found = shown_at_.find(name);
  const bool fresh = found != shown_at_.end() && Clock::now() - found->second < moment;
  const std::lock_guard lock(mutex_);
  return ending_ || (wished_ && fresh);
}

void BenchPlots::show(const PlotWish& wish) {
  for (const std::string& name : wish.analyses) {
    const std::string key = key_of(wish, name);
    if (shown_[name] == key || shown_[name] == wish.key + finely_shown) continue;
    if (gives_way(name)) throw Cancelled();
    const bool again = shown_[name] == wish.key;
    shown_[name].clear();
    std::string failed;
    try {
      plot(wish, name, again);
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& error) {
      failed = error.what();
    } catch (const std::bad_alloc&) {
      failed = "out of memory";
    }
    if (failed.empty())
      shown_[name] = key;
    else
      send_(
          {text_of({{"kind", "problem"}, {"id", wish.id}, {"stage", "plot:" + name}, {"text", failed}}), {}});
  }
}

void BenchPlots::plot(const PlotWish& wish, const std::string& name, bool again) {
  const StageTime time;
  Context context;
  const int all = wish.threads > 0 ? wish.threads : static_cast<int>(std::thread::hardware_concurrency());
  {
    const std::lock_guard lock(mutex_);
    context.threads = quick_ ? all : std::max(1, all / 2);
  }
  context.progress = [&](double, const std::string&) { return !gives_way(name); };
  const AnalysisResult result =
      analyse(name, wish.lens.lens, plot_request(wish.lens.losses, wish.finely), context);
  json plots = json::array();
  for (const Plot& each : result.plots) plots.push_back(plot_json(each));
  send_({text_of({{"kind", "plots"},
                  {"id", wish.id},
                  {"analysis", name},
                  {"across", result.plots_across},
                  {"title", result.plots_title},
                  {"plots", std::move(plots)}}),
         {}});
  shown_at_[name] = Clock::now();
  if (again) return;
  {
    const std::lock_guard lock(mutex_);
    took_ms_[name] = time.ms();
  }
  send_({text_of({{"kind", "stage"},
                  {"id", wish.id},
                  {"stage", "plot:" + name},
                  {"ms", time.ms()},
                  {"cpu_ms", time.cpu_ms()}}),
         {}});
}

}  // namespace petzval
