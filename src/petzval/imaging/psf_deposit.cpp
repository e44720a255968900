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
void add_squares(std::span<const WeightedPsf> psfs, double share, double box, const Vector& first,
                 const Vector& per_row, const Vector& per_column, Canvas& canvas) {
  const Walker across(per_column[0], box), down(per_column[1], box);
  const auto size = static_cast<std::size_t>(psfs.front().psf->size());
  const auto light = [&](std::size_t row, std::size_t from, std::size_t to) {
    double sum = 0;
    for (const auto& [psf, weight] : psfs) sum += weight * psf->run(row, from, to);
    return share * sum;
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

}  // namespace

Kernel::Kernel(int kernel_radius)
    : radius(kernel_radius), weights(static_cast<std::size_t>(size()) * static_cast<std::size_t>(size())) {}

double Kernel::sum() const {
  return std::accumulate(weights.begin(), weights.end(), 0.0);
}

std::array<double, 2> Kernel::centroid() const {
  double column_moment = 0, row_moment = 0, total = 0;
  for (int row = -radius; row <= radius; ++row)
    for (int column = -radius; column <= radius; ++column) {
      const double weight = at(row, column);
      column_moment += column * weight;
      row_moment += row * weight;
      total += weight;
    }
  return {column_moment / total, row_moment / total};
}

void Kernel::shift(const std::array<double, 2>& by) {
  // Against the direction of the shift, so that what was handed on is not handed on again.
  const auto move = [&](double share, const auto& cell) {
    const int towards = share < 0 ? -1 : 1;
    const double part = std::abs(share);
    for (int across = -radius; across <= radius; ++across)
      for (int along = radius - 1; along >= -radius; --along) {
        double& from = cell(across, towards * along);
        cell(across, towards * (along + 1)) += part * from;
        from *= 1 - part;
      }
  };
  move(by[0], [&](int row, int column) -> double& { return at(row, column); });
  move(by[1], [&](int column, int row) -> double& { return at(row, column); });
}

RunningPsf::RunningPsf(const Psf& psf) : size_(psf.size), spacing_um_(psf.spacing_um) {
  const auto size = static_cast<std::size_t>(size_);
  sums_.reserve(size * (size + 1));
  for (std::size_t i = 0; i < size; ++i) {
    double sum = 0;
    sums_.push_back(0);
    const double t_um = (double(i) - double(size / 2)) * spacing_um_;
    for (std::size_t j = 0; j < size; ++j) {
      const double value = double(psf.values[i * size + j]);
      first_moment_um_[0] += value * (double(j) - double(size / 2)) * spacing_um_;
      first_moment_um_[1] += value * t_um;
      sums_.push_back(sum += value);
    }
    sum_ += sum;
  }
}

void deposit(std::span<const WeightedPsf> psfs, const std::array<double, 2>& direction, double cell_um,
             Kernel& kernel) {
  // Picture columns run along −x', rows along +y'; e_t = direction, e_s = (direction_y, −direction_x).
  const RunningPsf& grid = *psfs.front().psf;
  const double spacing = grid.spacing_um() / cell_um;
  const Vector per_row{-spacing * direction[0], spacing * direction[1]};      // one step in t
  const Vector per_column{-spacing * direction[1], -spacing * direction[0]};  // one step in s
  const double middle = kernel.radius + 1.5, half = grid.size() / 2;
  const auto corner = [&](std::size_t axis) {
    return middle - half * (per_row[axis] + per_column[axis]) - spacing / 2;
  };

  // Samples coarser than a cell are cut into squares that are not.
  const int parts = std::max(1, static_cast<int>(std::ceil(spacing)));
  const double box = spacing / parts;
  Canvas canvas(kernel.radius);
  for (int a = 0; a < parts; ++a)
    for (int b = 0; b < parts; ++b)
      add_squares(psfs, 1 / (double(parts) * parts), box, {corner(0) + b * box, corner(1) + a * box}, per_row,
                  per_column, canvas);

  const int radius = kernel.radius;
  for (int row = -radius; row <= radius; ++row)
    for (int column = -radius; column <= radius; ++column)
      kernel.at(row, column) +=
          canvas.sums[static_cast<std::size_t>((row + radius + 1) * canvas.width + column + radius + 1)];
}

}  // namespace petzval
