// SPDX-License-Identifier: BSD-3-Clause
// The workloads of Maeda, Catrysse & Wandell 2005, section 3, on one thread; making the lens data table
// apart, making the kernels included. A 1.5 GHz Pentium M with MATLAB 14 took 63.6 s for the first and about
// ten minutes for the second.
#include <benchmark/benchmark.h>
#include <malloc.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/image_formation.h>
#include <petzval/imaging/product_blur.h>
#include <petzval/lens/lens_file.h>
#include <petzval/simulate/imaging_session.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <ctime>
#include <numeric>
#include <optional>

namespace {

/// As the program has it.
void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
#endif
}

using namespace petzval;

/// Like the paper's lens at its object: 6 mm focal length, −10 % distortion at 3 mm, PSFs in frames of 32 µm.
Psf comatic_psf(double share, double nm) {
  Psf psf;
  psf.size = 128;
  psf.spacing_um = 0.25;
  std::vector<double> values;
  for (int i = 0; i < psf.size; ++i)
    for (int j = 0; j < psf.size; ++j) {
      const double s = (j - 64) * 0.25, t = (i - 64) * 0.25 - 3 * share;
      const double width = (1.2 + 2 * share + t * share / 8) * nm / 550;
      values.push_back(std::exp(-(s * s + t * t) / (2 * width * width)));
    }
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  for (const double value : values) psf.values.push_back(static_cast<float>(value / sum));
  return psf;
}

LensDataTable table_at(const std::vector<double>& wavelengths_nm) {
  LensDataTable table;
  table.wavelengths_nm = wavelengths_nm;
  for (int step = 0; step <= 20; ++step) {
    const double share = step / 20.0, field_deg = 31 * share;
    table.fields.push_back(field_deg);
    for (const double nm : wavelengths_nm) {
      const double ideal_mm = 6 * std::tan(radians(field_deg));
      table.real_image_height_mm.push_back(ideal_mm * (1 - 0.011 * ideal_mm * ideal_mm + (nm - 550) * 1e-5));
      table.g_source_sr.push_back(0.22 * (1 - 0.1 * share * share));
      table.g_sensor_sr.push_back(0.22);
      table.psf.push_back(comatic_psf(share, nm));
    }
  }
  return table;
}

Scene checkerboard(const std::vector<double>& wavelengths_nm, int columns, int rows) {
  Scene scene(columns, rows, wavelengths_nm, 60, std::nullopt);
  for (int band = 0; band < scene.bands(); ++band)
    for (int row = 0; row < scene.rows(); ++row)
      for (int column = 0; column < scene.columns(); ++column)
        scene.band(band)[static_cast<std::size_t>(row * scene.columns() + column)] =
            (row / 32 + column / 32) % 2 == 0 ? 1.0F : 0.02F;
  return scene;
}

std::vector<double> bands(int count) {
  std::vector<double> wavelengths_nm;
  for (int band = 0; band < count; ++band) wavelengths_nm.push_back(400 + 10.0 * band);
  return wavelengths_nm;
}

void run(benchmark::State& state, BlurMethod method, const std::vector<double>& wavelengths_nm,
         const SensorGeometry& sensor, int transform) {
  const ThreadLimit one_thread(1);
  const LensDataTable table = table_at(wavelengths_nm);
  const Scene scene = checkerboard(wavelengths_nm, sensor.columns, sensor.rows);
  ImagingOptions options;
  options.method = method;
  options.surround = Surround::extend;
  options.sections = {16, transform};
  ImagingReport report;
  double blur_seconds = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(form_image(scene, table, sensor, options, {}, &report));
    blur_seconds += report.blur_seconds;
  }
  state.counters["blur_ms"] = 1000 * blur_seconds / double(state.iterations());
  state.counters["transform"] = report.transform_size;
}

void checkerboard_768x576(benchmark::State& state) {
  run(state, BlurMethod::sections, {587.5618}, {768, 576, 6.25}, static_cast<int>(state.range(0)));
}
BENCHMARK(checkerboard_768x576)->Arg(64)->Arg(0)->Unit(benchmark::kMillisecond);

void scene_380x253_31_bands(benchmark::State& state) {
  run(state, BlurMethod::sections, bands(31), {380, 253, 12.5}, static_cast<int>(state.range(0)));
}
BENCHMARK(scene_380x253_31_bands)->Arg(64)->Arg(0)->Unit(benchmark::kMillisecond);

/// Not in the paper: sections that fade into each other.
void checkerboard_768x576_blended(benchmark::State& state) {
  run(state, BlurMethod::blended, {587.5618}, {768, 576, 6.25}, 0);
}
BENCHMARK(checkerboard_768x576_blended)->Unit(benchmark::kMillisecond);

/// A lens whose PSFs fill 32 (or as many as asked for) pixels: a comatic core with a wide skirt.
LensDataTable wide_table(const std::vector<double>& wavelengths_nm, double pixels, double pitch_um,
                         double half_diagonal_mm) {
  LensDataTable table;
  table.wavelengths_nm = wavelengths_nm;
  for (int step = 0; step <= 20; ++step) {
    const double share = step / 20.0;
    table.fields.push_back(31 * share);
    for (const double nm : wavelengths_nm) {
      Psf psf;
      psf.size = 4 * static_cast<int>(pixels / std::sqrt(2.0));  // its corners reach `pixels` / 2
      psf.spacing_um = pitch_um / 4;
      double sum = 0;
      for (int i = 0; i < psf.size; ++i)
        for (int j = 0; j < psf.size; ++j) {
          const double s = (j - psf.size / 2) * psf.spacing_um / pitch_um,
                       t = (i - psf.size / 2) * psf.spacing_um / pitch_um - share * share;
          const double width = (1.0 + share * share + t * share * share / 10) * nm / 550;
          const double value = std::exp(-(s * s + t * t) / (2 * width * width)) + 0.002 / (1 + s * s + t * t);
          psf.values.push_back(static_cast<float>(value));
          sum += value;
        }
      for (float& value : psf.values) value = static_cast<float>(value / sum);
      table.real_image_height_mm.push_back(half_diagonal_mm * 1.1 * share);
      table.g_source_sr.push_back(0.22);
      table.g_sensor_sr.push_back(0.22);
      table.psf.push_back(std::move(psf));
    }
  }
  return table;
}

CellPlane texture(const SensorGeometry& grid) {
  CellPlane plane(grid);
  unsigned state = 1;
  for (float& value : plane.values) {
    state = state * 1664525U + 1013904223U;
    value = float(state >> 8) / float(1 << 24);
  }
  return plane;
}

/// Filtering alone, transfer functions made: 768 × 576 pixels, PSFs of 32 pixels, at the tolerance 10^-range.
void product_768x576(benchmark::State& state) {
  const ThreadLimit one_thread(1);
  const double pitch_um = 6.25;
  const LensDataTable table = wide_table({550}, 32, pitch_um, 3);
  const PsfField psfs(table, 550, pitch_um);
  const CellPlane source = texture(grown({768, 576, pitch_um}, psfs.radius()));
  const auto plan = plan_product(psfs, source.grid, {std::pow(10.0, -double(state.range(0)))});
  if (!plan) return state.SkipWithError("no plan");
  const ProductBlur blur(psfs, source.grid, *plan);
  for (auto _ : state) benchmark::DoNotOptimize(blur.blur(source, psfs.radius()));
  state.counters["nodes"] = plan->nodes;
  state.counters["tile"] = plan->tile;
  state.counters["transform"] = plan->transform;
  state.counters["radius"] = psfs.radius();
  state.counters["model_ms"] = plan->filter_ns * 1e-6;
  state.counters["error"] = plan->estimated_error;
}
BENCHMARK(product_768x576)->Arg(2)->Arg(3)->Arg(4)->Unit(benchmark::kMillisecond);

/// The same light through plain sections of 16 pixels, each with its own transform, kernels included.
void sections_768x576(benchmark::State& state) {
  const ThreadLimit one_thread(1);
  const double pitch_um = 6.25;
  const LensDataTable table = wide_table({550}, 32, pitch_um, 3);
  const PsfField psfs(table, 550, pitch_um);
  const CellPlane source = texture(grown({768, 576, pitch_um}, psfs.radius()));
  for (auto _ : state) benchmark::DoNotOptimize(blur_sections(source, psfs, psfs.radius(), {16, 0}));
}
BENCHMARK(sections_768x576)->Unit(benchmark::kMillisecond);

/// Seconds of the processor that this process has used.
double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

/// Filtering alone of `bands` planes, at 1e-3; what making the transfer functions took stands beside it.
void filter_bands(benchmark::State& state, const SensorGeometry& frame, double psf_pixels, int bands) {
  const ThreadLimit one_thread(1);
  const double half_diagonal_mm = frame.half_diagonal_mm();
  double kernel_seconds = 0;
  for (auto _ : state) {
    double filter_seconds = 0;
    std::optional<ProductPlan> plan;
    for (int band = 0; band < bands; ++band) {
      const double nm = 400 + 10.0 * band;
      const LensDataTable table = wide_table({nm}, psf_pixels, frame.pitch_um, half_diagonal_mm);
      const PsfField psfs(table, nm, frame.pitch_um);
      const CellPlane source = texture(grown(frame, psfs.radius()));
      const double start = cpu_seconds();
      plan = plan_product(psfs, source.grid, {1e-3}, plan);
      if (!plan) return state.SkipWithError("no plan");
      const ProductBlur blur(psfs, source.grid, *plan);
      const double made = cpu_seconds();
      benchmark::DoNotOptimize(blur.blur(source, psfs.radius()));
      filter_seconds += cpu_seconds() - made;
      kernel_seconds += made - start;
    }
    state.SetIterationTime(filter_seconds);
    state.counters["nodes"] = plan->nodes;
    state.counters["tile"] = plan->tile;
    state.counters["transform"] = plan->transform;
  }
  state.counters["kernels_s"] = kernel_seconds / double(state.iterations());
}

void product_380x253_31_bands(benchmark::State& state) {
  filter_bands(state, {380, 253, 12.5}, 16, 31);
}
BENCHMARK(product_380x253_31_bands)->UseManualTime()->Unit(benchmark::kMillisecond);

/// One of 31 bands.
void product_4096x3072_band(benchmark::State& state) {
  filter_bands(state, {4096, 3072, 2}, 64, 1);
}
BENCHMARK(product_4096x3072_band)->UseManualTime()->Iterations(1)->Unit(benchmark::kMillisecond);

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Seconds that work takes with so many threads.
template <class Work>
double seconds_with(int threads, const Work& work) {
  const ThreadLimit limit(threads);
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// What a second thread is worth to a band of 4096 × 3072 cells, its kernels and its filtering, to an image
/// of four such bands, and to work of registers alone that shares nothing: time with one thread over that
/// with two, medians over rounds that take one after the other.
void two_threads(benchmark::State& state) {
  const SensorGeometry frame{4096, 3072, 2};
  const LensDataTable table = wide_table({550}, 64, frame.pitch_um, frame.half_diagonal_mm());
  const auto share_nothing = [] {
    parallel_for(64, [](std::size_t i) {
      double x = static_cast<double>(i);
      for (int k = 0; k < 1000000; ++k) x = std::fma(x, 0.999, 1e-3);
      benchmark::DoNotOptimize(x);
    });
  };
  constexpr int rounds = 9;
  const std::vector<double> four_nm = {540, 547, 553, 560};
  const LensDataTable table_of_four = wide_table({540, 560}, 64, frame.pitch_um, frame.half_diagonal_mm());
  const Scene scene = checkerboard(four_nm, 1200, 900);
  ImagingOptions options;
  options.surround = Surround::extend;
  std::vector<double> kernels, filters, images, controls;
  const auto plan = plan_product(PsfField(table, 550, frame.pitch_um), frame, {1e-3});
  if (!plan) return state.SkipWithError("no plan");
  keep_freed_memory();
  for (auto _ : state)
    for (int round = 0; round < rounds; ++round) {
      std::array<double, 3> made{}, filtered{}, imaged{}, control{};
      for (const int threads : {1, 2}) {
        const auto at = static_cast<std::size_t>(threads);
        std::optional<PsfField> psfs;
        std::optional<ProductBlur> blur;
        control[at] = seconds_with(threads, share_nothing);
        const CellPlane source = texture(frame);
        made[at] = seconds_with(threads, [&] {
          psfs.emplace(table, 550, frame.pitch_um);
          blur.emplace(*psfs, frame, *plan);
        });
        filtered[at] = seconds_with(threads, [&] {
          for (int i = 0; i < 4; ++i) benchmark::DoNotOptimize(blur->blur(source, 0));
        });
        blur.reset();
        imaged[at] = seconds_with(
            threads, [&] { benchmark::DoNotOptimize(form_image(scene, table_of_four, frame, options)); });
      }
      kernels.push_back(made[1] / made[2]);
      filters.push_back(filtered[1] / filtered[2]);
      images.push_back(imaged[1] / imaged[2]);
      controls.push_back(control[1] / control[2]);
    }
  state.counters["kernels"] = median(kernels);
  state.counters["filtering"] = median(filters);
  state.counters["image"] = median(images);
  state.counters["control"] = median(controls);
}
BENCHMARK(two_threads)->Iterations(1)->Unit(benchmark::kMillisecond);

/// What the cost model says of one layout, and what it takes: filtering, and making the kernels.
void layout(benchmark::State& state) {
  const ThreadLimit one_thread(1);
  const double pitch_um = 6.25;
  const auto transform = static_cast<int>(state.range(0)), nodes = static_cast<int>(state.range(1));
  const LensDataTable table = wide_table({550}, transform / 2.5, pitch_um, 3);
  const PsfField psfs(table, 550, pitch_um);
  const CellPlane source = texture(grown({768, 576, pitch_um}, psfs.radius()));
  const int tile = transform - 2 * psfs.radius();
  ProductOptions options;
  options.tile = tile;
  options.nodes = nodes;
  const auto plan = plan_product(psfs, source.grid, options);
  if (!plan) return state.SkipWithError("no plan");
  const auto start = std::chrono::steady_clock::now();
  const ProductBlur blur(psfs, source.grid, *plan);
  state.counters["kernels_ms"] =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  for (auto _ : state) benchmark::DoNotOptimize(blur.blur(source, psfs.radius()));
  state.counters["transform"] = plan->transform;
  state.counters["tile"] = tile;
  state.counters["model_ms"] = plan->filter_ns * 1e-6;
  state.counters["kernels_model_ms"] = plan->kernels_ns * 1e-6;
}
BENCHMARK(layout)->ArgsProduct({{32, 64, 128, 256}, {2, 3, 4}})->Unit(benchmark::kMillisecond);

/// PSFs of few pixels at 1e-3: gathered (1) or by transforms (0), filtering alone, and what the model says.
void small_psfs_768x576(benchmark::State& state) {
  const ThreadLimit one_thread(1);
  const double pitch_um = 6.25;
  const LensDataTable table = wide_table({550}, double(state.range(0)), pitch_um, 3);
  const PsfField psfs(table, 550, pitch_um);
  const CellPlane source = texture(grown({768, 576, pitch_um}, psfs.radius()));
  ProductOptions options;
  options.direct = state.range(1) != 0;
  const auto plan = plan_product(psfs, source.grid, options);
  if (!plan) return state.SkipWithError("no plan");
  const double start = cpu_seconds();
  const ProductBlur blur(psfs, source.grid, *plan);
  state.counters["kernels_ms"] = 1e3 * (cpu_seconds() - start);
  for (auto _ : state) benchmark::DoNotOptimize(blur.blur(source, psfs.radius()));
  state.counters["radius"] = psfs.radius();
  state.counters["nodes"] = plan->nodes;
  state.counters["tile"] = plan->tile;
  state.counters["transform"] = plan->transform;
  state.counters["model_ms"] = plan->filter_ns * 1e-6;
  state.counters["kernels_model_ms"] = plan->kernels_ns * 1e-6;
}
BENCHMARK(small_psfs_768x576)->ArgsProduct({{2, 4, 8, 12, 16, 24}, {0, 1}})->Unit(benchmark::kMillisecond);

/// From an altered prescription to the light of 640 × 480 pixels in 3 bands, or in as many as asked for, at
/// the tolerance 10^-range: each time another air gap, on two threads, in one session. `kernels_ms` is
/// planning and kernels; what the parts leave is focus and lens data table. `samples` across the scene, as a
/// photograph has them; 0: figures, whose edges need more cells.
void altered_lens(benchmark::State& state, const char* name, std::size_t gap, double pitch_um,
                  int samples = 0) {
  const ThreadLimit two_threads(2);
  keep_freed_memory();
  Camera camera;
  camera.lens = read_lens(name).lens;
  camera.sensor = Sensor{.geometry = {640, 480, pitch_um}};
  SceneRequest request{.name = "studio"};
  request.options.wavelengths_nm = {460, 540, 610};
  if (state.range(1) != 3) request.options.wavelengths_nm = bands(static_cast<int>(state.range(1)));
  if (samples != 0) request.options.columns = samples, request.options.rows = samples * 3 / 4;
  ImageOptions options;
  options.imaging.product.tolerance = std::pow(10.0, -double(state.range(0)));
  ImagingSession session(request, options);
  ImageReport report;
  benchmark::DoNotOptimize(session.image(camera, {}, &report));
  const double start = cpu_seconds();
  double kernel_seconds = 0, distortion_seconds = 0, blur_seconds = 0;
  for (auto _ : state) {
    camera.lens.surfaces[gap].thickness_mm *= 1.0001;
    benchmark::DoNotOptimize(session.image(camera, {}, &report));
    kernel_seconds += report.imaging.kernel_seconds;
    distortion_seconds += report.imaging.distortion_seconds;
    blur_seconds += report.imaging.blur_seconds;
  }
  const double per_image = 1e3 / double(state.iterations());
  state.counters["cpu_ms"] = (cpu_seconds() - start) * per_image;
  state.counters["light_ms"] = distortion_seconds * per_image;
  state.counters["kernels_ms"] = kernel_seconds * per_image;
  state.counters["filter_ms"] = (blur_seconds - kernel_seconds) * per_image;
  state.counters["error"] = report.imaging.estimated_error();
  state.SetLabel(report.method);
}
void altered_lens_dgauss_50mm(benchmark::State& state) {
  altered_lens(state, "dgauss-50mm", 4, 54);
}
void altered_lens_dgauss_50mm_of_samples(benchmark::State& state) {
  altered_lens(state, "dgauss-50mm", 4, 54, 768);
}
void altered_lens_edmund_54852(benchmark::State& state) {
  altered_lens(state, "edmund-54852", 1, 7.5);
}
void altered_lens_edmund_54852_of_samples(benchmark::State& state) {
  altered_lens(state, "edmund-54852", 1, 7.5, 768);
}
void altered_lens_wide_22mm(benchmark::State& state) {
  altered_lens(state, "wide-22mm", 4, 54);
}
BENCHMARK(altered_lens_dgauss_50mm)
    ->ArgsProduct({{2, 3}, {3}})
    ->Args({2, 31})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(altered_lens_dgauss_50mm_of_samples)
    ->ArgsProduct({{2, 3}, {3, 31}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(altered_lens_edmund_54852)
    ->ArgsProduct({{2, 3}, {3}})
    ->Args({2, 31})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(altered_lens_edmund_54852_of_samples)
    ->ArgsProduct({{2, 3}, {3, 31}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(altered_lens_wide_22mm)->ArgsProduct({{2, 3}, {3}})->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
