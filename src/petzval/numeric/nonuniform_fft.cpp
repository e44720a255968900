// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/numeric/fft.h>
#include <petzval/numeric/mass_spreading.h>
#include <petzval/numeric/nonuniform_fft.h>
#include <petzval/numeric/spreading_kernel.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr int width = SpreadingKernel::width;
using Complex = std::complex<double>;

/// Where a coordinate [turns] falls on a grid: the first cell that its kernel reaches, and the fraction left.
struct GridPlace {
  int first;  ///< 0 … size − 1
  double offset;
};

GridPlace place_on_grid(double turns, int size) {
  const double position = (turns - std::floor(turns)) * size;
  const double first = std::ceil(position - width / 2.0);
  const int index = static_cast<int>(first);
  return {index < 0 ? index + size : index % size, first - position + width / 2.0};
}

/// Points in the order of the first grid row that they touch.
struct RowOrder {
  std::vector<std::size_t> start;  ///< [row]: where its points begin; one more at the end
  std::vector<std::uint32_t> point;
};

RowOrder order_by_row(std::span<const double> y, int rows) {
  RowOrder order;
  order.start.assign(static_cast<std::size_t>(rows) + 1, 0);
  for (const double each : y) ++order.start[static_cast<std::size_t>(place_on_grid(each, rows).first) + 1];
  for (std::size_t r = 0; r + 1 < order.start.size(); ++r) order.start[r + 1] += order.start[r];
  std::vector<std::size_t> next(order.start.begin(), order.start.end() - 1);
  order.point.resize(y.size());
  for (std::size_t j = 0; j < y.size(); ++j)
    order.point[next[static_cast<std::size_t>(place_on_grid(y[j], rows).first)]++] =
        static_cast<std::uint32_t>(j);
  return order;
}

/// Rows [first, first + count) of the grid with the masses spread over them; each row has `width` cells more
/// than the grid has columns, for what laps over its end.
class Band {
 public:
  Band(const PointMasses& points, const RowOrder& order, int columns, int rows)
      : points_(points), order_(order), columns_(columns), rows_(rows) {}

  void spread(int first, int count) {
    stride_ = static_cast<std::size_t>(columns_) + SpreadingKernel::lanes + 2;
    stride_ += stride_ % 2;  // a whole number of complex ones
    cells_.assign(stride_ * static_cast<std::size_t>(count), 0);
    for (int start = first - width + 1; start < first + count; ++start) {
      const auto row = static_cast<std::size_t>((start % rows_ + rows_) % rows_);
      for (std::size_t j = order_.start[row]; j < order_.start[row + 1]; ++j)
        spread_point(order_.point[j], start - first, count);
    }
    for (int r = 0; r < count; ++r) {
      double* line = row_cells(r);
      for (int c = 0; c < width; ++c) line[c] += line[columns_ + c];
    }
  }
  double* row_cells(int row) { return cells_.data() + static_cast<std::size_t>(row) * stride_; }
  /// From one row_line() to the next.
  std::ptrdiff_t line_step() const { return static_cast<std::ptrdiff_t>(stride_ / 2); }
  Complex* row_line(int row) { return reinterpret_cast<Complex*>(row_cells(row)); }

 private:
  void spread_point(std::size_t j, int start, int count) {
    const GridPlace x = place_on_grid(points_.x[j], columns_);
    const double y_offset = place_on_grid(points_.y[j], rows_).offset;
    const int top = std::max(0, -start), end = std::min(width, count - start);
    if (top < end)
      spread_mass({x.offset, y_offset, points_.mass[j]}, top, end, row_cells(start + top) + x.first,
                  static_cast<std::ptrdiff_t>(stride_));
  }

  const PointMasses& points_;
  const RowOrder& order_;
  int columns_, rows_;
  std::size_t stride_ = 0;
  AlignedVector<double> cells_;
};

}  // namespace

void PointMasses::reserve(std::size_t count) {
  x.reserve(count);
  y.reserve(count);
  mass.reserve(count);
}

void PointMasses::add(double at_x, double at_y, double of_mass) {
  x.push_back(at_x);
  y.push_back(at_y);
  mass.push_back(of_mass);
}

NonuniformFft2::NonuniformFft2(int k_max, int l_max) : k_max_(k_max), l_max_(l_max) {
  constexpr int highest = 1 << 23;
  if (k_max < 0 || l_max < 0 || k_max > highest || l_max > highest)
    throw InputError(
        fmt::format("a transform up to frequencies {} and {}: at most {} is right", k_max, l_max, highest));
  columns_ = spreading_grid_size(k_max);
  rows_ = spreading_grid_size(l_max);
  column_correction_ = spreading_kernel().correction(k_max, columns_);
  row_correction_ = spreading_kernel().correction(l_max, rows_);
}

void NonuniformFft2::transform(const PointMasses& points, int alias_period, std::size_t max_bytes,
                               const Visitor& visit) const {
  if (points.size() > UINT32_MAX) throw InputError("more than 2^32 points in one transform");
  constexpr int band_rows = 32;
  const RowOrder order = order_by_row(points.y, rows_);
  const LineFft row_fft(columns_), column_fft(rows_);
  const std::size_t rows = static_cast<std::size_t>(rows_);
  const std::size_t column_bytes = rows * sizeof(Complex);
  const int pass_columns = static_cast<int>(
      std::clamp<std::size_t>(max_bytes / column_bytes, 1, static_cast<std::size_t>(k_max_) + 1));
  AlignedVector<Complex> slab(static_cast<std::size_t>(pass_columns) * rows);  // [column][row]

  for (int first = 0; first <= k_max_; first += pass_columns) {
    const int end = std::min(first + pass_columns, k_max_ + 1);
    // Rows of the grid, band by band; only the frequencies of this pass are kept.
    parallel_for(static_cast<std::size_t>((rows_ + band_rows - 1) / band_rows), [&](std::size_t band_index) {
      Band band(points, order, columns_, rows_);
      const int top = static_cast<int>(band_index) * band_rows, count = std::min(band_rows, rows_ - top);
      band.spread(top, count);
      row_fft.forward_real(band.row_line(0), static_cast<std::size_t>(count), band.line_step());
      for (int k = first; k < end; ++k) {
        Complex* column = slab.data() + static_cast<std::size_t>(k - first) * rows + top;
        for (int r = 0; r < count; ++r) column[r] = band.row_line(r)[k];
      }
    });
    constexpr std::size_t batch = 16;
    const auto columns = static_cast<std::size_t>(end - first);
    parallel_for((columns + batch - 1) / batch, [&](std::size_t index) {
      column_fft.forward(slab.data() + index * batch * rows, std::min(batch, columns - index * batch),
                         static_cast<std::ptrdiff_t>(rows));
    });
    // Columns that fold onto each other are visited one after the other.
    parallel_for(static_cast<std::size_t>(alias_period / 2 + 1), [&](std::size_t residue) {
      std::vector<Complex> values(2 * static_cast<std::size_t>(l_max_) + 1);
      for (int k = first; k < end; ++k) {
        const int rest = k % alias_period;
        if (static_cast<std::size_t>(std::min(rest, alias_period - rest)) != residue) {
          // The next k that is ±residue modulo the period.
          const int up = static_cast<int>(residue) - rest,
                    down = alias_period - static_cast<int>(residue) - rest;
          const int step = up > 0 ? up : (down > 0 ? down : up + alias_period);
          k += step - 1;
          continue;
        }
        const Complex* column = slab.data() + static_cast<std::size_t>(k - first) * rows;
        const double k_correction = column_correction_[static_cast<std::size_t>(k)];
        for (int l = -l_max_; l <= l_max_; ++l)
          values[static_cast<std::size_t>(l + l_max_)] =
              column[l < 0 ? l + rows_ : l] *
              (k_correction * row_correction_[static_cast<std::size_t>(std::abs(l))]);
        visit(k, values);
      }
    });
  }
}

std::vector<Complex> nonuniform_fft(std::span<const double> y, std::span<const double> mass, int l_max) {
  const int size = spreading_grid_size(l_max);
  const LineFft fft(size);
  AlignedVector<Complex> line(static_cast<std::size_t>(size) / 2 + 1 + SpreadingKernel::lanes);
  auto* cells = reinterpret_cast<double*>(line.data());
  double weights[SpreadingKernel::lanes];
  for (std::size_t j = 0; j < y.size(); ++j) {
    const GridPlace place = place_on_grid(y[j], size);
    spreading_kernel().values(place.offset, weights);
    for (int c = 0; c < width; ++c) cells[(place.first + c) % size] += mass[j] * weights[c];
  }
  fft.forward_real(line.data());
  const std::vector<double> correction = spreading_kernel().correction(l_max, size);
  std::vector<Complex> result(correction.size());
  for (std::size_t l = 0; l < result.size(); ++l) result[l] = line[l] * correction[l];
  return result;
}

}  // namespace petzval
