// SPDX-License-Identifier: BSD-3-Clause
// Rays a second through the 50 mm double Gauss (11 surfaces), and what rests on them. One core; compare
// within a run.
#include <benchmark/benchmark.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/base/parallel.h>
#include <petzval/lens/lens_file.h>
#include <petzval/optics/build.h>
#include <petzval/trace/surface_step.h>

#include <cmath>

namespace {

using namespace petzval;

constexpr int side = 64;

RayBatch parallel_beam(double semi_mm) {
  RayBatch rays;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      rays.push_back(semi_mm * (2.0 * i / side - 1) * 0.7, semi_mm * (2.0 * j / side - 1) * 0.7, -10, 0, 0,
                     1);
  return rays;
}

/// The baseline: one ray after the other through the same arithmetic, branches and all.
void trace_one_by_one(benchmark::State& state) {
  const Lens lens = read_lens("dgauss-50mm").lens;
  const Tracer tracer(lens, 587.5618);
  const RayBatch beam = parallel_beam(10);
  for (auto _ : state)
    for (std::size_t i = 0; i < beam.size(); ++i)
      benchmark::DoNotOptimize(
          tracer.trace(Ray{{beam.x_mm[i], beam.y_mm[i], beam.z_mm[i]}, {beam.l[i], beam.m[i], beam.n[i]}},
                       Tracer::Clip::none));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(beam.size()));
}
BENCHMARK(trace_one_by_one);

void trace_batch_double(benchmark::State& state) {
  const Lens lens = read_lens("dgauss-50mm").lens;
  const Tracer tracer(lens, 587.5618);
  const RayBatch beam = parallel_beam(10);
  RayBatch rays = beam;
  for (auto _ : state) {
    rays = beam;
    tracer.trace(rays, Tracer::Clip::none);
    benchmark::DoNotOptimize(rays.x_mm.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(beam.size()));
}
BENCHMARK(trace_batch_double);

void g_sensor(benchmark::State& state) {
  const Lens lens = read_lens("edmund-54852").lens;
  FieldTracer tracer(lens, 587.5618);
  const ChiefRay chief = *tracer.chief_ray(-100);
  for (auto _ : state) benchmark::DoNotOptimize(tracer.g_sensor_sr(chief));
}
BENCHMARK(g_sensor);

void diffraction_psf(benchmark::State& state) {
  const Lens lens = read_lens("edmund-54852").lens;
  FieldTracer tracer(lens, 587.5618);
  const ChiefRay chief = *tracer.chief_ray(-100);
  PsfOptions options;
  options.size = static_cast<int>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(point_spread(tracer, chief, options));
}
BENCHMARK(diffraction_psf)->Arg(64)->Arg(128)->Unit(benchmark::kMillisecond);

/// 21 fields × 31 wavelengths with 64 × 64 PSFs, one thread.
void lens_data_table(benchmark::State& state) {
  const ThreadLimit one(1);
  const Lens lens = read_lens("dgauss-50mm").lens;
  TableOptions options;
  for (int i = 0; i < 31; ++i) options.wavelengths_nm.push_back(400 + 10 * i);
  options.max_image_height_mm = 15;
  options.psf_size = 64;
  for (auto _ : state) benchmark::DoNotOptimize(build_lens_data_table(lens, options));
}
BENCHMARK(lens_data_table)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
