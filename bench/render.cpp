// SPDX-License-Identifier: BSD-3-Clause
// Camera rays a second of a whole rendering (items) through lenses and through pinholes that see the same
// picture, one thread; what a second thread saves; and what is prepared once. Compare within a run. The scene
// is data/scenes/spheres.pbrt, which pbrt-v4 renders too: 400 x 300 pixels, 64 samples a pixel, 31 bands.
// lens_over_pinhole takes both in turn, for what a machine gives changes from second to second: `ratio` is
// the median over its rounds of the time through the lens over that through the pinhole, `worst` and `best`
// the ends.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/parallel.h>
#include <petzval/base/scratch_folder.h>
#include <petzval/base/units.h>
#include <petzval/base/whole_file.h>
#include <petzval/camera/mounted_lens.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>
#include <petzval/lens/scaled_lens.h>
#include <petzval/render/camera/scene_camera.h>
#include <petzval/render/renderer.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

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

/// Lenses are brought to one focal length, so that all see the same picture.
Lens lens_of_50_mm(const char* name) {
  const Lens lens = read_lens(name).lens;
  return scaled_lens(lens, 50 / first_order(lens).efl_mm);
}

SceneCamera camera_of(Prepared& scene, const char* lens, LensCameraOptions::Sampling sampling) {
  CameraChoice choice;
  MountedLens mounted(lens_of_50_mm(lens));
  mounted.focus_at_m(1.2);
  choice.lens = mounted.lens();
  choice.columns = 400, choice.rows = 300;
  choice.options.sampling = sampling;
  return set_up_camera(scene.description, choice, scene.unsupported);
}

/// A pinhole in the middle of the lens's entrance pupil, with its field of view at the distance in focus.
SceneCamera pinhole_of(const SceneCamera& camera) {
  SceneCamera pinhole = camera;
  const Lens& lens = *camera.lens;
  const FirstOrder facts = first_order(lens);
  const double pupil_from_film_mm = facts.total_track_mm - facts.entrance_pupil.position_mm;
  const double object_mm = *lens.object_distance_mm + facts.entrance_pupil.position_mm;
  const double half_height_mm = camera.film.height_mm() / 2 / std::abs(facts.magnification);
  pinhole.lens.reset();
  pinhole.perspective.lens_radius = 0;
  pinhole.perspective.field_of_view_deg = 2 * degrees(std::atan(half_height_mm / object_mm));
  pinhole.world_from_camera =
      camera.world_from_camera * Transform::translation({0, 0, pupil_from_film_mm * 1e-3});
  return pinhole;
}

enum class Through { pinhole, lens, rear_disk };

void picture(benchmark::State& state, const char* lens, Through through, int threads = 1) {
  const ThreadLimit limit(threads);
  Prepared scene;
  const bool rear_disk = through == Through::rear_disk;
  SceneCamera set_up =
      camera_of(scene, lens,
                rear_disk ? LensCameraOptions::Sampling::rear_disk : LensCameraOptions::Sampling::exit_pupil);
  if (through == Through::pinhole) set_up = pinhole_of(set_up);
  const auto camera = set_up.make(scene.world->groups);
  RenderOptions options;
  options.samples_per_pixel = 64;
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
BENCHMARK_CAPTURE(picture, pinhole, "double-gauss", Through::pinhole)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);
BENCHMARK_CAPTURE(picture, double_gauss_dispersing, "double-gauss", Through::lens)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);
BENCHMARK_CAPTURE(picture, pinhole_of_course_lens, "dgauss-50mm", Through::pinhole)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);
BENCHMARK_CAPTURE(picture, course_lens, "dgauss-50mm", Through::lens)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);
BENCHMARK_CAPTURE(picture, course_lens_rear_disk, "dgauss-50mm", Through::rear_disk)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);
BENCHMARK_CAPTURE(picture, double_gauss_two_threads, "double-gauss", Through::lens, 2)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

void lens_over_pinhole(benchmark::State& state, const char* lens) {
  using Clock = std::chrono::steady_clock;
  const ThreadLimit one(1);
  Prepared scene;
  const SceneCamera through_lens = camera_of(scene, lens, LensCameraOptions::Sampling::exit_pupil);
  const SceneCamera through_pinhole = pinhole_of(through_lens);
  const auto lens_camera = through_lens.make(scene.world->groups);
  const auto pinhole_camera = through_pinhole.make(scene.world->groups);
  RenderOptions options;
  options.samples_per_pixel = 16;
  options.path.max_depth = 8;
  const auto seconds = [&](const SceneCamera& set_up, const FilmCamera& camera) {
    const auto start = Clock::now();
    benchmark::DoNotOptimize(
        render_picture(*scene.world, camera, set_up.world_from_camera, set_up.film, options).rays);
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  std::vector<double> ratios;
  for (auto _ : state)
    for (int round = 0; round < 9; ++round) {
      const double pinhole = seconds(through_pinhole, *pinhole_camera);
      ratios.push_back(seconds(through_lens, *lens_camera) / pinhole);
    }
  std::sort(ratios.begin(), ratios.end());
  state.counters["ratio"] = ratios[ratios.size() / 2];
  state.counters["best"] = ratios.front();
  state.counters["worst"] = ratios.back();
}
BENCHMARK_CAPTURE(lens_over_pinhole, course_lens, "dgauss-50mm")
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);
BENCHMARK_CAPTURE(lens_over_pinhole, dispersing, "double-gauss")
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

void construct_lens_camera(benchmark::State& state, const char* lens) {
  const ThreadLimit one(1);
  Prepared scene;
  const SceneCamera set_up = camera_of(scene, lens, LensCameraOptions::Sampling::exit_pupil);
  for (auto _ : state) benchmark::DoNotOptimize(set_up.make(scene.world->groups));
}
BENCHMARK_CAPTURE(construct_lens_camera, double_gauss, "dgauss-50mm")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(construct_lens_camera, dispersing, "double-gauss")->Unit(benchmark::kMillisecond);

/// A wavy sheet of two million triangles in a binary PLY file: read, and ready to be met by rays.
void load_two_million_triangles(benchmark::State& state) {
  constexpr int side = 1000;
  const ScratchFolder scratch;
  const std::filesystem::path folder = scratch.path();
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
      "property float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      (side + 1) * (side + 1), 2 * side * side);
  const auto append = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (int i = 0; i <= side; ++i)
    for (int j = 0; j <= side; ++j)
      for (const double each : {j * 1e-3, 0.05 * std::sin(0.03 * i) * std::cos(0.02 * j), i * 1e-3})
        append(static_cast<float>(each));
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      for (const int half : {0, 1}) {
        const int corner = i * (side + 1) + j;
        bytes.push_back(3);
        append(corner + 1), append(corner + (half ? side + 2 : 0)), append(corner + side + 1);
      }
  write_whole_file((folder / "sheet.ply").string(), bytes);
  for (auto _ : state) {
    Unsupported unsupported;
    const SceneDescription description =
        parse_scene_description("WorldBegin\nShape \"plymesh\" \"string filename\" \"sheet.ply\"\n",
                                (folder / "scene.pbrt").string(), unsupported);
    benchmark::DoNotOptimize(build_world(description, WavelengthGroups({550}), {}, unsupported));
  }
}
BENCHMARK(load_two_million_triangles)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);

void prepare_scene(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(Prepared());
}
BENCHMARK(prepare_scene)->Unit(benchmark::kMillisecond);

}  // namespace
