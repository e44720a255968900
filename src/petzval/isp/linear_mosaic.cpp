// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/isp/linear_mosaic.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace petzval {

namespace {

/// How many pixels of the same channel a pixel is compared with.
constexpr std::size_t neighbour_count = 8;
/// Of gains among pixels, where PRNU is not known: sensors have 0.3 to 1 %.
constexpr double gain_spread = 0.01;

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

  std::pair<float, float> range() const {
    const auto [low, high] = std::minmax_element(values.begin(), values.begin() + static_cast<long>(count));
    return {*low, *high};
  }
  float median() {
    const auto begin = values.begin(), end = begin + static_cast<long>(count);
    const auto middle = begin + static_cast<long>(count / 2);
    std::nth_element(begin, middle, end);
    return count % 2 == 1 ? *middle : (*middle + *std::max_element(begin, middle)) / 2;
  }
};

/// Finds those of the pixels of a mosaic.
class SameChannel {
 public:
  explicit SameChannel(const LinearMosaic& mosaic)
      : mosaic_(mosaic), places_(same_channel_neighbours(mosaic.mosaic)) {}

  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(mosaic_.columns) +
           static_cast<std::size_t>(column);
  }
  bool is_inside(int row, int column) const {
    return row >= 0 && column >= 0 && row < mosaic_.rows && column < mosaic_.columns;
  }
  int channel(int row, int column) const { return mosaic_.mosaic.channel(row, column); }

  Neighbours of(const std::vector<float>& values, int row, int column,
                const std::set<std::size_t>* passed_over = nullptr) const {
    const int rows = mosaic_.mosaic.rows, columns = mosaic_.mosaic.columns;
    Neighbours found;
    for (const auto& [down, right] :
         places_[static_cast<std::size_t>((row % rows) * columns + column % columns)]) {
      const int r = row + down, c = column + right;
      if (!is_inside(r, c) || (passed_over && passed_over->contains(index(r, c)))) continue;
      found.values[found.count++] = values[index(r, c)];
      if (found.count == neighbour_count) break;
    }
    return found;
  }

  /// For each column of a row, whether its pixel lies outside the range of its eight neighbours by more than
  /// that range: most pixels do not, and are told apart here side by side. Pixels whose neighbours are not
  /// all where they usually are, near the borders, count as outside.
  void mark_outside(const std::vector<float>& values, int row, std::vector<unsigned char>& outside) const {
    outside.assign(static_cast<std::size_t>(mosaic_.columns), 1);
    const int period = mosaic_.mosaic.columns;
    const auto width = static_cast<std::ptrdiff_t>(mosaic_.columns);
    std::vector<unsigned char> of_phase(outside.size());
    for (int phase = 0; phase < period; ++phase) {
      const Places& places = places_[static_cast<std::size_t>((row % mosaic_.mosaic.rows) * period + phase)];
      if (places.size() < neighbour_count) continue;
      std::array<std::ptrdiff_t, neighbour_count> steps{};
      int first = 0, last = mosaic_.columns;
      bool whole = true;
      for (std::size_t i = 0; i < neighbour_count; ++i) {
        const auto [down, right] = places[i];
        whole = whole && row + down >= 0 && row + down < mosaic_.rows;
        first = std::max(first, -right);
        last = std::min(last, mosaic_.columns - right);
        steps[i] = down * width + right;
      }
      if (!whole) continue;
      const float* const line = values.data() + row * width;
      for (int c = first; c < last; ++c) {
        float low = line[c + steps[0]], high = low;
        for (std::size_t i = 1; i < neighbour_count; ++i) {
          const float other = line[c + steps[i]];
          low = other < low ? other : low;
          high = other > high ? other : high;
        }
        const float below = low - line[c], above = line[c] - high, beyond = below > above ? below : above;
        of_phase[static_cast<std::size_t>(c)] = !(beyond <= 0 || beyond <= high - low);
      }
      for (int c = phase; c < last; c += period)
        if (c >= first) outside[static_cast<std::size_t>(c)] = of_phase[static_cast<std::size_t>(c)];
    }
  }

  /// How far a pixel stands above the darkest of its neighbours (or below the brightest), as a share of that.
  double excess(const std::vector<float>& values, int row, int column, bool bright, double noise) const {
    const auto [low, high] = of(values, row, column).range();
    const double value = static_cast<double>(values[index(row, column)]);
    const double from = static_cast<double>(bright ? low : high);
    return (bright ? value - from : from - value) / (std::max(from, 0.0) + noise);
  }

 private:
  const LinearMosaic& mosaic_;
  std::vector<Places> places_;
};

/// Light that is smaller than the distance to the next pixel of the channel falls on the pixels of other
/// channels between them too.
bool is_detail(const SameChannel& same, const std::vector<float>& values, int row, int column, bool bright,
               double noise) {
  constexpr std::pair<int, int> beside[] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
  constexpr double share = 0.25;
  double sum = 0;
  int count = 0;
  for (const auto& [down, right] : beside) {
    const int r = row + down, c = column + right;
    if (!same.is_inside(r, c) || same.channel(r, c) == same.channel(row, column)) continue;
    sum += same.excess(values, r, c, bright, noise);
    ++count;
  }
  return count > 0 && sum > share * count * same.excess(values, row, column, bright, noise);
}

std::set<std::size_t> indices_of(std::span<const PixelPlace> places, const LinearMosaic& mosaic) {
  std::set<std::size_t> indices;
  for (const PixelPlace& place : places)
    indices.insert(static_cast<std::size_t>(place.row) * static_cast<std::size_t>(mosaic.columns) +
                   static_cast<std::size_t>(place.column));
  return indices;
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

/// The same near a border, which cuts the square: its mean belongs to another place, so the value here is
/// that of the plane of least squares.
float plane_at(const LinearMosaic& flat, int row, int column, int radius) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  const int channel = flat.mosaic.channel(row, column);
  for (int r = std::max(0, row - radius); r <= std::min(flat.rows - 1, row + radius); ++r)
    for (int c = std::max(0, column - radius); c <= std::min(flat.columns - 1, column + radius); ++c) {
      if (flat.mosaic.channel(r, c) != channel) continue;
      const Eigen::Vector3d x(1, r - row, c - column);
      normal += x * x.transpose();
      right += static_cast<double>(flat.row(r)[static_cast<std::size_t>(c)]) * x;
    }
  return static_cast<float>(normal.completeOrthogonalDecomposition().solve(right)(0));
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

int correct_defects(LinearMosaic& mosaic, double noise_scale, double noise_offset,
                    std::span<const PixelPlace> known, double threshold) {
  const SameChannel same(mosaic);
  const std::set<std::size_t> bad = indices_of(known, mosaic);
  for (const PixelPlace& place : known) {
    // Known bad pixels are passed over, so that none of those written here is read.
    Neighbours around = same.of(mosaic.values, place.row, place.column, &bad);
    if (around.count > 0) mosaic.values[same.index(place.row, place.column)] = around.median();
  }
  // Changes are made when all are known: the neighbours of a pixel are those that were measured.
  const std::vector<float>& before = mosaic.values;
  std::vector<std::vector<std::pair<int, float>>> changes(static_cast<std::size_t>(mosaic.rows));
  parallel_for(static_cast<std::size_t>(mosaic.rows), [&](std::size_t row) {
    const int r = static_cast<int>(row);
    std::vector<unsigned char> outside;
    same.mark_outside(before, r, outside);
    for (int c = 0; c < mosaic.columns; ++c) {
      if (!outside[static_cast<std::size_t>(c)]) continue;
      Neighbours around = same.of(before, r, c);
      if (around.count < neighbour_count) continue;
      const auto [low, high] = around.range();
      const float value = before[same.index(r, c)];
      const double beyond = std::max(static_cast<double>(low - value), static_cast<double>(value - high));
      if (beyond <= 0) continue;
      const double level = std::max(0.0, static_cast<double>(value < low ? low : high));
      const double noise = std::sqrt(noise_scale * level + noise_offset + std::pow(gain_spread * level, 2));
      // Where the neighbours differ much among themselves there is detail, and one more difference is no
      // defect.
      if (beyond <= threshold * noise || beyond <= static_cast<double>(high - low)) continue;
      if (is_detail(same, before, r, c, value > high, noise)) continue;
      changes[row].emplace_back(c, around.median());
    }
  });
  int replaced = static_cast<int>(bad.size());
  for (int r = 0; r < mosaic.rows; ++r)
    for (const auto& [column, value] : changes[static_cast<std::size_t>(r)]) {
      mosaic.values[same.index(r, column)] = value;
      ++replaced;
    }
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
    const int r = static_cast<int>(row);
    std::vector<float> line = smoothed_row(flat, r, radius);
    const bool near_border = r < radius || r >= flat.rows - radius;
    for (int c = 0; c < flat.columns; ++c)
      if (near_border || c < radius || c >= flat.columns - radius)
        line[static_cast<std::size_t>(c)] = plane_at(flat, r, c, radius);
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
