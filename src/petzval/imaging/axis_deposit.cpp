// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/axis_deposit.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace petzval {

namespace {

/// What a sample, or a part of one, gives a line of cells.
struct LineShare {
  std::size_t sample, cell;
  float here, next;  ///< of the cell, and of the one behind it
};

/// The share of a triangle of base 2 · half within `length` of its end.
double share_within(double length, double half) {
  const double at = std::clamp(length / half, 0.0, 2.0);
  return at < 1 ? at * at / 2 : 1 - (2 - at) * (2 - at) / 2;
}

/// \param first  the first sample, counted from the start of the first cell. \param step  from sample to
/// sample.
std::vector<LineShare> line_shares(std::size_t samples, double first, double step, std::size_t cells) {
  // Triangles longer than a cell are cut into parts that are not.
  const int parts = std::max(1, static_cast<int>(std::ceil(2 * std::abs(step) - 1e-9)));
  const double half = std::abs(step) / parts;
  std::vector<LineShare> shares;
  for (std::size_t sample = 0; sample < samples; ++sample)
    for (int part = 0; part < parts; ++part) {
      const double middle = first + (double(sample) + (part + 0.5) / parts - 0.5) * step;
      const double begin = middle - half, cell = std::floor(begin);
      if (!(cell >= -1 && cell < double(cells))) continue;
      const double here = share_within(cell + 1 - begin, half) / parts;
      shares.push_back({sample, static_cast<std::size_t>(cell + 1), static_cast<float>(here),
                        static_cast<float>(1.0 / parts - here)});
    }
  return shares;
}

/// rows × columns to columns × rows.
std::vector<float> transposed(const std::vector<float>& values, std::size_t rows, std::size_t columns) {
  constexpr std::size_t block = 16;
  std::vector<float> result(values.size());
  for (std::size_t first_row = 0; first_row < rows; first_row += block)
    for (std::size_t first = 0; first < columns; first += block)
      for (std::size_t row = first_row; row < std::min(rows, first_row + block); ++row)
        for (std::size_t column = first; column < std::min(columns, first + block); ++column)
          result[column * rows + row] = values[row * columns + column];
  return result;
}

void add_scaled(const float* line, float weight, std::size_t count, float* sums) {
  for (std::size_t i = 0; i < count; ++i) sums[i] += weight * line[i];
}

/// Lines of `count` values each go to cells, which are lines of as many: [cell + 1][value], with a cell more
/// at either end.
std::vector<float> gathered(const float* lines, std::size_t count, const std::vector<LineShare>& shares,
                            std::size_t cells) {
  std::vector<float> sums((cells + 3) * count);
  for (const LineShare& share : shares) {
    const float* line = lines + share.sample * count;
    float* cell = sums.data() + share.cell * count;
    add_scaled(line, share.here, count, cell);
    add_scaled(line, share.next, count, cell + count);
  }
  return sums;
}

}  // namespace

void deposit_along_axes(const float* samples, std::size_t size, double weight, const PlacedLine& down,
                        const PlacedLine& across, Kernel& kernel) {
  const auto cells = static_cast<std::size_t>(kernel.size());
  const auto shares = [&](const PlacedLine& line) {
    return line_shares(size, line.first + kernel.radius + 0.5, line.step, cells);
  };
  const std::vector<float> rows = gathered(samples, size, shares(down), cells);
  const std::vector<float> turned = transposed(rows, cells + 3, size);
  const std::vector<float> sums = gathered(turned.data(), cells + 3, shares(across), cells);
  for (std::size_t row = 0; row < cells; ++row)
    for (std::size_t column = 0; column < cells; ++column)
      kernel.weights[row * cells + column] += weight * double(sums[(column + 1) * (cells + 3) + row + 1]);
}

}  // namespace petzval
