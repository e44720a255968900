// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/render/film/noise.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace petzval::render {

namespace {

constexpr int noise_tile_side = 16;
/// Tiles darker than this share of the picture's mean are measured by that.
constexpr double dark_share = 0.1;
/// Of all tiles, those that keep the noise which is stated.
constexpr double quiet_share = 0.9;

}  // namespace

double noise_of(const PixelWindow& window, std::span<const double> squared_errors,
                std::span<const double> light) {
  const double mean = std::accumulate(light.begin(), light.end(), 0.0) / static_cast<double>(light.size());
  if (!(mean > 0)) return 0;
  std::vector<double> tiles;
  for (int top = 0; top < window.rows(); top += noise_tile_side)
    for (int left = 0; left < window.columns(); left += noise_tile_side) {
      double error = 0, sum = 0, count = 0;
      for (int row = top; row < std::min(top + noise_tile_side, window.rows()); ++row)
        for (int column = left; column < std::min(left + noise_tile_side, window.columns()); ++column) {
          const auto at = static_cast<std::size_t>(row) * static_cast<std::size_t>(window.columns()) +
                          static_cast<std::size_t>(column);
          error += squared_errors[at], sum += light[at], ++count;
        }
      tiles.push_back(std::sqrt(error / count) / std::max(sum / count, dark_share * mean));
    }
  const auto at = static_cast<std::size_t>(quiet_share * static_cast<double>(tiles.size() - 1) + 0.5);
  std::nth_element(tiles.begin(), tiles.begin() + static_cast<std::ptrdiff_t>(at), tiles.end());
  return tiles[at];
}

double estimated_noise(const PixelWindow& window, std::span<const double> whole, std::span<const double> half,
                       int samples) {
  std::vector<double> squared(whole.size()), light(whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const double difference = (whole[i] - 2 * half[i]) / samples;
    squared[i] = difference * difference;
    light[i] = whole[i] / samples;
  }
  return noise_of(window, squared, light);
}

}  // namespace petzval::render
