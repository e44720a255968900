// SPDX-License-Identifier: BSD-3-Clause
// What a second thread is worth to a rendering, beside what it is worth to work that shares nothing: two
// processors may be one core's two threads, or busy with something else, and what the machine gives changes
// from second to second. So each round takes both, with one thread and with two, one after the other, and the
// medians over the rounds are of ratios within a round.
//
//   rendering, control  time with one thread over that with two
//   of_what_there_is    rendering over control
//   tail                share of the two threads' time that one of them waits at the end of passes, for the
//   other
//                       to finish its last tile
//   alone               share of the time in which one thread merges, between passes
//   instructions        with two threads over those with one, where the machine counts them
//   faults              pages that a rendering with two threads asks the system for, by pass
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/parallel.h>
#include <petzval/camera/mounted_lens.h>
#include <petzval/lens/lens_file.h>
#include <petzval/render/camera/scene_camera.h>
#include <petzval/render/renderer.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <map>
#include <mutex>
#include <thread>

#include "instruction_counter.h"

namespace {

using namespace petzval;
using namespace petzval::render;
using Clock = std::chrono::steady_clock;

const InstructionCounter instructions;  // before any thread

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? std::nan("") : values[values.size() / 2];
}

std::string load() {
  std::string one;
  std::ifstream("/proc/loadavg") >> one;
  return one;
}

double faults() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_minflt);
}

double seconds(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

/// What one run took.
struct Run {
  double elapsed = 0, instructions = 0, faults = 0;
};

template <class Work>
Run timed(int threads, const Work& work) {
  const ThreadLimit limit(threads);
  const double before = instructions.now().value_or(0), faults_before = faults();
  const auto start = Clock::now();
  work();
  return {seconds(start, Clock::now()), instructions.now().value_or(0) - before, faults() - faults_before};
}

/// As many pieces as the rendering has tiles and passes, each of registers alone.
void share_nothing() {
  parallel_tasks(320, [](std::size_t i) {
    double x = static_cast<double>(i);
    for (int k = 0; k < 250000; ++k) x = std::fma(x, 0.999, 1e-3);
    benchmark::DoNotOptimize(x);
  });
}

/// Which thread finished a tile last in a pass, and when; asked after every tile and every pass.
class Waits {
 public:
  explicit Waits(std::size_t tiles) : tiles_(tiles) {}

  void tile_done() {
    const std::lock_guard lock(mutex_);
    last_[std::this_thread::get_id()] = end_ = Clock::now();
    ++done_;
  }
  void pass_done() {
    merging += seconds(end_, Clock::now());
    if (last_.size() == 2)
      for (const auto& [thread, at] : last_) tail += seconds(at, end_);
    complete = complete && done_ == tiles_;
    last_.clear(), done_ = 0;
    ++passes;
  }

  double tail = 0, merging = 0;
  int passes = 0;
  bool complete = true;

 private:
  std::size_t tiles_, done_ = 0;
  std::mutex mutex_;
  std::map<std::thread::id, Clock::time_point> last_;
  Clock::time_point end_{};
};

void rendering(benchmark::State& state, const char* lens) {
  Unsupported unsupported;
  const SceneDescription description =
      read_scene_description(find_data_file("scenes", ".pbrt", "spheres", "scene"), unsupported);
  std::vector<double> nm;
  for (int each = 400; each <= 700; each += 10) nm.push_back(each);
  const auto world = build_world(description, WavelengthGroups(nm), {}, unsupported);
  CameraChoice choice;
  if (lens) {
    MountedLens mounted(read_lens(lens).lens);
    mounted.focus_at_m(1.2);
    choice.lens = mounted.lens();
  }
  choice.columns = 160, choice.rows = 120;
  const SceneCamera set_up = set_up_camera(description, choice, unsupported);
  const auto camera = set_up.make(world->groups);
  RenderOptions options;
  options.samples_per_pixel = 64;
  options.path.max_depth = 8;
  const auto render = [&](Waits& waits) {
    options.after_pass = [&](int, int) { return waits.pass_done(), true; };
    benchmark::DoNotOptimize(render_picture(*world, *camera, set_up.world_from_camera, set_up.film, options,
                                            [&](double, const std::string&) { waits.tile_done(); })
                                 .rays);
  };

  constexpr int rounds = 15, tiles = 80;
  std::vector<double> gains, controls, shares, tails, alone, counted, pages;
  const std::string before = load();
  for (auto _ : state)
    for (int round = 0; round < rounds; ++round) {
      Waits one_waits(tiles), waits(tiles);
      const Run control_one = timed(1, share_nothing), control_two = timed(2, share_nothing);
      const Run one = timed(1, [&] { render(one_waits); }), two = timed(2, [&] { render(waits); });
      // The machine may have changed meanwhile: the control of a round is the mean of before and after.
      const Run last_two = timed(2, share_nothing), last_one = timed(1, share_nothing);
      gains.push_back(one.elapsed / two.elapsed);
      controls.push_back((control_one.elapsed + last_one.elapsed) / (control_two.elapsed + last_two.elapsed));
      shares.push_back(gains.back() / controls.back());
      tails.push_back(waits.tail / (2 * two.elapsed));
      alone.push_back(waits.merging / two.elapsed);
      counted.push_back(two.instructions / one.instructions);
      pages.push_back(two.faults / waits.passes);
    }
  state.counters["rendering"] = median(gains);
  state.counters["control"] = median(controls);
  state.counters["of_what_there_is"] = median(shares);
  state.counters["tail"] = median(tails);
  state.counters["alone"] = median(alone);
  state.counters["faults"] = median(pages);
  if (instructions.now()) state.counters["instructions"] = median(counted);
  state.SetLabel(fmt::format("load {} to {}, best round {:.2f} of {:.2f}{}", before, load(),
                             *std::max_element(gains.begin(), gains.end()),
                             *std::max_element(controls.begin(), controls.end()),
                             instructions.now() ? "" : ", no counter of instructions"));
}
BENCHMARK_CAPTURE(rendering, pinhole, nullptr)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(rendering, course_lens, "dgauss-50mm")->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(rendering, dispersing, "double-gauss")->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
