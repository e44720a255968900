// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/quantities.h>
#include <petzval/base/wavelength.h>
#include <petzval/scene/wavelength_list.h>

#include <algorithm>

namespace petzval {

std::vector<double> parse_wavelengths_nm(const std::string& text) {
  const std::vector<double> wavelengths = parse_number_list(text, "wavelengths_nm");
  for (std::size_t i = 1; i < wavelengths.size(); ++i)
    if (!(wavelengths[i] > wavelengths[i - 1]))
      throw InputError(fmt::format("`wavelengths_nm` {}: they must increase", text));
  require_wavelength(wavelengths.front(), "`wavelengths_nm` " + text);
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
