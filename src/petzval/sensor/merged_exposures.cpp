// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/sensor/merged_exposures.h>

#include <algorithm>
#include <cmath>

namespace petzval {

RawImage merge_bracket(const std::vector<RawImage>& frames) {
  if (frames.empty()) throw InputError("a bracket needs at least one exposure");
  const auto shortest =
      std::min_element(frames.begin(), frames.end(),
                       [](const RawImage& a, const RawImage& b) { return a.exposure_s < b.exposure_s; });
  RawImage merged = *shortest;
  for (const RawImage& frame : frames)
    if (frame.samples.size() != merged.samples.size() || frame.columns != merged.columns ||
        frame.dn_per_e != merged.dn_per_e || !(frame.exposure_s > 0))
      throw InputError(
          "the exposures of a bracket must be of one sensor at one gain, and longer than nothing");
  constexpr double trusted = 0.9;  // of saturation
  const double range = merged.white_level - merged.black_level;
  constexpr double merged_black = 256;  // keeps the noise below zero
  const double scale = (65535 - merged_black) / range;
  const double limit = merged.black_level + trusted * range;
  parallel_for(static_cast<std::size_t>(merged.rows), [&](std::size_t row) {
    for (int column = 0; column < merged.columns; ++column) {
      double sum = 0, seconds = 0;
      for (const RawImage& frame : frames) {
        const double value = frame.pixel(static_cast<int>(row), column);
        if (value > limit && &frame != &*shortest) continue;
        sum += value - frame.black_level;
        seconds += frame.exposure_s;
      }
      const double dn = sum / seconds * shortest->exposure_s;
      merged.samples[row * static_cast<std::size_t>(merged.columns) + static_cast<std::size_t>(column)] =
          static_cast<std::uint16_t>(std::clamp(std::round(merged_black + scale * dn), 0.0, 65535.0));
    }
  });
  merged.linearization.clear();
  merged.black_level = merged_black;
  merged.white_level = 65535;
  merged.dn_per_e *= scale;
  double seconds = 0;
  for (const RawImage& frame : frames) seconds += frame.exposure_s;
  // Read noise in the dark, where all frames count.
  merged.read_noise_e *= std::sqrt(static_cast<double>(frames.size())) * shortest->exposure_s / seconds;
  merged.read_noise_e = std::hypot(merged.read_noise_e, 1 / (std::sqrt(12.0) * merged.dn_per_e));
  // Shot noise of a sum over all times in the shadows, of the shortest in the highlights. Between the two a
  // line through the dark can be off by no less than this one, the root of their ratio.
  merged.shot_noise_share *= std::sqrt(shortest->exposure_s / seconds);
  return merged;
}

RawImage merge_readings(const std::vector<RawImage>& readings) {
  if (readings.empty()) throw InputError("readings to be merged must be one at least");
  const auto range_e = [](const RawImage& raw) { return (raw.white_level - raw.black_level) / raw.dn_per_e; };
  const RawImage& widest = *std::ranges::max_element(readings, {}, range_e);
  for (const RawImage& reading : readings)
    if (reading.samples.size() != widest.samples.size() || reading.columns != widest.columns ||
        reading.exposure_s != widest.exposure_s || !(reading.dn_per_e > 0 && reading.read_noise_e > 0))
      throw InputError("readings to be merged must be of one exposure, with their gain and their noise");
  constexpr double trusted = 0.9;       // of saturation
  constexpr double merged_black = 256;  // keeps the noise below zero
  RawImage merged = widest;
  merged.linearization.clear();
  merged.black_level = merged_black;
  merged.white_level = 65535;
  merged.dn_per_e = (merged.white_level - merged_black) / range_e(widest);
  parallel_for(static_cast<std::size_t>(merged.rows), [&](std::size_t row) {
    for (int column = 0; column < merged.columns; ++column) {
      double sum = 0, weights = 0;
      for (const RawImage& reading : readings) {
        const double e =
            (reading.pixel(static_cast<int>(row), column) - reading.black_level) / reading.dn_per_e;
        if (&reading != &widest && e > trusted * range_e(reading)) continue;
        const double weight = 1 / (reading.read_noise_e * reading.read_noise_e);
        sum += weight * e;
        weights += weight;
      }
      merged.samples[row * static_cast<std::size_t>(merged.columns) + static_cast<std::size_t>(column)] =
          static_cast<std::uint16_t>(
              std::clamp(std::round(merged_black + merged.dn_per_e * sum / weights), 0.0, 65535.0));
    }
  });
  double weights = 0;
  for (const RawImage& reading : readings) weights += 1 / (reading.read_noise_e * reading.read_noise_e);
  merged.read_noise_e = std::sqrt(1 / weights + 1 / (12 * merged.dn_per_e * merged.dn_per_e));
  return merged;
}

}  // namespace petzval
