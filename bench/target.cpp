// SPDX-License-Identifier: BSD-3-Clause
// Exact targets at f/8, 550 nm, 4.73 µm and a square photosite, and the measurement of their edges, on one
// thread.
#include <benchmark/benchmark.h>
#include <petzval/base/parallel.h>
#include <petzval/measure/sfr/find_edges.h>
#include <petzval/measure/sfr/measure_edge.h>
#include <petzval/measure/sfr/missing_target.h>
#include <petzval/target/render_target.h>
#include <petzval/target/test_charts.h>
#include <petzval/wave/pupil_otf.h>

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

void blades_240(benchmark::State& state) {
  // The table of the pupil's OTF and a period 1000 λN wider on every side.
  const ThreadLimit one(1);
  TargetScene scene;
  scene.polygons.push_back({{rectangle({120.2, 119.7}, 100, 100, 5)}, 0, 0});
  GeneralPupil pupil;
  pupil.shape.blades = 7;
  pupil.zernike_waves = {0, 0, 0, 0.2, 0.1, 0, 0.1};
  for (auto _ : state)
    benchmark::DoNotOptimize(render_target(scene, *general_pupil_otf(pupil, 550, 8), frame(240)));
}
BENCHMARK(blades_240)->Unit(benchmark::kMillisecond)->Iterations(1);

Plane picture_of(const TargetScene& scene, int size) {
  const TargetImage image = render_target(scene, *radial_pupil_otf({}, 550, 8), frame(size));
  return {image.columns(), image.rows(), image.values()};
}

void measure_one_edge(benchmark::State& state) {
  // A region of 100 × 100 pixels.
  const ThreadLimit one(1);
  TargetScene scene;
  scene.polygons.push_back({{half_plane({50.3, 50.1}, 5)}, 0, 0});
  const Plane plane = picture_of(scene, 100);
  for (auto _ : state) benchmark::DoNotOptimize(measure_edge(samples_in(plane, {0, 0, 100, 100}), 1, {}));
}
BENCHMARK(measure_one_edge)->Unit(benchmark::kMillisecond);

void find_and_measure_36_edges(benchmark::State& state) {
  const ThreadLimit one(1);
  const Plane plane = picture_of(test_chart("slanted-edges", 640, 640), 640);
  for (auto _ : state) {
    const FoundEdges found = find_edges(plane);
    for (const FoundEdge& edge : found.edges) {
      SfrOptions options;
      options.missing_target = MissingTarget::where_sampled(edge);
      benchmark::DoNotOptimize(measure_edge(samples_about(plane, edge), 1, options));
    }
    state.counters["edges"] = static_cast<double>(found.edges.size());
  }
}
BENCHMARK(find_and_measure_36_edges)->Unit(benchmark::kMillisecond);

}  // namespace
