// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/render/film/denoise.h>
#include <petzval/render/film/patch_weights.h>
#include <petzval/render/film/smooth_features.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace petzval::render {

namespace {

constexpr int terms = feature_terms;

/// Of the halves' noise, over their mean light, in squares of this radius: one difference says little.
constexpr int variance_radius = 4;
/// Light below this share of the picture's mean is compared as if it were so bright.
constexpr double dark_light = 0.02;
/// Relative differences that a picture without noise keeps.
constexpr float finest_difference = 3e-4f;
/// Neighbours of less than this count as nothing.
constexpr float least_weight = 0.01f;
/// Keeps slopes finite where a feature is about the same in all neighbours: the square of a spread in the
/// same unit.
constexpr double least_spread = 1e-3;
/// Errors of pixels darker than this share of the mean are measured by that.
constexpr double dark_error = 0.1;

/// Pixels whose errors decide together what a pixel takes, beside the next ones alone.
constexpr int decision_radius = 3;

struct FilterChoice {
  int reach, patch;
  float strictness;
};
/// A narrow one for what is fine and a wide one for what is smooth.
constexpr std::array<FilterChoice, 2> filters{{{5, 1, 0.3f}, {7, 3, 0.8f}}};

/// Means over thirds of the bands.
Planes guide_of(const PictureHalves& picture, int half) {
  const int ranges = std::min(3, picture.bands);
  Planes guide(picture.columns, picture.rows, ranges);
  const std::vector<float>& light = picture.halves[static_cast<std::size_t>(half)].light;
  for (std::size_t i = 0; i < guide.size(); ++i)
    for (int range = 0; range < ranges; ++range) {
      const int from = picture.bands * range / ranges, to = picture.bands * (range + 1) / ranges;
      float sum = 0;
      for (int band = from; band < to; ++band)
        sum += light[i * static_cast<std::size_t>(picture.bands) + static_cast<std::size_t>(band)];
      guide.values[static_cast<std::size_t>(range) * guide.size() + i] = sum / static_cast<float>(to - from);
    }
  return guide;
}

/// What is known of both halves' noise.
struct Noise {
  Planes variance, tolerance;
};

/// Noise of light goes with light: its variance is a mean over the surroundings, relative to the square of
/// the light near by.
Noise noise_of_light(const Planes& a, const Planes& b) {
  Planes mean = a;
  for (std::size_t i = 0; i < mean.values.size(); ++i) mean.values[i] = (a.values[i] + b.values[i]) / 2;
  const Planes near = box_mean(mean, 1);
  Planes scale = mean, relative = mean, tolerance = mean;
  for (int plane = 0; plane < mean.count; ++plane) {
    double sum = 0;
    for (std::size_t i = 0; i < mean.size(); ++i)
      sum += static_cast<double>(mean.values[mean.at(plane, 0, 0) + i]);
    const auto least = static_cast<float>(dark_light * sum / static_cast<double>(mean.size()));
    for (std::size_t i = mean.at(plane, 0, 0); i < mean.at(plane, 0, 0) + mean.size(); ++i) {
      const float difference = a.values[i] - b.values[i];
      scale.values[i] = near.values[i] * near.values[i] + least * least + 1e-30f;
      relative.values[i] = difference * difference / 2 / scale.values[i];
      tolerance.values[i] = finest_difference * finest_difference * scale.values[i];
    }
  }
  Noise noise{box_mean(relative, variance_radius), std::move(tolerance)};
  for (std::size_t i = 0; i < scale.values.size(); ++i) noise.variance.values[i] *= scale.values[i];
  return noise;
}

/// The row of the inverse that gives a fit's value at the pixel itself: normal equations by Cholesky's
/// decomposition, the upper triangle given.
std::array<float, terms> value_at_itself(const std::array<std::array<float, terms>, terms>& sums) {
  std::array<std::array<double, terms>, terms> root{};
  for (std::size_t i = 0; i < terms; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double rest = static_cast<double>(sums[j][i]);
      if (i == j && i > 0) rest += least_spread * static_cast<double>(sums[0][0]);
      for (std::size_t k = 0; k < j; ++k) rest -= root[i][k] * root[j][k];
      root[i][j] = i == j ? std::sqrt(std::max(rest, 1e-12)) : rest / root[j][j];
    }
  std::array<double, terms> x{1};
  for (std::size_t i = 0; i < terms; ++i) {
    for (std::size_t k = 0; k < i; ++k) x[i] -= root[i][k] * x[k];
    x[i] /= root[i][i];
  }
  for (std::size_t i = terms; i-- > 0;) {
    for (std::size_t k = i + 1; k < terms; ++k) x[i] -= root[k][i] * x[k];
    x[i] /= root[i][i];
  }
  std::array<float, terms> row;
  std::ranges::transform(x, row.begin(), [](double value) { return static_cast<float>(value); });
  return row;
}

/// What a tile's light is fitted from.
struct Fit {
  const PictureHalves& picture;
  const std::vector<float>& smooth;  ///< features

  /// Light of a half, [pixel of the tile][band].
  std::vector<float> light(const PixelWindow& tile, const Likeness& likeness, std::size_t half) const {
    const std::vector<float> weights = patch_weights(likeness, tile);
    const auto bands = static_cast<std::size_t>(picture.bands);
    std::vector<float> result(tile.size() * bands, 0.0f);
    std::vector<Neighbour> near;
    for (int row = tile.top; row < tile.bottom; ++row)
      for (int column = tile.left; column < tile.right; ++column) {
        const std::size_t within = tile.index(column, row);
        gather(tile, likeness, weights, column, row, near);
        weigh(near, static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.columns) +
                        static_cast<std::size_t>(column));
        float* to = &result[within * bands];
        for (const Neighbour& each : near) {
          const float* from = &picture.halves[half].light[each.pixel * bands];
          for (std::size_t band = 0; band < bands; ++band) to[band] += each.weight * from[band];
        }
      }
    return result;
  }

 private:
  struct Neighbour {
    std::size_t pixel;
    float weight;
  };

  void gather(const PixelWindow& tile, const Likeness& likeness, const std::vector<float>& weights,
              int column, int row, std::vector<Neighbour>& near) const {
    const int reach = likeness.reach, side = likeness.side();
    near.clear();
    for (int down = -reach; down <= reach; ++down)
      for (int right = -reach; right <= reach; ++right) {
        const float weight =
            weights[static_cast<std::size_t>((down + reach) * side + right + reach) * tile.size() +
                    tile.index(column, row)];
        if (weight > least_weight)
          near.push_back({static_cast<std::size_t>(row + down) * static_cast<std::size_t>(picture.columns) +
                              static_cast<std::size_t>(column + right),
                          weight});
      }
  }

  /// Likeness becomes the weight in the fit's value; these add up to 1 and may be negative.
  void weigh(std::vector<Neighbour>& near, std::size_t pixel) const {
    const float* own = &smooth[pixel * terms];
    const auto difference = [&](const Neighbour& each) {
      std::array<float, terms> x;
      for (std::size_t i = 0; i < terms; ++i) x[i] = smooth[each.pixel * terms + i] - own[i];
      x[0] = 1;
      return x;
    };
    std::array<std::array<float, terms>, terms> sums{};
    for (const Neighbour& each : near) {
      const std::array<float, terms> x = difference(each);
      for (std::size_t i = 0; i < terms; ++i) {
        const float first = each.weight * x[i];
        // The upper triangle, in halves of a row: vectors of four.
        for (std::size_t j = i < terms / 2 ? 0 : terms / 2; j < terms; ++j) sums[i][j] += first * x[j];
      }
    }
    const std::array<float, terms> row = value_at_itself(sums);
    for (Neighbour& each : near) {
      const std::array<float, terms> x = difference(each);
      float value = 0;
      for (std::size_t i = 0; i < terms; ++i) value += row[i] * x[i];
      each.weight *= value;
    }
  }
};

/// What is tried, and how far from the truth it seems to be: candidate 0 is no filter at all.
struct Candidates {
  std::array<std::vector<float>, filters.size()> light;  ///< [pixel][band]
  Planes error;                                          ///< squared, and a constant that all have in common
};

/// \param a, b  a pixel's light in the halves as filtered; raw_a, raw_b  as they were.
float squared_error(std::span<const float> a, std::span<const float> b, std::span<const float> raw_a,
                    std::span<const float> raw_b) {
  float sum = 0;
  for (std::size_t band = 0; band < a.size(); ++band) {
    const float first = a[band] - raw_b[band], second = b[band] - raw_a[band], between = a[band] - b[band];
    // The mean of both has half the variance of one.
    sum += (first * first + second * second) / 2 - between * between / 4;
  }
  return sum / static_cast<float>(a.size());
}

Candidates candidates_of(const PictureHalves& picture) {
  const auto bands = static_cast<std::size_t>(picture.bands);
  const std::array<Planes, 2> guides{guide_of(picture, 0), guide_of(picture, 1)};
  const Noise noise = noise_of_light(guides[0], guides[1]);
  const std::vector<float> smooth = smooth_features(picture);
  const Fit fit{picture, smooth};
  Candidates all{{}, Planes(picture.columns, picture.rows, 1 + static_cast<int>(filters.size()))};
  for (std::vector<float>& light : all.light) light.resize(guides[0].size() * bands);
  for_tiles(picture.columns, picture.rows, [&](const PixelWindow& tile) {
    const auto raw = [&](std::size_t half, int column, int row) {
      return std::span(picture.halves[half].light).subspan(all.error.at(0, row, column) * bands, bands);
    };
    for (std::size_t filter = 0; filter < filters.size(); ++filter) {
      const auto [reach, patch, strictness] = filters[filter];
      std::array<std::vector<float>, 2> made;
      for (std::size_t half = 0; half < 2; ++half)
        made[half] = fit.light(
            tile, {guides[1 - half], noise.variance, noise.tolerance, reach, patch, strictness}, half);
      for (int row = tile.top; row < tile.bottom; ++row)
        for (int column = tile.left; column < tile.right; ++column) {
          const std::size_t pixel = all.error.at(0, row, column), within = tile.index(column, row) * bands;
          const auto a = std::span<const float>(made[0]).subspan(within, bands),
                     b = std::span<const float>(made[1]).subspan(within, bands);
          for (std::size_t band = 0; band < bands; ++band)
            all.light[filter][pixel * bands + band] = (a[band] + b[band]) / 2;
          const auto raw_a = raw(0, column, row), raw_b = raw(1, column, row);
          all.error.values[all.error.at(1 + static_cast<int>(filter), row, column)] =
              squared_error(a, b, raw_a, raw_b);
          all.error.values[pixel] = squared_error(raw_a, raw_b, raw_a, raw_b);
        }
    }
  });
  return all;
}

/// The share of each candidate in each pixel.
Planes shares_of(const PictureHalves& picture, const Planes& error) {
  const auto bands = static_cast<std::size_t>(picture.bands);
  Planes light(picture.columns, picture.rows, 1);
  double sum = 0;
  for (std::size_t i = 0; i < light.size(); ++i) {
    for (std::size_t band = 0; band < bands; ++band)
      light.values[i] +=
          (picture.halves[0].light[i * bands + band] + picture.halves[1].light[i * bands + band]) / 2;
    light.values[i] /= static_cast<float>(bands), sum += static_cast<double>(light.values[i]);
  }
  const auto least = static_cast<float>(dark_error * sum / static_cast<double>(light.size()));
  const Planes near = box_mean(light, 1);
  Planes relative = error, picked = error;
  for (std::size_t i = 0; i < error.values.size(); ++i) {
    const float scale = near.values[i % near.size()];
    relative.values[i] /= scale * scale + least * least + 1e-30f;
  }
  // Of the next pixels, for what is small; and of some more, lest chance decides.
  const Planes around = box_mean(relative, decision_radius);
  relative = box_mean(relative, 1);
  for (std::size_t i = 0; i < error.values.size(); ++i) relative.values[i] += around.values[i];
  std::ranges::fill(picked.values, 0.0f);
  for (std::size_t i = 0; i < light.size(); ++i) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < static_cast<std::size_t>(error.count); ++k)
      if (relative.values[k * light.size() + i] < relative.values[best * light.size() + i]) best = k;
    picked.values[best * light.size() + i] = 1;
  }
  return box_mean(picked, 1);
}

}  // namespace

std::vector<float> denoised(const PictureHalves& picture) {
  const std::size_t pixels =
      static_cast<std::size_t>(picture.columns) * static_cast<std::size_t>(picture.rows);
  const auto bands = static_cast<std::size_t>(picture.bands);
  for (const PictureHalves::Half& half : picture.halves)
    if (picture.columns < 1 || picture.rows < 1 || picture.bands < 1 || half.light.size() != pixels * bands ||
        half.features.size() != pixels * PictureHalves::feature_count)
      throw InputError("a half of a picture has another size than the picture");
  const Candidates tried = candidates_of(picture);
  const Planes shares = shares_of(picture, tried.error);
  std::vector<float> result(pixels * bands);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const std::size_t pixel = i / bands;
    float light = shares.values[pixel] * (picture.halves[0].light[i] + picture.halves[1].light[i]) / 2;
    for (std::size_t k = 0; k < filters.size(); ++k)
      light += shares.values[(k + 1) * pixels + pixel] * tried.light[k][i];
    result[i] = std::max(0.0f, light);
  }
  return result;
}

}  // namespace petzval::render
