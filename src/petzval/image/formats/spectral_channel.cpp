// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/image/formats/spectral_channel.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace petzval {

namespace {

constexpr double speed_of_light_m_per_s = 299792458.0;
constexpr double nm_per_m = 1e9;

/// Power of ten of an SI prefix; nothing for anything else.
std::optional<int> prefix_exponent(std::string_view prefix) {
  constexpr std::pair<std::string_view, int> prefixes[] = {
      {"", 0},   {"da", 1}, {"h", 2},  {"k", 3},  {"M", 6},  {"G", 9},  {"T", 12}, {"P", 15}, {"E", 18},
      {"Z", 21}, {"Y", 24}, {"d", -1}, {"c", -2}, {"m", -3}, {"u", -6}, {"n", -9}, {"p", -12}};
  for (const auto& [text, exponent] : prefixes)
    if (text == prefix) return exponent;
  return {};
}

/// "550,0nm" → 550.0; the value and its decimal exponent are scaled in one step, so that "0,55um" is 550
/// exactly.
std::optional<double> wavelength_from(std::string_view text) {
  const bool frequency = text.ends_with("Hz");
  if (!frequency && !text.ends_with('m')) return {};
  text.remove_suffix(frequency ? 2 : 1);
  const std::size_t digits = text.find_last_of("0123456789") + 1;  // npos + 1 is 0
  const std::optional<int> exponent = prefix_exponent(text.substr(digits));
  std::string number(text.substr(0, digits));
  if (!exponent || number.find('-') == 0) return {};
  std::replace(number.begin(), number.end(), ',', '.');
  double value = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc{} || end != number.data() + number.size()) return {};
  if (frequency) {
    value = speed_of_light_m_per_s * nm_per_m / (value * std::pow(10.0, *exponent));
  } else {
    const int shift = *exponent + 9;
    value = shift >= 0 ? value * std::pow(10.0, shift) : value / std::pow(10.0, -shift);
  }
  if (!std::isfinite(value) || value <= 0) return {};
  return value;
}

}  // namespace

std::string spectral_channel_name(SpectralChannel channel) {
  std::string number = fmt::format("{:#}", channel.wavelength_nm);
  if (number.ends_with('.')) number += '0';
  std::replace(number.begin(), number.end(), '.', ',');
  const bool emissive = channel.kind == SpectralChannel::Kind::emissive;
  return fmt::format("{}.{}nm", emissive ? fmt::format("S{}", channel.stokes) : "T", number);
}

std::optional<SpectralChannel> parse_spectral_channel(std::string_view name) {
  SpectralChannel channel;
  if (name.starts_with("T.")) {
    channel.kind = SpectralChannel::Kind::reflective;
    name.remove_prefix(2);
  } else if (name.size() > 3 && name[0] == 'S' && name[1] >= '0' && name[1] <= '3' && name[2] == '.') {
    channel.stokes = name[1] - '0';
    name.remove_prefix(3);
  } else {
    return {};
  }
  const std::optional<double> wavelength = wavelength_from(name);
  if (!wavelength) return {};
  channel.wavelength_nm = *wavelength;
  return channel;
}

}  // namespace petzval
