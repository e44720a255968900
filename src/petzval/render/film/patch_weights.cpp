// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/render/film/patch_weights.h>

#include <algorithm>

namespace petzval::render {

namespace {

/// From this d² on the weight is 0.
constexpr float farthest = 8;

/// (1 − d²/8)⁸, much like exp(−d²), but in a few multiplications.
float weight_at(float d2) {
  float weight = std::clamp(1 - d2 / farthest, 0.0f, 1.0f);
  weight *= weight, weight *= weight;
  return weight * weight;
}

/// Squared distances of the pixels of a window from their neighbours, 0 where one is outside.
void distances(const Likeness& likeness, const PixelWindow& window, int down, int right,
               std::vector<float>& result) {
  const Planes &guide = likeness.guide, &variance = likeness.variance, &tolerance = likeness.tolerance;
  const float k2 = likeness.strictness * likeness.strictness;
  const int left = std::max(window.left, -right), end = std::min(window.right, guide.columns - right);
  std::ranges::fill(result, 0.0f);
  if (left >= end) return;
  for (int plane = 0; plane < guide.count; ++plane)
    for (int row = std::max(window.top, -down); row < std::min(window.bottom, guide.rows - down); ++row) {
      const std::size_t here = guide.at(plane, row, left), there = guide.at(plane, row + down, left + right);
      const float *a = &guide.values[here], *b = &guide.values[there];
      const float *va = &variance.values[here], *vb = &variance.values[there];
      const float* least = &tolerance.values[here];
      float* to = &result[window.index(left, row)];
      for (int i = 0; i < end - left; ++i) {
        const float difference = a[i] - b[i];
        to[i] +=
            (difference * difference - (va[i] + std::min(va[i], vb[i]))) / (least[i] + k2 * (va[i] + vb[i]));
      }
    }
}

/// Sums over squares of pixels of a window, for those of a tile within it.
void patch_sums(const PixelWindow& window, const PixelWindow& tile, int radius,
                const std::vector<float>& values, std::vector<float>& rows, std::vector<float>& result) {
  const auto width = static_cast<std::size_t>(tile.columns());
  std::ranges::fill(rows, 0.0f);
  std::ranges::fill(result, 0.0f);
  for (int row = window.top; row < window.bottom; ++row) {
    float* to = &rows[static_cast<std::size_t>(row - window.top) * width];
    for (int by = -radius; by <= radius; ++by) {
      const int left = std::max(tile.left, window.left - by), end = std::min(tile.right, window.right - by);
      if (left >= end) continue;
      const float* from = &values[window.index(left + by, row)];
      for (int i = 0; i < end - left; ++i) to[left - tile.left + i] += from[i];
    }
  }
  for (int row = tile.top; row < tile.bottom; ++row)
    for (int from = std::max(window.top, row - radius); from < std::min(window.bottom, row + radius + 1);
         ++from)
      for (std::size_t i = 0; i < width; ++i)
        result[static_cast<std::size_t>(row - tile.top) * width + i] +=
            rows[static_cast<std::size_t>(from - window.top) * width + i];
}

}  // namespace

void for_tiles(int columns, int rows, const std::function<void(const PixelWindow&)>& body) {
  constexpr int side = 32;
  const int across = (columns + side - 1) / side, down = (rows + side - 1) / side;
  parallel_tasks(static_cast<std::size_t>(across * down), [&](std::size_t i) {
    const int left = static_cast<int>(i) % across * side, top = static_cast<int>(i) / across * side;
    body({left, top, std::min(left + side, columns), std::min(top + side, rows)});
  });
}

Planes box_mean(const Planes& planes, int radius) {
  Planes result(planes.columns, planes.rows, planes.count), across = result;
  // Sums of doubles that move along: no error grows in them that a float would show.
  const auto mean_along = [&](const std::vector<float>& from, std::vector<float>& to, std::size_t first,
                              std::size_t step, int count) {
    double sum = 0;
    const auto value = [&](int i) {
      return static_cast<double>(from[first + static_cast<std::size_t>(i) * step]);
    };
    for (int i = 0; i < std::min(radius, count); ++i) sum += value(i);
    for (int i = 0; i < count; ++i) {
      if (i + radius < count) sum += value(i + radius);
      if (i > radius) sum -= value(i - radius - 1);
      const int over = std::min(i + radius, count - 1) - std::max(i - radius, 0) + 1;
      to[first + static_cast<std::size_t>(i) * step] = static_cast<float>(std::max(0.0, sum) / over);
    }
  };
  for (int plane = 0; plane < planes.count; ++plane) {
    for (int row = 0; row < planes.rows; ++row)
      mean_along(planes.values, across.values, planes.at(plane, row, 0), 1, planes.columns);
    for (int column = 0; column < planes.columns; ++column)
      mean_along(across.values, result.values, planes.at(plane, 0, column),
                 static_cast<std::size_t>(planes.columns), planes.rows);
  }
  return result;
}

std::vector<float> patch_weights(const Likeness& likeness, const PixelWindow& tile) {
  const Planes& guide = likeness.guide;
  const int patch = likeness.patch, side = likeness.side();
  const PixelWindow window{std::max(0, tile.left - patch), std::max(0, tile.top - patch),
                           std::min(guide.columns, tile.right + patch),
                           std::min(guide.rows, tile.bottom + patch)};
  std::vector<float> weights(static_cast<std::size_t>(side * side) * tile.size(), 0.0f);
  std::vector<float> squared(window.size()), sums(tile.size()),
      rows(static_cast<std::size_t>(window.rows()) * static_cast<std::size_t>(tile.columns()));
  const float each = 1 / static_cast<float>((2 * patch + 1) * (2 * patch + 1) * guide.count);
  for (int down = -likeness.reach; down <= likeness.reach; ++down)
    for (int right = -likeness.reach; right <= likeness.reach; ++right) {
      distances(likeness, window, down, right, squared);
      patch_sums(window, tile, patch, squared, rows, sums);
      float* to = &weights[static_cast<std::size_t>((down + likeness.reach) * side + right + likeness.reach) *
                           tile.size()];
      for (int row = std::max(tile.top, -down); row < std::min(tile.bottom, guide.rows - down); ++row)
        for (int column = std::max(tile.left, -right); column < std::min(tile.right, guide.columns - right);
             ++column) {
          const std::size_t at = tile.index(column, row);
          to[at] = weight_at(sums[at] * each);
        }
    }
  float* own = &weights[static_cast<std::size_t>(side * side / 2) * tile.size()];
  std::fill_n(own, tile.size(), 1.0f);
  return weights;
}

}  // namespace petzval::render
