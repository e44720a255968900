// SPDX-License-Identifier: BSD-3-Clause
// 4096 x 3072 pixels: raw image from irradiance in 31 bands, development with the default demosaic.
#include <benchmark/benchmark.h>
#include <petzval/isp/develop.h>
#include <petzval/sensor/capture.h>
#include <petzval/sensor/colour_calibration.h>
#include <petzval/sensor/exposure.h>

namespace {

using namespace petzval;

Sensor big_sensor() {
  Sensor sensor = read_sensor("third-inch-1280x960");
  sensor.geometry.columns = 4096;
  sensor.geometry.rows = 3072;
  return sensor;
}

SpectralImage light(const Sensor& sensor) {
  std::vector<double> nm;
  for (int i = 0; i < 31; ++i) nm.push_back(400 + 10 * i);
  SpectralImage image(sensor.geometry.columns, sensor.geometry.rows, nm, sensor.geometry.pitch_um);
  for (int band = 0; band < image.bands(); ++band) {
    std::size_t i = 0;
    for (float& value : image.band(band))
      value = 1e-3f * static_cast<float>(1 + (i++ * 31 + static_cast<std::size_t>(band)) % 97);
  }
  return image;
}

void raw_from_31_bands(benchmark::State& state) {
  const Sensor sensor = big_sensor();
  const SpectralImage image = light(sensor);
  const double saturation = sensor.electronics->saturation_e(sensor.electronics->gain_modes[0], 1);
  for (auto _ : state) {
    const PhotoCurrent current = photo_current(image, sensor);
    benchmark::DoNotOptimize(capture(current, sensor, metered_exposure_s(current, saturation, {}), {}));
  }
}
BENCHMARK(raw_from_31_bands)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Iterations(2);

void developed(benchmark::State& state) {
  const Sensor sensor = big_sensor();
  PhotoCurrent current{4096, 3072, 0, 0, std::vector<float>(4096u * 3072u)};
  for (std::size_t i = 0; i < current.e_per_s.size(); ++i)
    current.e_per_s[i] = static_cast<float>(100 + i * 7919 % 20011);
  RawImage raw = capture(current, sensor, 1, {});
  raw.calibrations = standard_calibrations(sensor);
  raw.as_shot_neutral = {0.6, 1, 0.7};
  for (auto _ : state) benchmark::DoNotOptimize(develop_planes(raw));
}
BENCHMARK(developed)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime()->Iterations(2);

}  // namespace
