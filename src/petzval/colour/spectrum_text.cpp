// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/colour/spectrum_text.h>

#include <charconv>

namespace petzval {

std::string spectrum_text(const Spectrum& spectrum) {
  std::string text;
  for (std::size_t i = 0; i < spectrum.values().size(); ++i)
    text += fmt::format("{}{}:{}", i == 0 ? "" : " ", spectrum.wavelengths_nm()[i], spectrum.values()[i]);
  return text;
}

Spectrum parse_spectrum_text(std::string_view text) {
  std::vector<double> wavelengths, values;
  const char* at = text.data();
  const char* const end = at + text.size();
  const auto number = [&](std::vector<double>& into, char separator) {
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    const bool separated = next != end && *next == separator;
    if (error != std::errc() || (next != end && !separated) || (separator == ':' && !separated))
      throw InputError("is no spectrum such as 400:0.12 410:0.13");
    into.push_back(value);
    at = separated ? next + 1 : next;
  };
  while (at != end) {
    number(wavelengths, ':');
    number(values, ' ');
  }
  return Spectrum(std::move(wavelengths), std::move(values));
}

}  // namespace petzval
