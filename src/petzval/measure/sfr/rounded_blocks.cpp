// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/measure/sfr/rounded_blocks.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace petzval {

namespace {

using Block = Eigen::Matrix<double, RoundedBlocks::side, RoundedBlocks::side, Eigen::RowMajor>;

/// The orthonormal cosine transform, as ITU-T T.81 has it: coefficients = cosines · block · cosinesᵀ.
Block cosines() {
  constexpr int n = RoundedBlocks::side;
  Block rows;
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < n; ++i)
      rows(k, i) = std::sqrt((k == 0 ? 1.0 : 2.0) / n) * std::cos(pi * (2 * i + 1) * k / (2 * n));
  return rows;
}

/// Eigen would pack matrices as small as these for a larger product, which takes longer.
Block product(const Block& a, const Block& b) {
  return a.lazyProduct(b);
}

/// What a JPEG makes of the code values of a block.
Block rounded(const Block& codes, std::span<const int> steps) {
  static const Block forth = cosines(), back = forth.transpose();
  constexpr double middle = 128;  // taken off before the transform
  Block block = product(product(forth, codes.array() - middle), back);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    double& coefficient = block.data()[i];
    const double in_steps = coefficient / steps[i];
    const auto whole = static_cast<std::int64_t>(in_steps + std::copysign(0.5, in_steps));
    coefficient = steps[i] * static_cast<double>(whole);
  }
  return product(product(back, block), forth).array() + middle;
}

}  // namespace

RoundedBlocks::RoundedBlocks(const Plane& plane, std::span<const int> steps, std::span<const double> levels)
    : codes_(plane), steps_(steps), levels_(levels) {
  constexpr std::size_t bins_per_level = 4;
  first_above_.resize(bins_per_level * levels_.size());
  bins_per_light_ = static_cast<double>(first_above_.size()) / (levels_.back() - levels_.front());
  std::size_t code = 1;
  for (std::size_t bin = 0; bin < first_above_.size(); ++bin) {
    const double light = levels_.front() + static_cast<double>(bin) / bins_per_light_;
    while (code + 1 < levels_.size() && levels_[code] <= light) ++code;
    first_above_[bin] = code;
  }
  for (double& value : codes_.values) value = code_of(value);
}

/// Straight between code values, and beyond them as between the last two.
double RoundedBlocks::code_of(double light) const {
  const double bin = (light - levels_.front()) * bins_per_light_,
               last = static_cast<double>(first_above_.size()) - 1;
  std::size_t above = first_above_[static_cast<std::size_t>(std::clamp(bin, 0.0, last))];
  while (above + 1 < levels_.size() && levels_[above] <= light) ++above;
  return static_cast<double>(above) + (light - levels_[above]) / (levels_[above] - levels_[above - 1]);
}

double RoundedBlocks::light_of(double code) const {
  const auto last = static_cast<double>(levels_.size()) - 2;
  const double low = std::clamp(std::floor(code), 0.0, last);
  const double* const at = &levels_[static_cast<std::size_t>(low)];
  return at[0] + (code - low) * (at[1] - at[0]);
}

double RoundedBlocks::room_of_means(double light) const {
  return light_of(code_of(light) + static_cast<double>(steps_.front()) / side) - light;
}

std::vector<double> RoundedBlocks::changes(std::span<const EdgeSample> samples, std::span<const double> light,
                                           const Offset& offset) const {
  std::vector<double> result(samples.size());
  if (samples.empty()) return result;
  const auto block_of = [](double place, int from) { return (static_cast<int>(place) + side - from) / side; };
  const auto [left_most, right_most] = std::ranges::minmax_element(samples, {}, &EdgeSample::x);
  const auto [highest, lowest] = std::ranges::minmax_element(samples, {}, &EdgeSample::y);
  const int first_column = block_of(left_most->x, offset.x), first_row = block_of(highest->y, offset.y);
  const int columns = block_of(right_most->x, offset.x) + 1 - first_column,
            rows = block_of(lowest->y, offset.y) + 1 - first_row;
  std::vector<std::vector<std::size_t>> in_block(static_cast<std::size_t>(columns) *
                                                 static_cast<std::size_t>(rows));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const int row = block_of(samples[i].y, offset.y) - first_row,
              column = block_of(samples[i].x, offset.x) - first_column;
    in_block[static_cast<std::size_t>(row * columns + column)].push_back(i);
  }
  for (int index = 0; index < rows * columns; ++index) {
    const std::vector<std::size_t>& members = in_block[static_cast<std::size_t>(index)];
    const int top = (first_row + index / columns - 1) * side + offset.y,
              left = (first_column + index % columns - 1) * side + offset.x;
    if (members.empty() || top < 0 || left < 0 || top + side > codes_.rows || left + side > codes_.columns)
      continue;
    Block codes;
    for (int row = 0; row < side; ++row)
      for (int column = 0; column < side; ++column) codes(row, column) = codes_.at(left + column, top + row);
    const auto code_at = [&](std::size_t i) -> double& {
      return codes(static_cast<int>(samples[i].y) - top, static_cast<int>(samples[i].x) - left);
    };
    for (const std::size_t i : members) code_at(i) = code_of(light[i]);
    codes = rounded(codes, steps_);
    for (const std::size_t i : members) result[i] = light_of(code_at(i)) - light[i];
  }
  return result;
}

}  // namespace petzval
