// SPDX-License-Identifier: BSD-3-Clause
// What a second thread is worth to a rendering: short renderings with one thread and with two, in turn, the
// best of each. Beside it the same of work that shares nothing, which is what the machine gives at that hour:
// two processors may be one core's two threads, or busy with something else. The best of many short runs is
// the time that nobody disturbed, if there was such a time; the label holds the load of the machine before
// and after.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/parallel.h>
#include <petzval/lens/lens_file.h>
#include <petzval/render/camera/scene_camera.h>
#include <petzval/render/renderer.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <fstream>
#include <limits>

namespace {

using namespace petzval;
using namespace petzval::render;

/// Elapsed and processor time of one run [s].
struct Spent {
  double elapsed = std::numeric_limits<double>::max(), processor = std::numeric_limits<double>::max();
};

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class Work>
void take_best(int threads, const Work& work, Spent& best) {
  const ThreadLimit limit(threads);
  const double processor = processor_seconds();
  const auto start = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  best.elapsed = std::min(best.elapsed, elapsed.count());
  best.processor = std::min(best.processor, processor_seconds() - processor);
}

std::string load() {
  std::string one;
  std::ifstream("/proc/loadavg") >> one;
  return one;
}

template <class Work>
void in_turn(benchmark::State& state, const Work& work) {
  constexpr int rounds = 12;
  const std::string before = load();
  Spent one, two;
  for (auto _ : state)
    for (int round = 0; round < rounds; ++round) {
      take_best(1, work, one);
      take_best(2, work, two);
    }
  state.counters["one_ms"] = 1e3 * one.elapsed;
  state.counters["two_ms"] = 1e3 * two.elapsed;
  state.counters["times_as_fast"] = one.elapsed / two.elapsed;
  state.counters["processor_time"] = two.processor / one.processor;
  state.SetLabel("load " + before + " to " + load());
}

void rendering(benchmark::State& state, const char* lens) {
  Unsupported unsupported;
  const SceneDescription description =
      read_scene_description(find_data_file("scenes", ".pbrt", "spheres", "scene"), unsupported);
  std::vector<double> nm;
  for (int each = 400; each <= 700; each += 10) nm.push_back(each);
  const auto world = build_world(description, WavelengthGroups(nm), {}, unsupported);
  CameraChoice choice;
  if (lens) choice.lens = read_lens(lens).lens;
  if (lens) choice.focus_distance_m = 1.2;
  choice.columns = 160, choice.rows = 120;
  const SceneCamera set_up = set_up_camera(description, choice, unsupported);
  const auto camera = set_up.make(world->groups);
  RenderOptions options;
  options.samples_per_pixel = 64;
  options.path.max_depth = 8;
  in_turn(state, [&] {
    benchmark::DoNotOptimize(
        render_picture(*world, *camera, set_up.world_from_camera, set_up.film, options).rays);
  });
}
BENCHMARK_CAPTURE(rendering, pinhole, nullptr)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(rendering, course_lens, "dgauss-50mm")->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(rendering, dispersing, "double-gauss")->Unit(benchmark::kMillisecond)->Iterations(1);

/// As many pieces as the rendering has tiles and passes, each of registers alone.
void nothing_shared(benchmark::State& state) {
  in_turn(state, [] {
    parallel_for(320, [](std::size_t i) {
      double x = static_cast<double>(i);
      for (int k = 0; k < 400000; ++k) x = std::fma(x, 0.999, 1e-3);
      benchmark::DoNotOptimize(x);
    });
  });
}
BENCHMARK(nothing_shared)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
