// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/render/film/patch_weights.h>
#include <petzval/render/film/smooth_features.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace petzval::render {

namespace {

constexpr int features = PictureHalves::feature_count, terms = feature_terms;
/// Differences that count in any case, in units of their standard deviation over the picture.
constexpr float finest_feature = 1e-3f;
constexpr int reach = 4, patch = 2;
constexpr float strictness = 1;

/// One feature of a half, in units of the standard deviation that it has over the picture.
Planes feature_of(const PictureHalves& picture, int half, int feature) {
  Planes plane(picture.columns, picture.rows, 1);
  const auto all = [&](std::size_t side) {
    return std::span(picture.halves[side].features)
        .subspan(static_cast<std::size_t>(feature) * plane.size(), plane.size());
  };
  const auto count = static_cast<double>(plane.size());
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < plane.size(); ++i) {
    const double value = (static_cast<double>(all(0)[i]) + static_cast<double>(all(1)[i])) / 2;
    sum += value, squares += value * value;
  }
  const double spread = std::sqrt(std::max(0.0, squares / count - sum * sum / count / count));
  const double scale = spread > 1e-9 * std::abs(sum / count) ? 1 / spread : 0;
  for (std::size_t i = 0; i < plane.size(); ++i)
    plane.values[i] = static_cast<float>(scale * static_cast<double>(all(static_cast<std::size_t>(half))[i]));
  return plane;
}

/// Adds a share of the means of a plane over the neighbours of the pixels of a tile, by their weights.
void smooth_tile(const Planes& plane, const Likeness& likeness, const PixelWindow& tile, float share,
                 std::vector<float>& result) {
  const std::vector<float> weights = patch_weights(likeness, tile);
  std::vector<float> sums(tile.size(), 0.0f), of_weights(tile.size(), 0.0f);
  const float* weight = weights.data();
  for (int down = -reach; down <= reach; ++down)
    for (int right = -reach; right <= reach; ++right, weight += tile.size()) {
      const int left = std::max(tile.left, -right), end = std::min(tile.right, plane.columns - right);
      for (int row = std::max(tile.top, -down); left < end && row < std::min(tile.bottom, plane.rows - down);
           ++row) {
        const std::size_t within = tile.index(left, row);
        const float* from = &plane.values[plane.at(0, row + down, left + right)];
        for (std::size_t i = 0; i < static_cast<std::size_t>(end - left); ++i) {
          sums[within + i] += weight[within + i] * from[i];
          of_weights[within + i] += weight[within + i];
        }
      }
    }
  for (int row = tile.top; row < tile.bottom; ++row)
    for (int column = tile.left; column < tile.right; ++column) {
      const std::size_t within = tile.index(column, row);
      result[plane.at(0, row, column)] += share * sums[within] / of_weights[within];
    }
}

}  // namespace

std::vector<float> smooth_features(const PictureHalves& picture) {
  const std::size_t pixels =
      static_cast<std::size_t>(picture.columns) * static_cast<std::size_t>(picture.rows);
  std::vector<float> result(pixels * terms, 0.0f);
  for (std::size_t i = 0; i < pixels; ++i) result[i * terms] = 1;
  for (int feature = 0; feature < features; ++feature) {
    const std::array<Planes, 2> halves{feature_of(picture, 0, feature), feature_of(picture, 1, feature)};
    Planes squared = halves[0];
    for (std::size_t i = 0; i < pixels; ++i) {
      const float difference = halves[0].values[i] - halves[1].values[i];
      squared.values[i] = difference * difference / 2;
    }
    const Planes variance = box_mean(squared, 1);
    Planes tolerance = squared;
    std::ranges::fill(tolerance.values, finest_feature * finest_feature);
    std::vector<float> smooth(pixels, 0.0f);
    for_tiles(picture.columns, picture.rows, [&](const PixelWindow& tile) {
      for (std::size_t half = 0; half < 2; ++half)
        smooth_tile(halves[half], {halves[1 - half], variance, tolerance, reach, patch, strictness}, tile,
                    0.5f, smooth);
    });
    for (std::size_t i = 0; i < pixels; ++i)
      result[i * terms + static_cast<std::size_t>(feature) + 1] = smooth[i];
  }
  return result;
}

}  // namespace petzval::render
