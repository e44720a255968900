// SPDX-License-Identifier: BSD-3-Clause
// The lens data table and what it is made of, one thread, CPU time.
#include <benchmark/benchmark.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/analysis/pupil_fit.h>
#include <petzval/base/parallel.h>
#include <petzval/lens/lens_file.h>
#include <petzval/optics/build.h>

namespace petzval {
namespace {

struct Field {
  Lens lens;
  FieldTracer tracer;
  ChiefRay chief;

  explicit Field(const char* name, double object_field)
      : lens(read_lens(name).lens), tracer(lens, 550), chief(*tracer.chief_ray(object_field)) {}
};

/// A full table: 21 fields × 31 wavelengths with 64 × 64 cells that hold 99 % of the light each, over a
/// sensor of 30 mm diagonal (argument 0) or of 40 mm. Huygens sums of the same number take an open Python
/// tool 95 minutes.
void full_table(benchmark::State& state) {
  const ThreadLimit one(1);
  const Lens lens = read_lens("dgauss-50mm").lens;
  TableOptions options;
  for (int i = 0; i < 31; ++i) options.wavelengths_nm.push_back(400 + 10 * i);
  options.max_image_height_mm = state.range(0) == 0 ? 15 : 20;
  options.psf_size = 64;
  options.field_count = 21;
  for (auto _ : state) benchmark::DoNotOptimize(build_lens_data_table(lens, options));
}
BENCHMARK(full_table)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->Iterations(1);

void pupil_of_a_field(benchmark::State& state) {
  const Field field("dgauss-50mm", 14);
  for (auto _ : state) benchmark::DoNotOptimize(fit_pupil(field.tracer, field.chief));
}
BENCHMARK(pupil_of_a_field)->Unit(benchmark::kMillisecond);

/// The sum alone, over chords and over nodes in any order, in the same window of n × n samples at 0.45 λN.
template <class Sum>
void sum_in_window(benchmark::State& state, const Sum& sum) {
  const Field field("edmund-54852", -100);
  PsfOptions options;
  options.size = static_cast<int>(state.range(0));
  options.spacing_um = plan_psf(field.tracer, field.chief)->spacing_um;
  sum(state, field, *plan_psf(field.tracer, field.chief, options));
}

void psf_by_chords(benchmark::State& state) {
  sum_in_window(state, [](benchmark::State& run, const Field& field, const PsfPlan& plan) {
    const SmoothPupil pupil = *fit_pupil(field.tracer, field.chief);
    for (auto _ : run) benchmark::DoNotOptimize(sum_chords(pupil, plan.grid()));
  });
}
BENCHMARK(psf_by_chords)->Arg(64)->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond);

void psf_by_nodes(benchmark::State& state) {
  sum_in_window(state, [](benchmark::State& run, const Field& field, const PsfPlan& plan) {
    const PupilWaves waves = *pupil_waves(field.tracer, field.chief, plan.radial_nodes, plan.azimuths);
    for (auto _ : run) benchmark::DoNotOptimize(sum_plane_waves(waves, plan.size, plan.spacing_um));
  });
}
BENCHMARK(psf_by_nodes)->Arg(64)->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond);

/// A disc of 0.7 mm: the lens focused at infinity, the object at 2 m. 0: rays; 1: waves.
void defocused_psf(benchmark::State& state) {
  Lens lens = read_lens("dgauss-50mm").lens;
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, stop_radius_mm(lens)};
  lens.object_distance_mm = 2000;
  FieldTracer tracer(lens, 550);
  const SmoothPupil pupil = *fit_pupil(tracer, *tracer.chief_ray(0));
  PsfOptions options;
  if (state.range(0) == 1) options.widest_wave_window_lambda_n = 2000;
  for (auto _ : state) benchmark::DoNotOptimize(point_spread(pupil, options));
}
BENCHMARK(defocused_psf)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace petzval
