// SPDX-License-Identifier: BSD-3-Clause
// The workloads of Maeda, Catrysse & Wandell 2005, section 3, on one thread; making the lens data table
// apart, making the kernels included. A 1.5 GHz Pentium M with MATLAB 14 took 63.6 s for the first and about
// ten minutes for the second.
#include <benchmark/benchmark.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/image_formation.h>

#include <cmath>
#include <numeric>

namespace {

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

}  // namespace
