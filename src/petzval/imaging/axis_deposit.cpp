// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/axis_deposit.h>
#include <petzval/imaging/row_convolution.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace petzval {

namespace {

/// What each cell of a line takes of the samples: entries first[cell] to first[cell + 1].
struct LineShares {
  std::vector<std::size_t> first, sample;
  std::vector<float> share;
};

/// The share of a triangle of base 2 · half within `length` of its end.
double share_within(double length, double half) {
  const double at = std::clamp(length / half, 0.0, 2.0);
  return at < 1 ? at * at / 2 : 1 - (2 - at) * (2 - at) / 2;
}

/// \param first  the first sample, counted from the start of the first cell. \param step  from sample to
/// sample. \param cells  with one more at the start, and two at the end.
LineShares line_shares(std::size_t samples, double first, double step, std::size_t cells) {
  struct Share {
    std::size_t sample, cell;
    float share;
  };
  // Triangles longer than a cell are cut into parts that are not.
  const int parts = std::max(1, static_cast<int>(std::ceil(2 * std::abs(step) - 1e-9)));
  const double half = std::abs(step) / parts;
  std::vector<Share> given;
  LineShares shares;
  shares.first.resize(cells + 1);
  const auto give = [&](std::size_t sample, std::size_t cell, double share) {
    given.push_back({sample, cell, static_cast<float>(share)});
    ++shares.first[cell + 1];
  };
  for (std::size_t sample = 0; sample < samples; ++sample)
    for (int part = 0; part < parts; ++part) {
      const double middle = first + (double(sample) + (part + 0.5) / parts - 0.5) * step;
      const double begin = middle - half, cell = std::floor(begin) + 1;
      if (!(cell >= 0 && cell + 1 < double(cells))) continue;
      const double here = share_within(cell - begin, half) / parts;
      give(sample, static_cast<std::size_t>(cell), here);
      give(sample, static_cast<std::size_t>(cell) + 1, 1.0 / parts - here);
    }
  std::partial_sum(shares.first.begin(), shares.first.end(), shares.first.begin());
  shares.sample.resize(given.size()), shares.share.resize(given.size());
  std::vector<std::size_t> next(shares.first.begin(), shares.first.end() - 1);
  for (const Share& each : given) {
    const std::size_t at = next[each.cell]++;
    shares.sample[at] = each.sample, shares.share[at] = each.share;
  }
  return shares;
}

/// rows × columns to columns × rows, with row_padding() behind them.
std::vector<float> transposed(const float* values, std::size_t rows, std::size_t columns) {
  constexpr std::size_t block = 16;
  std::vector<float> result(rows * columns + row_padding());
  for (std::size_t first_row = 0; first_row < rows; first_row += block)
    for (std::size_t first = 0; first < columns; first += block)
      for (std::size_t row = first_row; row < std::min(rows, first_row + block); ++row)
        for (std::size_t column = first; column < std::min(columns, first + block); ++column)
          result[column * rows + row] = values[row * columns + column];
  return result;
}

/// Lines of `count` values each go to cells, which are lines of as many. \param lines  with row_padding()
/// behind the last; so has what is returned.
std::vector<float> gathered(const float* lines, std::size_t count, const LineShares& shares) {
  const std::size_t cells = shares.first.size() - 1;
  std::vector<float> sums(cells * count + row_padding());
  std::vector<RowTerm> terms;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    terms.clear();
    for (std::size_t i = shares.first[cell]; i < shares.first[cell + 1]; ++i)
      terms.push_back({lines + shares.sample[i] * count, &shares.share[i]});
    convolve_rows(terms, 0, count, sums.data() + cell * count);
  }
  return sums;
}

}  // namespace

void deposit_along_axes(const float* samples, std::size_t size, double weight, const PlacedLine& down,
                        const PlacedLine& across, Kernel& kernel) {
  const auto cells = static_cast<std::size_t>(kernel.size()), sums = cells + 3;
  const auto shares = [&](const PlacedLine& line) {
    return line_shares(size, line.first + kernel.radius + 0.5, line.step, sums);
  };
  const std::vector<float> columns = transposed(gathered(samples, size, shares(down)).data(), sums, size);
  const std::vector<float> light =
      transposed(gathered(columns.data(), sums, shares(across)).data(), sums, sums);
  for (std::size_t row = 0; row < cells; ++row) {
    const float* from = light.data() + (row + 1) * sums + 1;
    double* to = kernel.weights.data() + row * cells;
    for (std::size_t column = 0; column < cells; ++column) to[column] += weight * double(from[column]);
  }
}

}  // namespace petzval
