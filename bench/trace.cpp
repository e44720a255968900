// SPDX-License-Identifier: BSD-3-Clause
// Rays a second through the 50 mm double Gauss (11 surfaces), and what rests on them. One core; compare
// within a run.
#include <benchmark/benchmark.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/analysis/transfer_fit.h>
#include <petzval/base/parallel.h>
#include <petzval/lens/lens_file.h>
#include <petzval/trace/exit_pupil_region.h>
#include <petzval/trace/radiance_tracer.h>

#include <hwy/highway.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "trace/plain_trace.h"

namespace {

using namespace petzval;

constexpr int side = 32;

/// All of its rays pass the 50 mm double Gauss.
RayBatch parallel_beam(double semi_mm) {
  RayBatch rays;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      rays.push_back(semi_mm * (2.0 * i / side - 1) * 0.7, semi_mm * (2.0 * j / side - 1) * 0.7, -10, 0, 0,
                     1);
  return rays;
}

/// The instruction set that a benchmark is held to, by its argument; the baseline is one ray after another.
void use_target(benchmark::State& state) {
  const std::int64_t target = state.range(0);
  hwy::SetSupportedTargetsForTest(0);
  if (!(hwy::SupportedTargets() & target)) state.SkipWithError("not on this machine");
  hwy::SetSupportedTargetsForTest(target);
  state.SetLabel(hwy::TargetName(target));
}
/// Leaves all instruction sets to whoever comes next.
struct TargetsGivenBack {
  ~TargetsGivenBack() { hwy::SetSupportedTargetsForTest(0); }
};
#define EACH_TARGET Arg(HWY_AVX3)->Arg(HWY_AVX2)->Arg(HWY_SSE4)

template <class T>
void plain_loop(benchmark::State& state) {
  const Lens lens = read_lens("dgauss-50mm").lens;
  const Tracer tracer(lens, 587.5618);
  std::vector<plain::Surface<T>> surfaces;
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
    const Tracer::PreparedSurface& from = tracer.surfaces()[i];
    surfaces.push_back({T(from.shape.curvature), T(lens.surfaces[i].thickness_mm),
                        T(from.index_before / from.index_after), T(1e6)});
  }
  const RayBatch beam = parallel_beam(10);
  std::vector<plain::Ray<T>> rays(beam.size());
  for (auto _ : state) {
    for (std::size_t i = 0; i < beam.size(); ++i) {
      rays[i] = {T(beam.x_mm[i]), T(beam.y_mm[i]), T(beam.z_mm[i]), T(beam.l[i]), T(beam.m[i]), T(beam.n[i])};
      if (!plain::trace(surfaces, rays[i])) state.SkipWithError("a ray was lost");
    }
    benchmark::DoNotOptimize(rays.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(beam.size()));
}
BENCHMARK(plain_loop<float>);
BENCHMARK(plain_loop<double>);

void batch_float(benchmark::State& state) {
  const TargetsGivenBack at_the_end;
  use_target(state);
  const Lens lens = read_lens("dgauss-50mm").lens;
  const RadianceTracer tracer(Tracer(lens, 587.5618), RadianceTracer::Direction::forward, Tracer::Clip::none);
  const RayBatch from = parallel_beam(10);
  RadianceRays beam(from.size());
  std::copy(from.x_mm.begin(), from.x_mm.end(), beam.x_mm.begin());
  std::copy(from.y_mm.begin(), from.y_mm.end(), beam.y_mm.begin());
  std::copy(from.z_mm.begin(), from.z_mm.end(), beam.z_mm.begin());
  std::fill(beam.n.begin(), beam.n.end(), 1.0f);
  RadianceRays rays = beam;
  for (auto _ : state) {
    rays = beam;
    tracer.trace(rays);
    benchmark::DoNotOptimize(rays.x_mm.data());
  }
  if (std::count(rays.passes.begin(), rays.passes.end(), 1) != std::ptrdiff_t(rays.size()))
    state.SkipWithError("a ray was lost");
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(beam.size()));
}
BENCHMARK(batch_float)->EACH_TARGET;

/// Rays from the film to the scene, through glass or through a ray transfer fitted to it, single precision,
/// all apertures.
void from_film(benchmark::State& state, const char* name, double film_mm, bool as_transfer) {
  Lens lens = read_lens(name).lens;
  if (as_transfer) {
    const TransferFit fit =
        fit_transfer(lens, {.wavelengths_nm = {550}, .tolerance_mm = 1e-3, .film_radius_mm = film_mm});
    lens = fit.lens;
    state.SetLabel(std::to_string(fit.terms) + " terms");
  }
  const Tracer tracer(lens, 550);
  const RadianceTracer radiance(tracer, RadianceTracer::Direction::backward, Tracer::Clip::apertures);
  RadianceRays beam(side * side);
  for (int i = 0; i < side; ++i)
    for (int k = 0; k < side; ++k) {
      const auto at = static_cast<std::size_t>(side * i + k);
      const auto slope = static_cast<float>(0.1 * (2.0 * k / side - 1));
      beam.x_mm[at] = static_cast<float>(0.7 * film_mm * (2.0 * i / side - 1));
      beam.z_mm[at] = static_cast<float>(tracer.image_z_mm());
      beam.m[at] = slope, beam.n[at] = -std::sqrt(1 - slope * slope);
    }
  RadianceRays rays = beam;
  for (auto _ : state) {
    rays = beam;
    radiance.trace(rays);
    benchmark::DoNotOptimize(rays.x_mm.data());
  }
  state.SetItemsProcessed(state.iterations() * side * side);
}
BENCHMARK_CAPTURE(from_film, dgauss_glass, "dgauss-50mm", 9, false);
BENCHMARK_CAPTURE(from_film, dgauss_transfer, "dgauss-50mm", 9, true);
BENCHMARK_CAPTURE(from_film, four_aspheres_glass, "m12-4.5mm", 2, false);
BENCHMARK_CAPTURE(from_film, four_aspheres_transfer, "m12-4.5mm", 2, true);

/// Double precision. \param tilted_deg  of every surface, and of a group of three besides.
void trace_double(benchmark::State& state, double tilted_deg) {
  const TargetsGivenBack at_the_end;
  use_target(state);
  Lens lens = read_lens("dgauss-50mm").lens;
  if (tilted_deg != 0) {
    for (Surface& surface : lens.surfaces) surface.pose.tilt_x_deg = tilted_deg;
    lens.groups = {{2, 4, {0.02, 0.01, 0, tilted_deg, 0, 0}, 0}};
  }
  const Tracer tracer(lens, 587.5618);
  const RayBatch beam = parallel_beam(10);
  RayBatch rays = beam;
  for (auto _ : state) {
    rays = beam;
    tracer.trace(rays, Tracer::Clip::none);
    benchmark::DoNotOptimize(rays.x_mm.data());
  }
  if (std::count(rays.status.begin(), rays.status.end(), RayStatus::ok) != std::ptrdiff_t(rays.size()))
    state.SkipWithError("a ray was lost");
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(beam.size()));
}
void batch_double(benchmark::State& state) {
  trace_double(state, 0);
}
BENCHMARK(batch_double)->EACH_TARGET;

/// Every surface tilted, three of them in a group that is tilted and decentred.
void batch_double_tilted(benchmark::State& state) {
  trace_double(state, 0.05);
}
BENCHMARK(batch_double_tilted)->EACH_TARGET;

/// The scalar trace of the library, which says why a ray fails.
void library_scalar(benchmark::State& state) {
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
BENCHMARK(library_scalar);

/// From which directions light reaches 64 film radii, one thread.
void exit_pupil_regions(benchmark::State& state) {
  const ThreadLimit one(1);
  const Lens lens = read_lens("dgauss-50mm").lens;
  const Tracer tracer(lens, 587.5618);
  for (auto _ : state) benchmark::DoNotOptimize(ExitPupilRegions(std::span(&tracer, 1), 21.6).area_sr(10, 0));
}
BENCHMARK(exit_pupil_regions)->Unit(benchmark::kMillisecond);

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

}  // namespace
