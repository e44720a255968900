// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/isp/mosaic_denoise.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace petzval {

namespace {

constexpr int side = 8;  // of the squares
constexpr int stride = 2;
constexpr int band_rows = 48;    // that are aggregated at once
constexpr int least_plane = 24;  // no coarser copy is made of smaller ones
constexpr float cut = 2.7F;      // standard deviations: of noise, seven coefficients in a thousand are left

using Square = std::array<float, side * side>;

/// A plane of values with unit noise.
struct NoisyPlane {
  int columns, rows;
  std::vector<float> values;

  NoisyPlane(int width, int height)
      : columns(width),
        rows(height),
        values(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}
  float* row(int r) { return values.data() + static_cast<std::ptrdiff_t>(r) * columns; }
  const float* row(int r) const { return values.data() + static_cast<std::ptrdiff_t>(r) * columns; }
};

/// cosines[k][i]: the orthonormal DCT-II of n samples.
std::vector<float> cosines_of(int n) {
  std::vector<float> c(static_cast<std::size_t>(n * n));
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < n; ++i)
      c[static_cast<std::size_t>(k * n + i)] = static_cast<float>(
          std::sqrt((k == 0 ? 1.0 : 2.0) / n) * std::cos(std::numbers::pi * (i + 0.5) * k / n));
  return c;
}

/// Cosine transforms of squares, there and back. Cosines are even or odd about the middle, so that sums and
/// differences of opposite samples take half the products.
class SquareTransform {
 public:
  SquareTransform() {
    const std::vector<float> c = cosines_of(side);
    for (std::size_t k = 0; k < half; ++k)
      for (std::size_t i = 0; i < half; ++i) {
        even_[k * half + i] = c[2 * k * side + i];
        odd_[k * half + i] = c[(2 * k + 1) * side + i];
      }
  }
  /// Coefficients, columns and rows exchanged.
  Square forward(const Square& x) const { return columns_forward(transposed(columns_forward(x))); }
  Square back(const Square& x) const { return columns_back(transposed(columns_back(x))); }

 private:
  static constexpr std::size_t half = side / 2;

  static Square transposed(const Square& x) {
    Square result;
    for (std::size_t i = 0; i < side; ++i)
      for (std::size_t j = 0; j < side; ++j) result[j * side + i] = x[i * side + j];
    return result;
  }
  Square columns_forward(const Square& x) const {
    Square sums, result;  // sums of opposite rows, then differences
    for (std::size_t i = 0; i < half; ++i)
      for (std::size_t j = 0; j < side; ++j) {
        const float a = x[i * side + j], b = x[(side - 1 - i) * side + j];
        sums[i * side + j] = a + b;
        sums[(half + i) * side + j] = a - b;
      }
    for (std::size_t k = 0; k < half; ++k)
      for (std::size_t j = 0; j < side; ++j) {
        float even = 0, odd = 0;
        for (std::size_t i = 0; i < half; ++i) {
          even += even_[k * half + i] * sums[i * side + j];
          odd += odd_[k * half + i] * sums[(half + i) * side + j];
        }
        result[2 * k * side + j] = even;
        result[(2 * k + 1) * side + j] = odd;
      }
    return result;
  }
  Square columns_back(const Square& x) const {
    Square result;
    for (std::size_t i = 0; i < half; ++i)
      for (std::size_t j = 0; j < side; ++j) {
        float even = 0, odd = 0;
        for (std::size_t k = 0; k < half; ++k) {
          even += even_[k * half + i] * x[2 * k * side + j];
          odd += odd_[k * half + i] * x[(2 * k + 1) * side + j];
        }
        result[i * side + j] = even + odd;
        result[(side - 1 - i) * side + j] = even - odd;
      }
    return result;
  }

  std::array<float, half * half> even_{}, odd_{};
};

NoisyPlane with_margin(const NoisyPlane& plane, int margin) {
  NoisyPlane wide(plane.columns + 2 * margin, plane.rows + 2 * margin);
  for (int r = 0; r < wide.rows; ++r) {
    const float* from = plane.row(mirrored(r - margin, plane.rows));
    for (int c = 0; c < wide.columns; ++c) wide.row(r)[c] = from[mirrored(c - margin, plane.columns)];
  }
  return wide;
}

Square square_at(const NoisyPlane& plane, int r, int c) {
  Square square;
  for (int i = 0; i < side; ++i)
    std::copy_n(plane.row(r + i) + c, side, square.begin() + static_cast<std::ptrdiff_t>(i * side));
  return square;
}

/// Shrinks the coefficients of one square. \param about_zero  the mean too. \returns its weight in the mean
/// of all that overlap: what little noise is left counts more.
float cut_small(Square& coefficients, const Square&, bool about_zero) {
  int kept = 1;
  for (std::size_t i = about_zero ? 0 : 1; i < coefficients.size(); ++i) {
    const bool keep = std::abs(coefficients[i]) > cut;
    coefficients[i] = keep ? coefficients[i] : 0;
    kept += keep;
  }
  return 1 / static_cast<float>(kept);
}

float shrink_by_estimate(Square& coefficients, const Square& estimate, bool about_zero) {
  float energy = 1;
  for (std::size_t i = about_zero ? 0 : 1; i < coefficients.size(); ++i) {
    const float e = estimate[i] * estimate[i], gain = e / (e + 1);
    coefficients[i] *= gain;
    energy += gain * gain;
  }
  return 1 / energy;
}

/// One pass over all squares of a plane with a margin of `side`; the margin of the result is not filled.
/// \param estimate  of the picture without noise, for the second pass.
template <typename Shrink>
NoisyPlane pass(const NoisyPlane& noisy, const NoisyPlane* estimate, bool about_zero, const Shrink& shrink) {
  const SquareTransform transform;
  NoisyPlane result(noisy.columns, noisy.rows);
  const int inner = noisy.rows - 2 * side, bands = (inner + band_rows - 1) / band_rows;
  parallel_for(static_cast<std::size_t>(bands), [&](std::size_t band) {
    const int first = side + static_cast<int>(band) * band_rows,
              last = std::min(first + band_rows, noisy.rows - side);
    NoisyPlane sums(noisy.columns, last - first), weights(noisy.columns, last - first);
    for (int r = (first - side + stride) / stride * stride; r < last; r += stride)
      for (int c = 0; c + side <= noisy.columns; c += stride) {
        Square square = transform.forward(square_at(noisy, r, c));
        const float weight =
            shrink(square, estimate ? transform.forward(square_at(*estimate, r, c)) : square, about_zero);
        square = transform.back(square);
        for (int i = std::max(0, first - r); i < std::min(side, last - r); ++i) {
          float* const sum = sums.row(r + i - first) + c;
          float* const total = weights.row(r + i - first) + c;
          for (int j = 0; j < side; ++j) {
            sum[j] += weight * square[static_cast<std::size_t>(i * side + j)];
            total[j] += weight;
          }
        }
      }
    for (int r = first; r < last; ++r)
      for (int c = side; c < noisy.columns - side; ++c)
        result.row(r)[c] = sums.row(r - first)[c] / weights.row(r - first)[c];
  });
  return result;
}

NoisyPlane without_margin(const NoisyPlane& wide, int margin) {
  NoisyPlane plane(wide.columns - 2 * margin, wide.rows - 2 * margin);
  for (int r = 0; r < plane.rows; ++r)
    std::copy_n(wide.row(r + margin) + margin, plane.columns, plane.row(r));
  return plane;
}

/// Half the sum of each 2 × 2: a picture of half the size whose noise is unit again.
NoisyPlane halved(const NoisyPlane& plane) {
  NoisyPlane half((plane.columns + 1) / 2, (plane.rows + 1) / 2);
  for (int r = 0; r < half.rows; ++r) {
    const float *a = plane.row(2 * r), *b = plane.row(std::min(2 * r + 1, plane.rows - 1));
    for (int c = 0; c < half.columns; ++c) {
      const int next = std::min(2 * c + 1, plane.columns - 1);
      half.row(r)[c] = (a[2 * c] + a[next] + b[2 * c] + b[next]) / 2;
    }
  }
  return half;
}

/// Adds half of the values of a picture of half the size, interpolated between its pixels.
void add_doubled(NoisyPlane& plane, const NoisyPlane& half) {
  for (int r = 0; r < plane.rows; ++r) {
    const int near = r / 2, far = std::clamp(near + (r % 2 == 0 ? -1 : 1), 0, half.rows - 1);
    const float *a = half.row(near), *b = half.row(far);
    for (int c = 0; c < plane.columns; ++c) {
      const int k = c / 2, beside = std::clamp(k + (c % 2 == 0 ? -1 : 1), 0, half.columns - 1);
      plane.row(r)[c] += (9 * a[k] + 3 * a[beside] + 3 * b[k] + b[beside]) / 32;
    }
  }
}

/// \param about_zero  the plane is a difference of pixels of one channel, which has detail but no level.
NoisyPlane denoised(const NoisyPlane& plane, bool about_zero) {
  NoisyPlane wide = with_margin(plane, side);
  const NoisyPlane first =
      with_margin(without_margin(pass(wide, nullptr, about_zero, cut_small), side), side);
  NoisyPlane fine = without_margin(pass(wide, &first, about_zero, shrink_by_estimate), side);
  if (about_zero || std::min(plane.columns, plane.rows) < least_plane) return fine;
  // What is coarse is better known from the picture of half the size, for squares there are twice as large.
  NoisyPlane coarse = denoised(halved(plane), about_zero);
  const NoisyPlane found = halved(fine);
  for (std::size_t i = 0; i < coarse.values.size(); ++i) coarse.values[i] -= found.values[i];
  add_doubled(fine, coarse);
  return fine;
}

/// Values to and from unit variance; in photoelectrons, for Poisson noise.
class UnitVariance {
 public:
  UnitVariance(double scale, double offset) : gain_(scale), variance_(offset / (scale * scale)) {}
  float in(float value) const {
    const double electrons = static_cast<double>(value) / gain_;
    return static_cast<float>(2 * std::sqrt(std::max(0.0, electrons + 0.375 + variance_)));
  }
  float out(float unit) const {
    // Below the least value of the mean, at no light, the closed form turns back.
    const double least = 2 * std::sqrt(0.375 + variance_), y = std::max(static_cast<double>(unit), least);
    const double root = std::sqrt(1.5), i = 1 / y;
    const double electrons =
        y * y / 4 + root / 4 * i - 11.0 / 8 * i * i + 5.0 / 8 * root * i * i * i - 0.125 - variance_;
    return static_cast<float>(gain_ * (electrons - (y - static_cast<double>(unit)) * least / 2));
  }

 private:
  double gain_, variance_;
};

/// Orthonormal sums and differences of the places in a mosaic's period.
struct PhaseBasis {
  std::vector<float> vectors;  ///< one after the other
  std::size_t of_channels;     ///< the first ones; those behind are differences within a channel

  explicit PhaseBasis(const Mosaic& mosaic);
};

/// The sum; channels against each other, the most frequent first; then whatever cosines over the period add.
PhaseBasis::PhaseBasis(const Mosaic& mosaic) : of_channels(0) {
  const std::size_t count = mosaic.cells.size();
  const int most = *std::max_element(mosaic.cells.begin(), mosaic.cells.end());
  std::vector<std::pair<std::ptrdiff_t, int>> channels;
  for (int channel = 0; channel <= most; ++channel)
    if (const auto n = std::count(mosaic.cells.begin(), mosaic.cells.end(), channel); n > 0)
      channels.emplace_back(-n, channel);
  std::sort(channels.begin(), channels.end());
  of_channels = channels.size();

  std::vector<std::vector<double>> found;
  const auto add = [&](std::vector<double> vector) {
    for (int twice = 0; twice < 2; ++twice)
      for (const std::vector<double>& other : found) {
        const double along = std::inner_product(vector.begin(), vector.end(), other.begin(), 0.0);
        for (std::size_t i = 0; i < count; ++i) vector[i] -= along * other[i];
      }
    const double length = std::sqrt(std::inner_product(vector.begin(), vector.end(), vector.begin(), 0.0));
    constexpr double nothing_new = 1e-6;
    if (length < nothing_new) return;
    for (double& value : vector) value /= length;
    found.push_back(std::move(vector));
  };
  add(std::vector<double>(count, 1));
  for (const auto& [n, channel] : channels) {
    std::vector<double> indicator(count);
    for (std::size_t i = 0; i < count; ++i) indicator[i] = mosaic.cells[i] == channel ? 1 : 0;
    add(std::move(indicator));
  }
  const std::vector<float> down = cosines_of(mosaic.rows), across = cosines_of(mosaic.columns);
  const auto rows = static_cast<std::size_t>(mosaic.rows), columns = static_cast<std::size_t>(mosaic.columns);
  for (std::size_t k = 0; k < count; ++k) {
    std::vector<double> cosines(count);
    for (std::size_t i = 0; i < count; ++i)
      cosines[i] = static_cast<double>(down[k / columns * rows + i / columns]) *
                   static_cast<double>(across[k % columns * columns + i % columns]);
    add(std::move(cosines));
  }
  for (const std::vector<double>& vector : found) vectors.insert(vectors.end(), vector.begin(), vector.end());
}

/// The mosaic as planes, one for each place of its period, and back.
class Phases {
 public:
  /// \param top, left  rows and columns of the first period that lie outside the picture.
  Phases(const LinearMosaic& mosaic, int top, int left)
      : down_(mosaic.mosaic.rows),
        across_(mosaic.mosaic.columns),
        top_(top),
        left_(left),
        rows_((mosaic.rows + top + down_ - 1) / down_),
        columns_((mosaic.columns + left + across_ - 1) / across_) {}

  template <typename In>
  std::vector<NoisyPlane> taken_apart(const LinearMosaic& mosaic, const In& in) const {
    std::vector<NoisyPlane> planes(static_cast<std::size_t>(down_ * across_), NoisyPlane(columns_, rows_));
    parallel_for(static_cast<std::size_t>(rows_), [&](std::size_t row) {
      const int r = static_cast<int>(row);
      for (int k = 0; k < down_ * across_; ++k) {
        const int line = inside(r * down_ + k / across_ - top_, mosaic.rows, down_);
        for (int c = 0; c < columns_; ++c)
          planes[static_cast<std::size_t>(k)].row(r)[c] = in(mosaic.row(line)[static_cast<std::size_t>(
              inside(c * across_ + k % across_ - left_, mosaic.columns, across_))]);
      }
    });
    return planes;
  }

  /// Adds them to a picture of the mosaic's size.
  void add(const std::vector<NoisyPlane>& planes, NoisyPlane& picture) const {
    parallel_for(static_cast<std::size_t>(picture.rows), [&](std::size_t row) {
      const int r = static_cast<int>(row) + top_;
      for (int c = 0; c < picture.columns; ++c)
        picture.row(static_cast<int>(row))[c] +=
            planes[static_cast<std::size_t>(r % down_ * across_ + (c + left_) % across_)].row(
                r / down_)[(c + left_) / across_];
    });
  }

  /// Sums and differences of the planes in place of these, and back.
  void mix(std::vector<NoisyPlane>& planes, const PhaseBasis& basis, bool back) const {
    const std::size_t count = planes.size();
    parallel_for(static_cast<std::size_t>(rows_), [&](std::size_t row) {
      const int r = static_cast<int>(row);
      std::vector<float> old(count);
      for (int c = 0; c < columns_; ++c) {
        for (std::size_t k = 0; k < count; ++k) old[k] = planes[k].row(r)[c];
        for (std::size_t k = 0; k < count; ++k) {
          float sum = 0;
          for (std::size_t i = 0; i < count; ++i)
            sum += (back ? basis.vectors[i * count + k] : basis.vectors[k * count + i]) * old[i];
          planes[k].row(r)[c] = sum;
        }
      }
    });
  }

 private:
  /// Where the picture ends within a period, the one beside it stands in.
  static int inside(int index, int count, int period) {
    return index < 0 ? index + period : index < count ? index : index - period;
  }

  int down_, across_, top_, left_, rows_, columns_;
};

}  // namespace

void denoise_mosaic(LinearMosaic& mosaic, double strength, double noise_scale, double noise_offset) {
  if (!(strength >= 0) || std::isinf(strength))
    throw InputError(fmt::format("a denoising strength of {:g}; 0 or more would be right", strength));
  if (strength == 0) return;
  // Sums and differences of a longer period would take the time of its square.
  constexpr std::size_t longest = 64;
  if (mosaic.mosaic.cells.size() > longest)
    throw InputError(
        fmt::format("a mosaic whose period has {} pixels is not denoised; up to {} are, and "
                    "strength 0 would be right",
                    mosaic.mosaic.cells.size(), longest));
  if (!(noise_scale > 0) || mosaic.rows < mosaic.mosaic.rows || mosaic.columns < mosaic.mosaic.columns)
    return;
  const UnitVariance unit(noise_scale, noise_offset);
  // Noise that is said to be s times as strong is unit in values that are divided by s.
  const auto scale = static_cast<float>(1 / strength);
  // Neighbours across the border of two periods differ as those within one do: the mean of four divisions.
  const PhaseBasis basis(mosaic.mosaic);
  NoisyPlane sum(mosaic.columns, mosaic.rows);
  int divisions = 0;
  for (int top = 0; top < mosaic.mosaic.rows; top += std::max(1, mosaic.mosaic.rows / 2))
    for (int left = 0; left < mosaic.mosaic.columns; left += std::max(1, mosaic.mosaic.columns / 2)) {
      const Phases phases(mosaic, top, left);
      std::vector<NoisyPlane> planes =
          phases.taken_apart(mosaic, [&](float x) { return scale * unit.in(x); });
      phases.mix(planes, basis, false);
      for (std::size_t k = 0; k < planes.size(); ++k) planes[k] = denoised(planes[k], k >= basis.of_channels);
      phases.mix(planes, basis, true);
      phases.add(planes, sum);
      ++divisions;
    }
  const float share = 1 / (scale * static_cast<float>(divisions));
  parallel_for(static_cast<std::size_t>(mosaic.rows), [&](std::size_t row) {
    const std::span<float> values = mosaic.row(static_cast<int>(row));
    for (int c = 0; c < mosaic.columns; ++c)
      values[static_cast<std::size_t>(c)] = unit.out(share * sum.row(static_cast<int>(row))[c]);
  });
}

}  // namespace petzval
