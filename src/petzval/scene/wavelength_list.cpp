// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/wavelength.h>
#include <petzval/scene/wavelength_list.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

namespace petzval {

namespace {

/// Adds one item of a list of wavelengths: a number or from:step:to.
void add_wavelengths(std::string_view item, std::vector<double>& wavelengths, const std::string& all) {
  const auto complain = [&] {
    throw InputError(
        fmt::format("wavelengths {}: write 400:10:700 (from, step, to) or a list such as 450,550,650", all));
  };
  constexpr double max_count = 10000;
  std::vector<double> numbers;
  for (std::size_t from = 0; from <= item.size();) {
    const std::size_t to = std::min(item.find(':', from), item.size());
    const std::optional<double> number = parse_number(item.substr(from, to - from));
    if (!number || !(*number > 0)) complain();
    numbers.push_back(*number);
    from = to + 1;
  }
  if (numbers.size() == 1) return wavelengths.push_back(numbers[0]);
  if (numbers.size() != 3 || numbers[2] < numbers[0]) complain();
  const double steps = (numbers[2] - numbers[0]) / numbers[1];
  if (!(steps < max_count)) complain();
  // The end belongs to the range although steps such as 0.1 do not add up to it exactly.
  constexpr double rounding = 1e-9;
  for (int i = 0; i <= std::floor(steps + rounding); ++i) wavelengths.push_back(numbers[0] + i * numbers[1]);
}

}  // namespace

std::vector<double> parse_wavelengths_nm(const std::string& text) {
  std::vector<double> wavelengths;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find(',', from), text.size());
    add_wavelengths(std::string_view(text).substr(from, to - from), wavelengths, text);
    from = to + 1;
  }
  for (std::size_t i = 1; i < wavelengths.size(); ++i)
    if (!(wavelengths[i] > wavelengths[i - 1]))
      throw InputError(fmt::format("wavelengths {}: they must increase", text));
  if (!wavelengths.empty()) require_wavelength(wavelengths.front(), "wavelengths " + text);
  return wavelengths;
}

std::string runs_of_bands(const std::vector<double>& bands_nm,
                          const std::function<bool(double nm)>& is_meant) {
  std::vector<std::string> runs;  // of bands side by side
  for (auto first = std::find_if(bands_nm.begin(), bands_nm.end(), is_meant); first != bands_nm.end();) {
    const auto end = std::find_if_not(first, bands_nm.end(), is_meant);
    runs.push_back(end - first == 1 ? fmt::format("{:g}", *first)
                                    : fmt::format("{:g} to {:g}", *first, *(end - 1)));
    first = std::find_if(end, bands_nm.end(), is_meant);
  }
  return fmt::format("{}", fmt::join(runs, ", "));
}

}  // namespace petzval
