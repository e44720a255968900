// SPDX-License-Identifier: BSD-3-Clause
// Exact targets at f/8, 550 nm, 4.73 µm and a square photosite, on one thread.
#include <benchmark/benchmark.h>
#include <petzval/base/parallel.h>
#include <petzval/target/render_target.h>

#include <cmath>

namespace {

using namespace petzval;

TargetOptions frame(int size) {
  TargetOptions options;
  options.columns = options.rows = size;
  options.pitch_um = 4.73;
  return options;
}

/// `count` polygons of 4 to 7 corners on a grid over the frame.
TargetScene many_polygons(int count, int size) {
  TargetScene scene;
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  const double cell = static_cast<double>(size) / side;
  for (int i = 0; i < count; ++i)
    scene.polygons.push_back({{regular_polygon({(i % side + 0.5) * cell, (i / side + 0.5) * cell},
                                               0.42 * cell, i % 4 == 0 ? 6 : 5, 7.0 * i)},
                              0,
                              0});
  return scene;
}

void render(benchmark::State& state, const TargetScene& scene, int size) {
  const ThreadLimit one(1);
  for (auto _ : state) {
    const auto otf = radial_pupil_otf({}, 550, 8);
    benchmark::DoNotOptimize(render_target(scene, *otf, frame(size)));
  }
}

void rectangle_240(benchmark::State& state) {
  TargetScene scene;
  scene.polygons.push_back({{rectangle({120.2, 119.7}, 100, 100, 5)}, 0, 0});
  render(state, scene, 240);
}
BENCHMARK(rectangle_240)->Unit(benchmark::kMillisecond);

void polygons_400_in_640(benchmark::State& state) {
  render(state, many_polygons(400, 640), 640);
}
BENCHMARK(polygons_400_in_640)->Unit(benchmark::kMillisecond);

void polygons_10000_in_1024(benchmark::State& state) {
  render(state, many_polygons(10000, 1024), 1024);
}
BENCHMARK(polygons_10000_in_1024)->Unit(benchmark::kMillisecond);

void chart_4096(benchmark::State& state) {
  render(state, many_polygons(400, 4096), 4096);
}
BENCHMARK(chart_4096)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
