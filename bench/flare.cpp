// SPDX-License-Identifier: BSD-3-Clause
// The ghosts of one sun in a frame of 1920 × 1080 pixels and three bands: all pairs of a lens of fourteen
// surfaces. Wall-clock time on as many threads as the argument says.
#include <benchmark/benchmark.h>
#include <petzval/base/parallel.h>
#include <petzval/flare/ghost_light.h>
#include <petzval/lens/lens_file.h>

namespace petzval {
namespace {

void ghosts_of_the_sun(benchmark::State& state) {
  const ThreadLimit threads(static_cast<int>(state.range(0)));
  const Lens lens = read_lens("inverse-telephoto").lens;
  BrightSource sun;
  sun.name = "sun";
  sun.right = 0.3;
  sun.up = 0.15;
  sun.radius_rad = 0.0046;
  sun.irradiance = {1, 1, 1};
  GhostLightOptions options;
  options.neglected_share = 0;
  GhostLightReport report;
  const SensorGeometry frame{1920, 1080, 1e3 * lens.total_track_mm() / 1920 / 3};
  for (auto _ : state)
    benchmark::DoNotOptimize(ghost_light(lens, frame, {450, 550, 650}, {&sun, 1}, options, {}, &report));
  state.counters["surfaces"] = static_cast<double>(lens.surfaces.size());
  state.counters["pairs"] = static_cast<double>(report.pairs.size());
}
BENCHMARK(ghosts_of_the_sun)
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();

}  // namespace
}  // namespace petzval
