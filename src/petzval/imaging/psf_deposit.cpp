// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/psf_deposit.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace petzval {

namespace {

using Vector = std::array<double, 2>;  ///< picture column, row [cells]

/// The cells of a kernel with one more all around, so that a square on the rim needs no test.
struct Canvas {
  int width;
  std::vector<double> sums;
  explicit Canvas(int radius) : width(2 * radius + 3), sums(static_cast<std::size_t>(width * width)) {}
};

/// One coordinate of a square of side `box` ≤ 1 that moves in even steps across cells of side 1.
struct Walker {
  double step, inverse_step, box, inverse_box;

  Walker(double step_length, double box_side)
      : step(step_length),
        inverse_step(step_length == 0 ? 0 : 1 / step_length),
        box(box_side),
        inverse_box(1 / box_side) {}

  /// The share of the square at [at, at + box] that lies beyond `cell`, in which it begins.
  double beyond(double at, int cell) const { return std::max(0.0, (at + box - (cell + 1)) * inverse_box); }
  /// How many more steps a square that lies within `cell` stays within it.
  double steps_inside(double at, int cell) const {
    constexpr double endless = 1e9;
    if (step > 0) return (cell + 1 - box - at) * inverse_step;
    return step < 0 ? (cell - at) * inverse_step : endless;
  }
};

/// Adds all samples as squares of side `box`; the lower corner of sample [i][j]'s lies at first + i·per_row +
/// j·per_column. Runs of samples that lie within one cell are added at once.
void add_squares(const RunningPsf& psf, double share, double box, const Vector& first, const Vector& per_row,
                 const Vector& per_column, Canvas& canvas) {
  const Walker across(per_column[0], box), down(per_column[1], box);
  const auto size = static_cast<std::size_t>(psf.size());
  const auto light = [&](std::size_t row, std::size_t from, std::size_t to) {
    return share * psf.run(row, from, to);
  };
  const double end = canvas.width - 1;  // a square that begins before it may reach one cell on
  for (std::size_t i = 0; i < size; ++i) {
    const double u_first = first[0] + double(i) * per_row[0], v_first = first[1] + double(i) * per_row[1];
    for (std::size_t j = 0; j < size;) {
      const double u = u_first + double(j) * across.step, v = v_first + double(j) * down.step;
      if (!(u >= 0 && v >= 0 && u < end && v < end)) {
        ++j;
        continue;
      }
      const int column = static_cast<int>(u), row = static_cast<int>(v);
      const double right = across.beyond(u, column), below = down.beyond(v, row);
      double* sum = canvas.sums.data() + static_cast<std::ptrdiff_t>(row) * canvas.width + column;
      if (right == 0 && below == 0) {
        const double steps = std::min(across.steps_inside(u, column), down.steps_inside(v, row));
        const std::size_t next = std::min(size, j + 1 + static_cast<std::size_t>(std::max(0.0, steps)));
        sum[0] += light(i, j, next);
        j = next;
        continue;
      }
      const double value = light(i, j, j + 1), lower = value * below, upper = value - lower;
      sum[0] += upper * (1 - right);
      sum[1] += upper * right;
      sum[canvas.width] += lower * (1 - right);
      sum[canvas.width + 1] += lower * right;
      ++j;
    }
  }
}

/// What every weight of a kernel keeps and hands to the cells about it.
struct Shares {
  double mean_u, mean_v, uu, uv, vv;

  double at(int row, int column) const {
    const double diagonal = std::abs(uv);
    if (row != 0 && column != 0) return (row == column) == (uv > 0) ? diagonal / 2 : 0;
    if (column != 0) return (uu - diagonal + column * mean_u) / 2;
    if (row != 0) return (vv - diagonal + row * mean_v) / 2;
    return 1 - uu - vv + diagonal;
  }
};

/// Handing on shares of mean d and second moments q adds d to the mean m, and 2md + q to the second moments.
Shares shares_towards(const Moments& own, const Moments& wanted) {
  Shares shares{};
  shares.mean_u = wanted.mean[0] - own.mean[0];
  shares.mean_v = wanted.mean[1] - own.mean[1];
  shares.uv = wanted.uv - own.uv - own.mean[0] * shares.mean_v - own.mean[1] * shares.mean_u;
  const double uu = wanted.uu - own.uu - 2 * own.mean[0] * shares.mean_u;
  const double vv = wanted.vv - own.vv - 2 * own.mean[1] * shares.mean_v;
  const double shift = std::abs(shares.mean_u) + std::abs(shares.mean_v);
  const double most_uv = std::max(0.0, 1 - shift);  // more than all cannot be handed on
  shares.uv = std::clamp(shares.uv, -most_uv, most_uv);
  const double least_uu = std::abs(shares.uv) + std::abs(shares.mean_u);
  const double least_vv = std::abs(shares.uv) + std::abs(shares.mean_v);
  const double more_u = std::max(0.0, uu - least_uu), more_v = std::max(0.0, vv - least_vv);
  const double room = most_uv - std::abs(shares.uv);
  const double part = more_u + more_v > room ? room / (more_u + more_v) : 1;
  shares.uu = least_uu + part * more_u;
  shares.vv = least_vv + part * more_v;
  return shares;
}

}  // namespace

Kernel::Kernel(int kernel_radius)
    : radius(kernel_radius), weights(static_cast<std::size_t>(size()) * static_cast<std::size_t>(size())) {}

double Kernel::sum() const {
  return std::accumulate(weights.begin(), weights.end(), 0.0);
}

Moments Kernel::moments() const {
  Moments sums;
  double total = 0;
  for (int row = -radius; row <= radius; ++row)
    for (int column = -radius; column <= radius; ++column) {
      const double weight = at(row, column);
      total += weight;
      sums.mean[0] += column * weight;
      sums.mean[1] += row * weight;
      sums.uu += column * column * weight;
      sums.uv += column * row * weight;
      sums.vv += row * row * weight;
    }
  return {{sums.mean[0] / total, sums.mean[1] / total}, sums.uu / total, sums.uv / total, sums.vv / total};
}

void Kernel::match(const Moments& wanted) {
  const Shares shares = shares_towards(moments(), wanted);
  const std::vector<double> before = weights;
  std::fill(weights.begin(), weights.end(), 0.0);
  for (int row = -radius; row <= radius; ++row)
    for (int column = -radius; column <= radius; ++column) {
      const double weight = before[index(row, column)];
      if (weight == 0) continue;
      for (int i = -1; i <= 1; ++i)
        for (int j = -1; j <= 1; ++j)
          at(std::clamp(row + i, -radius, radius), std::clamp(column + j, -radius, radius)) +=
              weight * shares.at(i, j);
    }
}

RunningPsf::RunningPsf(const Psf& psf, double origin_um, int merged)
    : spacing_um_(merged * psf.spacing_um), origin_um_(origin_um) {
  // The middle sample is in the middle of its block, so that a mirrored PSF has mirrored blocks.
  const int middle = psf.size / 2, before = (middle + merged / 2) / merged,
            shift = before * merged + merged / 2 - middle;
  size_ = (psf.size - 1 + shift) / merged + 1;
  first_um_ = -before * spacing_um_;
  const auto size = static_cast<std::size_t>(size_), step = static_cast<std::size_t>(merged);
  const auto samples = static_cast<std::size_t>(psf.size), skipped = static_cast<std::size_t>(shift);
  const double of_square = psf.spacing_um * psf.spacing_um / 12;
  sums_.assign(size * (size + 1), 0.0);
  for (std::size_t i = 0; i < samples; ++i) {
    double* sums = sums_.data() + (i + skipped) / step * (size + 1) + 1;
    const double t_um = (double(i) - double(samples / 2)) * psf.spacing_um - origin_um_;
    for (std::size_t j = 0; j < samples; ++j) {
      const double value = double(psf.values[i * samples + j]);
      const double s_um = (double(j) - double(samples / 2)) * psf.spacing_um;
      moments_.mean[0] += value * s_um;
      moments_.mean[1] += value * t_um;
      moments_.uu += value * (s_um * s_um + of_square);
      moments_.uv += value * s_um * t_um;
      moments_.vv += value * (t_um * t_um + of_square);
      sum_ += value;
      sums[(j + skipped) / step] += value;
    }
  }
  for (std::size_t row = 0; row < size; ++row)
    for (std::size_t column = 0; column < size; ++column)
      sums_[row * (size + 1) + column + 1] += sums_[row * (size + 1) + column];
}

void deposit(const RunningPsf& psf, const Placement& placement, const std::array<double, 2>& direction,
             double cell_um, Kernel& kernel) {
  // Picture columns run along −x', rows along +y'; e_t = direction, e_s = (direction_y, −direction_x).
  const Vector e_s{-direction[1], -direction[0]}, e_t{-direction[0], direction[1]};
  const auto [stretch_s, stretch_t] = placement.stretch;
  const double spacing = psf.spacing_um() / cell_um;
  const double s_mean = psf.moments().mean[0] / psf.sum(), t_mean = psf.moments().mean[1] / psf.sum();
  const double s_first = psf.first_um(), t_first = s_first - psf.origin_um();
  const double s = (s_mean + stretch_s * (s_first - s_mean)) / cell_um;
  const double t = (t_mean + stretch_t * (t_first - t_mean)) / cell_um;
  const Vector per_row{spacing * stretch_t * e_t[0], spacing * stretch_t * e_t[1]};
  const Vector per_column{spacing * stretch_s * e_s[0], spacing * stretch_s * e_s[1]};

  // Samples coarser than a cell are cut into squares that are not.
  const double side = spacing * std::sqrt(stretch_s * stretch_t);
  const int parts = std::max(1, static_cast<int>(std::ceil(side)));
  const double box = side / parts, middle = kernel.radius + 1.5 - side / 2;
  const double share = placement.weight / (double(parts) * parts);
  const Vector first{middle + s * e_s[0] + t * e_t[0], middle + s * e_s[1] + t * e_t[1]};
  Canvas canvas(kernel.radius);
  for (int a = 0; a < parts; ++a)
    for (int b = 0; b < parts; ++b)
      add_squares(psf, share, box, {first[0] + b * box, first[1] + a * box}, per_row, per_column, canvas);

  const int radius = kernel.radius;
  for (int row = -radius; row <= radius; ++row)
    for (int column = -radius; column <= radius; ++column)
      kernel.at(row, column) +=
          canvas.sums[static_cast<std::size_t>((row + radius + 1) * canvas.width + column + radius + 1)];
}

}  // namespace petzval
