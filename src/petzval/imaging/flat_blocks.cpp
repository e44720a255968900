// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/flat_blocks.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

constexpr std::size_t side = 16;

}  // namespace

FlatBlocks::FlatBlocks(std::span<const float> samples, std::size_t columns, std::size_t rows)
    : columns_(columns), rows_(rows), across_((columns + side - 1) / side) {
  for (std::size_t top = 0; top < rows; top += side)
    for (std::size_t left = 0; left < columns; left += side) {
      const float first = samples[top * columns + left];
      bool flat = true;
      for (std::size_t row = top; row < std::min(rows, top + side) && flat; ++row) {
        const auto of_row = samples.subspan(row * columns + left, std::min(side, columns - left));
        flat = std::all_of(of_row.begin(), of_row.end(), [&](float value) { return value == first; });
      }
      values_.push_back(flat ? first : std::numeric_limits<float>::quiet_NaN());
      any_ = any_ || flat;
    }
}

std::optional<float> FlatBlocks::value_in(double left, double right, double top, double bottom,
                                          bool extended) const {
  const auto last_column = static_cast<double>(columns_ - 1), last_row = static_cast<double>(rows_ - 1);
  left = std::floor(left), right = std::floor(right), top = std::floor(top), bottom = std::floor(bottom);
  if (!extended && (left < 0 || top < 0 || right > last_column || bottom > last_row)) return {};
  const auto block = [](double sample, double last) {
    return static_cast<std::size_t>(std::clamp(sample, 0.0, last)) / side;
  };
  const std::size_t from = block(left, last_column), to = block(right, last_column);
  const float value = values_[block(top, last_row) * across_ + from];
  for (std::size_t row = block(top, last_row); row <= block(bottom, last_row); ++row)
    for (std::size_t column = from; column <= to; ++column)
      if (values_[row * across_ + column] != value) return {};  // NaN, too
  return value;
}

}  // namespace petzval
