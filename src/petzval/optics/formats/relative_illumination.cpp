// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/optics/formats/relative_illumination.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace petzval {

namespace {

constexpr double per_cent = 100;
/// Files have as few as two or three digits.
constexpr double digits_of_files = 0.01;

bool all_near(std::span<const double> values, double level) {
  return std::all_of(values.begin(), values.end(),
                     [level](double value) { return std::abs(value - level) <= digits_of_files * level; });
}

}  // namespace

void take_per_cent(std::vector<double>& values, std::size_t wavelengths, std::vector<std::string>& notes) {
  if (!all_near(std::span(values).first(wavelengths), per_cent)) return;
  for (double& value : values) value /= per_cent;
  notes.emplace_back("the relative illumination is 100 on the axis: it is taken to be in per cent");
}

void make_relative_to_axis(std::vector<double>& values, std::size_t wavelengths,
                           std::vector<std::string>& notes) {
  const std::vector<double> axis(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(wavelengths));
  if (all_near(axis, 1)) return;
  // An axis without light, or one that is no number, is refused by LensDataTable::validate().
  if (!std::all_of(axis.begin(), axis.end(), [](double value) { return value > 0 && std::isfinite(value); }))
    return;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] /= axis[i % wavelengths];
  const auto [least, greatest] = std::minmax_element(axis.begin(), axis.end());
  notes.push_back(fmt::format(
      "the relative illumination is {} on the axis, where it is 1 by its meaning: it is divided by that",
      *least == *greatest ? fmt::format("{:.4g}", *least)
                          : fmt::format("{:.4g} to {:.4g}", *least, *greatest)));
}

}  // namespace petzval
