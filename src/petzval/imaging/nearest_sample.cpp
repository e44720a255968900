// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/imaging/nearest_sample.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

constexpr std::int64_t none = -1;

/// In one column: the row of the nearest wanted sample to each, or none.
void nearest_in_column(std::size_t column, std::size_t columns, std::size_t rows,
                       std::span<const std::uint8_t> wanted, std::vector<std::int64_t>& nearest_row) {
  std::int64_t last = none;
  for (std::size_t row = 0; row < rows; ++row) {
    if (wanted[row * columns + column] != 0) last = static_cast<std::int64_t>(row);
    nearest_row[row * columns + column] = last;
  }
  last = none;
  for (std::size_t row = rows; row-- > 0;) {
    std::int64_t& here = nearest_row[row * columns + column];
    if (wanted[row * columns + column] != 0) last = static_cast<std::int64_t>(row);
    if (last == none) continue;
    const auto at = static_cast<std::int64_t>(row);
    if (here == none || last - at < at - here) here = last;
  }
}

/// Along one row: the parabolas (x − column)² + (distance within the column)² of all columns that have a
/// wanted sample; each stretch of the row belongs to the lowest of them.
void nearest_in_row(std::size_t row, std::size_t columns, std::span<const std::int64_t> nearest_row,
                    std::span<std::uint32_t> nearest) {
  std::vector<std::size_t> lowest;  // columns whose parabolas make up the envelope
  std::vector<double> from;         // where each of them begins
  const auto height = [&](std::size_t column) {
    const double down = double(nearest_row[row * columns + column]) - double(row);
    return down * down;
  };
  const auto meeting = [&](std::size_t left, std::size_t right) {
    const double l = double(left), r = double(right);
    return ((height(right) + r * r) - (height(left) + l * l)) / (2 * (r - l));
  };
  for (std::size_t column = 0; column < columns; ++column) {
    if (nearest_row[row * columns + column] == none) continue;
    double start = -std::numeric_limits<double>::infinity();
    while (!lowest.empty()) {
      start = meeting(lowest.back(), column);
      if (start > from.back()) break;
      lowest.pop_back(), from.pop_back();
      start = -std::numeric_limits<double>::infinity();
    }
    lowest.push_back(column), from.push_back(start);
  }
  std::size_t k = 0;
  for (std::size_t column = 0; column < columns; ++column) {
    while (k + 1 < lowest.size() && from[k + 1] < double(column)) ++k;
    const std::size_t source = lowest[k];
    nearest[column] = static_cast<std::uint32_t>(
        static_cast<std::size_t>(nearest_row[row * columns + source]) * columns + source);
  }
}

}  // namespace

std::vector<std::uint32_t> nearest_samples(int columns, int rows, std::span<const std::uint8_t> wanted) {
  const auto width = static_cast<std::size_t>(columns), height = static_cast<std::size_t>(rows);
  if (wanted.size() != width * height || wanted.size() > std::numeric_limits<std::uint32_t>::max())
    throw InputError(fmt::format("{} flags for {} x {} samples", wanted.size(), columns, rows));
  if (std::none_of(wanted.begin(), wanted.end(), [](std::uint8_t flag) { return flag != 0; }))
    throw InputError("there is no sample to be nearest to");
  std::vector<std::int64_t> nearest_row(wanted.size());
  parallel_for(width,
               [&](std::size_t column) { nearest_in_column(column, width, height, wanted, nearest_row); });
  std::vector<std::uint32_t> nearest(wanted.size());
  parallel_for(height, [&](std::size_t row) {
    nearest_in_row(row, width, nearest_row, std::span(nearest).subspan(row * width, width));
  });
  return nearest;
}

}  // namespace petzval
