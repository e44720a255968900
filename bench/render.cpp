// SPDX-License-Identifier: BSD-3-Clause
// Camera rays a second of a whole rendering (items), through a pinhole and through lenses, one thread; and
// what is prepared once. Compare within a run; the scene is data/scenes/spheres.pbrt, which pbrt-v4 renders
// too.
#include <benchmark/benchmark.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/parallel.h>
#include <petzval/lens/lens_file.h>
#include <petzval/render/camera/scene_camera.h>
#include <petzval/render/renderer.h>

namespace {

using namespace petzval;
using namespace petzval::render;

std::vector<double> bands() {
  std::vector<double> nm;
  for (int each = 400; each <= 700; each += 10) nm.push_back(each);
  return nm;
}

struct Prepared {
  Unsupported unsupported;
  SceneDescription description =
      read_scene_description(find_data_file("scenes", ".pbrt", "spheres", "scene"), unsupported);
  std::unique_ptr<const World> world = build_world(description, WavelengthGroups(bands()), {}, unsupported);
};

SceneCamera camera_of(Prepared& scene, const char* lens, LensCameraOptions::Sampling sampling) {
  CameraChoice choice;
  if (lens) {
    choice.lens = read_lens(lens).lens;
    choice.focus_distance_m = 1.2;
  }
  choice.columns = 100, choice.rows = 75;
  choice.options.sampling = sampling;
  return set_up_camera(scene.description, choice, scene.unsupported);
}

void picture(benchmark::State& state, const char* lens,
             LensCameraOptions::Sampling sampling = LensCameraOptions::Sampling::exit_pupil) {
  const ThreadLimit one(1);
  Prepared scene;
  const SceneCamera set_up = camera_of(scene, lens, sampling);
  const auto camera = set_up.make(scene.world->groups);
  RenderOptions options;
  options.samples_per_pixel = 16;
  options.path.max_depth = 8;
  std::uint64_t rays = 0, passed = 0;
  for (auto _ : state) {
    const Rendering rendering =
        render_picture(*scene.world, *camera, set_up.world_from_camera, set_up.film, options);
    rays += rendering.rays, passed += rendering.passed;
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(rays));
  state.counters["passed"] = static_cast<double>(passed) / static_cast<double>(rays);
}
BENCHMARK_CAPTURE(picture, pinhole, nullptr)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(picture, double_gauss, "dgauss-50mm")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(picture, double_gauss_dispersing, "double-gauss")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(picture, double_gauss_rear_disk, "dgauss-50mm", LensCameraOptions::Sampling::rear_disk)
    ->Unit(benchmark::kMillisecond);

void construct_lens_camera(benchmark::State& state, const char* lens) {
  const ThreadLimit one(1);
  Prepared scene;
  const SceneCamera set_up = camera_of(scene, lens, LensCameraOptions::Sampling::exit_pupil);
  for (auto _ : state) benchmark::DoNotOptimize(set_up.make(scene.world->groups));
}
BENCHMARK_CAPTURE(construct_lens_camera, double_gauss, "dgauss-50mm")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(construct_lens_camera, dispersing, "double-gauss")->Unit(benchmark::kMillisecond);

void prepare_scene(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(Prepared());
}
BENCHMARK(prepare_scene)->Unit(benchmark::kMillisecond);

}  // namespace
