// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/isp/linear_mosaic.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

namespace petzval {

namespace {

/// How many pixels of the same channel a pixel is compared with.
constexpr std::size_t neighbour_count = 8;

/// Rows and columns from a pixel to the others of its channel, the nearest first.
using Places = std::vector<std::pair<int, int>>;

/// For each cell of the mosaic; enough for eight to lie inside the image at its corners, too.
std::vector<Places> same_channel_neighbours(const Mosaic& mosaic) {
  std::vector<Places> result;
  const int reach = 2 * std::max(mosaic.rows, mosaic.columns);
  for (int r0 = 0; r0 < mosaic.rows; ++r0)
    for (int c0 = 0; c0 < mosaic.columns; ++c0) {
      Places places;
      for (int r = -reach; r <= reach; ++r)
        for (int c = -reach; c <= reach; ++c)
          if ((r != 0 || c != 0) && mosaic.channel(r0 + r + reach * mosaic.rows,
                                                   c0 + c + reach * mosaic.columns) == mosaic.channel(r0, c0))
            places.emplace_back(r, c);
      std::stable_sort(places.begin(), places.end(), [](auto a, auto b) {
        return a.first * a.first + a.second * a.second < b.first * b.first + b.second * b.second;
      });
      result.push_back(std::move(places));
    }
  return result;
}

/// Values of the nearest pixels of the same channel that there are; fewer than eight in the smallest images
/// alone.
struct Neighbours {
  std::array<float, neighbour_count> values{};
  std::size_t count = 0;
};

Neighbours neighbours_of(const std::vector<float>& values, const LinearMosaic& mosaic, int row, int column,
                         const Places& places) {
  Neighbours found;
  for (const auto& [down, right] : places) {
    const int r = row + down, c = column + right;
    if (r < 0 || c < 0 || r >= mosaic.rows || c >= mosaic.columns) continue;
    found.values[found.count++] =
        values[static_cast<std::size_t>(r) * static_cast<std::size_t>(mosaic.columns) +
               static_cast<std::size_t>(c)];
    if (found.count == neighbour_count) break;
  }
  return found;
}

/// Mean over a square of the pixels of the same channel; one plane a channel would need more memory.
std::vector<float> smoothed_row(const LinearMosaic& flat, int row, int radius) {
  std::vector<float> result(static_cast<std::size_t>(flat.columns));
  const std::size_t channels = flat.channels.size(), width = result.size();
  std::vector<double> sums(channels * width), counts(channels * width);
  for (int r = std::max(0, row - radius); r <= std::min(flat.rows - 1, row + radius); ++r)
    for (int c = 0; c < flat.columns; ++c) {
      const std::size_t at =
          static_cast<std::size_t>(flat.mosaic.channel(r, c)) * width + static_cast<std::size_t>(c);
      sums[at] += static_cast<double>(flat.row(r)[static_cast<std::size_t>(c)]);
      counts[at] += 1;
    }
  for (int c = 0; c < flat.columns; ++c) {
    const std::size_t base = static_cast<std::size_t>(flat.mosaic.channel(row, c)) * width;
    double sum = 0, count = 0;
    for (int k = std::max(0, c - radius); k <= std::min(flat.columns - 1, c + radius); ++k) {
      sum += sums[base + static_cast<std::size_t>(k)];
      count += counts[base + static_cast<std::size_t>(k)];
    }
    result[static_cast<std::size_t>(c)] = static_cast<float>(sum / count);
  }
  return result;
}

}  // namespace

LinearMosaic linearised(const RawImage& raw) {
  raw.validate();
  LinearMosaic mosaic{raw.columns, raw.rows, raw.mosaic, raw.channels,
                      std::vector<float>(raw.samples.size())};
  // One table for all: there are no more than 65,536 values.
  std::vector<float> table(65536);
  const double range = raw.white_level - raw.black_level;
  for (std::size_t stored = 0; stored < table.size(); ++stored) {
    const double linear = raw.linearization.empty()           ? static_cast<double>(stored)
                          : stored < raw.linearization.size() ? raw.linearization[stored]
                                                              : raw.linearization.back();
    table[stored] = static_cast<float>((linear - raw.black_level) / range);
  }
  const auto columns = static_cast<std::size_t>(raw.columns);
  parallel_for(static_cast<std::size_t>(raw.rows), [&](std::size_t row) {
    for (std::size_t i = row * columns; i < (row + 1) * columns; ++i)
      mosaic.values[i] = table[raw.samples[i]];
  });
  return mosaic;
}

int correct_defects(LinearMosaic& mosaic, double noise_scale, double noise_offset, double threshold) {
  const std::vector<float> before = mosaic.values;
  const auto neighbours = same_channel_neighbours(mosaic.mosaic);
  const auto columns = static_cast<std::size_t>(mosaic.columns);
  constexpr double least_outlier = 0.02;
  std::atomic<int> replaced = 0;
  parallel_for(static_cast<std::size_t>(mosaic.rows), [&](std::size_t row) {
    int here = 0;
    for (int c = 0; c < mosaic.columns; ++c) {
      const auto& places = neighbours[(row % static_cast<std::size_t>(mosaic.mosaic.rows)) *
                                          static_cast<std::size_t>(mosaic.mosaic.columns) +
                                      static_cast<std::size_t>(c % mosaic.mosaic.columns)];
      auto [around, count] = neighbours_of(before, mosaic, static_cast<int>(row), c, places);
      if (count < neighbour_count) continue;
      const auto [low, high] = std::minmax_element(around.begin(), around.end());
      const float value = before[row * columns + static_cast<std::size_t>(c)];
      const double beyond = std::max(static_cast<double>(*low - value), static_cast<double>(value - *high));
      // Where the neighbours differ much among themselves there is detail, and one more difference is no
      // defect.
      if (beyond <= least_outlier || beyond <= static_cast<double>(*high - *low)) continue;
      const double level = std::max(0.0, static_cast<double>(value < *low ? *low : *high));
      if (beyond <= threshold * std::sqrt(noise_scale * level + noise_offset)) continue;
      std::nth_element(around.begin(), around.begin() + 4, around.end());
      const float upper = around[4], lower = *std::max_element(around.begin(), around.begin() + 4);
      mosaic.values[row * columns + static_cast<std::size_t>(c)] = (upper + lower) / 2;
      ++here;
    }
    replaced += here;
  });
  return replaced;
}

void correct_shading(LinearMosaic& mosaic, const LinearMosaic& flat, int radius) {
  if (flat.columns != mosaic.columns || flat.rows != mosaic.rows || flat.mosaic != mosaic.mosaic)
    throw InputError(fmt::format(
        "the flat field has {} x {} pixels or another mosaic; {} x {} of the same sensor would be "
        "right",
        flat.columns, flat.rows, mosaic.columns, mosaic.rows));
  radius = std::max(radius, std::max(flat.mosaic.rows, flat.mosaic.columns));
  std::vector<float> smooth(flat.values.size());
  const auto columns = static_cast<std::size_t>(flat.columns);
  parallel_for(static_cast<std::size_t>(flat.rows), [&](std::size_t row) {
    const std::vector<float> line = smoothed_row(flat, static_cast<int>(row), radius);
    std::copy(line.begin(), line.end(), smooth.begin() + static_cast<std::ptrdiff_t>(row * columns));
  });
  std::vector<float> greatest(flat.channels.size());
  for (int r = 0; r < flat.rows; ++r)
    for (int c = 0; c < flat.columns; ++c) {
      const float value = smooth[static_cast<std::size_t>(r) * columns + static_cast<std::size_t>(c)];
      float& most = greatest[static_cast<std::size_t>(flat.mosaic.channel(r, c))];
      most = std::max(most, value);
      constexpr float black = 1e-4f;
      if (!(value > black))
        throw InputError(fmt::format(
            "the flat field is black in row {}, column {}; a well exposed one would be right", r, c));
    }
  for (int r = 0; r < flat.rows; ++r)
    for (int c = 0; c < flat.columns; ++c) {
      const std::size_t at = static_cast<std::size_t>(r) * columns + static_cast<std::size_t>(c);
      mosaic.values[at] *= greatest[static_cast<std::size_t>(flat.mosaic.channel(r, c))] / smooth[at];
    }
}

void balance_white(LinearMosaic& mosaic, const std::vector<double>& neutral) {
  if (neutral.size() != mosaic.channels.size())
    throw InputError(
        fmt::format("a white balance of {} numbers for {} channels", neutral.size(), mosaic.channels.size()));
  for (const double value : neutral)
    if (!(value > 0) || std::isinf(value)) throw InputError("a white balance needs positive numbers");
  const double most = *std::max_element(neutral.begin(), neutral.end());
  parallel_for(static_cast<std::size_t>(mosaic.rows), [&](std::size_t row) {
    const std::span<float> values = mosaic.row(static_cast<int>(row));
    const auto period = static_cast<std::size_t>(mosaic.mosaic.columns);
    for (std::size_t phase = 0; phase < period; ++phase) {
      const int channel = mosaic.mosaic.channel(static_cast<int>(row), static_cast<int>(phase));
      const auto factor = static_cast<float>(most / neutral[static_cast<std::size_t>(channel)]);
      for (std::size_t c = phase; c < values.size(); c += period)
        values[c] = std::min(1.0f, values[c] * factor);
    }
  });
}

std::vector<double> grey_world_neutral(const LinearMosaic& mosaic) {
  std::vector<double> sums(mosaic.channels.size()), counts(mosaic.channels.size());
  constexpr float saturated = 0.98f;
  for (int r = 0; r < mosaic.rows; ++r)
    for (int c = 0; c < mosaic.columns; ++c) {
      const float value = mosaic.row(r)[static_cast<std::size_t>(c)];
      const auto channel = static_cast<std::size_t>(mosaic.mosaic.channel(r, c));
      if (value >= saturated) continue;
      sums[channel] += static_cast<double>(value);
      counts[channel] += 1;
    }
  double most = 0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    sums[i] /= std::max(1.0, counts[i]);
    most = std::max(most, sums[i]);
  }
  for (double& sum : sums) {
    if (!(sum > 0)) throw InputError("a channel has no light; a white balance that is given would be right");
    sum /= most;
  }
  return sums;
}

}  // namespace petzval
