// SPDX-License-Identifier: BSD-3-Clause
// What a lens pays for its glasses: opening the catalogue, finding a glass, an index.
#include <benchmark/benchmark.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/glass/catalogue.h>

namespace {

using petzval::GlassCatalogue;

void open_catalogue(benchmark::State& state) {
  const std::string path = petzval::data_directory() + "/glass/catalogue.pgc";
  for (auto _ : state) benchmark::DoNotOptimize(GlassCatalogue::open(path));
}
BENCHMARK(open_catalogue)->Unit(benchmark::kMillisecond);

void find_full_name(benchmark::State& state) {
  const GlassCatalogue& catalogue = GlassCatalogue::bundled();
  for (auto _ : state) benchmark::DoNotOptimize(catalogue.find("SCHOTT:N-BK7"));
}
BENCHMARK(find_full_name)->Unit(benchmark::kMicrosecond);

void find_bare_name(benchmark::State& state) {
  const GlassCatalogue& catalogue = GlassCatalogue::bundled();
  for (auto _ : state) benchmark::DoNotOptimize(catalogue.find("N-BK7"));
}
BENCHMARK(find_bare_name)->Unit(benchmark::kMicrosecond);

void refuse_unknown_name(benchmark::State& state) {
  const GlassCatalogue& catalogue = GlassCatalogue::bundled();
  for (auto _ : state) try {
      benchmark::DoNotOptimize(catalogue.find("N-BK77"));
    } catch (const petzval::InputError& error) {
      benchmark::DoNotOptimize(error.what());
    }
}
BENCHMARK(refuse_unknown_name)->Unit(benchmark::kMicrosecond);

void decode_all(benchmark::State& state) {
  const GlassCatalogue& catalogue = GlassCatalogue::bundled();
  const std::vector<std::string> names = catalogue.full_names();
  for (auto _ : state)
    for (const std::string& name : names) benchmark::DoNotOptimize(catalogue.find(name));
}
BENCHMARK(decode_all)->Unit(benchmark::kMillisecond);

void index(benchmark::State& state, const char* name) {
  const petzval::Material material(GlassCatalogue::bundled().find(name));
  for (auto _ : state) benchmark::DoNotOptimize(material.index(550));
}
BENCHMARK_CAPTURE(index, sellmeier, "SCHOTT:N-BK7");
BENCHMARK_CAPTURE(index, power_series, "HOYA:BACD14");
BENCHMARK_CAPTURE(index, table, "POLYMERS:PC-ZHANG");

}  // namespace
