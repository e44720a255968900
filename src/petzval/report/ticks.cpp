// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/report/ticks.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace petzval {

namespace {

/// A range that ends this part of a step beside a tick is taken to end on it.
constexpr double on_tick = 1e-6;
constexpr std::string_view minus_sign = "\xE2\x88\x92";  // U+2212

std::string with_true_minus(const std::string& text) {
  return text.starts_with('-') ? std::string(minus_sign) + text.substr(1) : text;
}

/// An axis with magnitudes from 10⁻³ to 10⁵ is written out; others in units of a power of 1000.
int common_exponent(double largest) {
  if (largest == 0 || (largest >= 1e-2 && largest < 1e5)) return 0;
  return 3 * static_cast<int>(std::floor(std::log10(largest) / 3));
}

std::string fixed_label(double value, double step) {
  const int decimals = std::clamp(static_cast<int>(-std::floor(std::log10(step) + 1e-9)), 0, 12);
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.find_first_not_of("-0.") == std::string::npos) text.erase(0, text[0] == '-' ? 1 : 0);
  return with_true_minus(text);
}

double nice_step(double rough) {
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * decade >= rough * (1 - 1e-9)) return factor * decade;
  return 10 * decade;
}

/// The range as it can be drawn: ordered, finite, not narrower than double precision can tell apart.
std::pair<double, double> drawable_linear(double from, double to) {
  constexpr double largest = 1e290;
  if (std::isnan(from)) from = std::isnan(to) ? 0 : to;
  if (std::isnan(to)) to = from;
  from = std::clamp(from, -largest, largest);
  to = std::clamp(to, -largest, largest);
  if (from > to) std::swap(from, to);
  const double magnitude = std::max(std::abs(from), std::abs(to));
  if (magnitude < 1e-290) return {-1, 1};
  if (to - from < magnitude * 1e-9) return {from - 0.1 * magnitude, to + 0.1 * magnitude};
  return {from, to};
}

Ticks linear_ticks(double low, double high, int wanted, bool round_outwards) {
  Ticks ticks;
  std::tie(ticks.from, ticks.to) = drawable_linear(low, high);
  const double step = nice_step((ticks.to - ticks.from) / wanted);
  double first = std::ceil(ticks.from / step - on_tick), last = std::floor(ticks.to / step + on_tick);
  if (round_outwards) {
    first = std::floor(ticks.from / step + on_tick);
    last = std::ceil(ticks.to / step - on_tick);
    ticks.from = std::min(ticks.from, first * step);
    ticks.to = std::max(ticks.to, last * step);
  }
  ticks.exponent = common_exponent(std::max(std::abs(ticks.from), std::abs(ticks.to)));
  const double unit = std::pow(10.0, ticks.exponent);
  for (double i = first; i <= last; ++i) {
    ticks.values.push_back(std::clamp(i * step, ticks.from, ticks.to));
    ticks.labels.push_back(fixed_label(i * step / unit, step / unit));
  }
  return ticks;
}

std::pair<double, double> drawable_logarithmic(double from, double to) {
  const auto usable = [](double value) { return std::isfinite(value) && value > 0; };
  if (!usable(from)) from = usable(to) ? to / 1e3 : 1;
  if (!usable(to)) to = from * 10;
  if (from > to) std::swap(from, to);
  from = std::clamp(from, 1e-290, 1e290);
  to = std::clamp(to, 1e-290, 1e290);
  return to > from * (1 + 1e-9) ? std::pair(from, to) : std::pair(from / 2, to * 2);
}

std::string decade_label(double value) {
  const int exponent = static_cast<int>(std::floor(std::log10(value) + 1e-9));
  if (exponent >= -3 && exponent <= 4) return short_number(value);
  const double mantissa = std::round(value / std::pow(10.0, exponent));
  return mantissa == 1 ? power_of_ten(exponent) : fmt::format("{:.0f}×{}", mantissa, power_of_ten(exponent));
}

Ticks logarithmic_ticks(double low, double high, int wanted, bool round_outwards) {
  Ticks ticks;
  std::tie(ticks.from, ticks.to) = drawable_logarithmic(low, high);
  const int first = static_cast<int>(std::floor(std::log10(ticks.from) + 1e-9));
  const int last = static_cast<int>(std::ceil(std::log10(ticks.to) - 1e-9));
  if (round_outwards) {
    ticks.from = std::min(ticks.from, std::pow(10.0, first));
    ticks.to = std::max(ticks.to, std::pow(10.0, last));
  }
  const int stride = std::max(1, (last - first + wanted) / std::max(wanted, 1));
  const bool few = last - first <= 2;
  for (int decade = first; decade <= last; ++decade) {
    for (int mantissa = 1; mantissa < 10; ++mantissa) {
      const double value = mantissa * std::pow(10.0, decade);
      if (value < ticks.from * (1 - 1e-9) || value > ticks.to * (1 + 1e-9)) continue;
      const bool labelled =
          mantissa == 1 ? (decade - first) % stride == 0 : few && (mantissa == 2 || mantissa == 5);
      const double inside = std::clamp(value, ticks.from, ticks.to);
      if (labelled) {
        ticks.values.push_back(inside);
        ticks.labels.push_back(decade_label(value));
      } else if (stride == 1 || mantissa == 1) {
        ticks.minor.push_back(inside);
      }
    }
  }
  return ticks;
}

}  // namespace

Ticks make_ticks(PlotScale scale, double from, double to, int wanted, bool round_outwards) {
  wanted = std::clamp(wanted, 2, 50);
  return scale == PlotScale::linear ? linear_ticks(from, to, wanted, round_outwards)
                                    : logarithmic_ticks(from, to, wanted, round_outwards);
}

std::string power_of_ten(int exponent) {
  constexpr std::string_view digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = "10";
  for (const char c : std::to_string(exponent)) text += c == '-' ? "⁻" : digits[c - '0'];
  return text;
}

double nice_length(double length) {
  const double decade = std::pow(10.0, std::floor(std::log10(length)));
  for (const double factor : {10.0, 5.0, 2.0})
    if (factor * decade <= length * (1 + 1e-9)) return factor * decade;
  return decade;
}

std::string short_number(double value, int digits) {
  if (!std::isfinite(value)) return std::isnan(value) ? "–" : value > 0 ? "∞" : std::string(minus_sign) + "∞";
  return with_true_minus(fmt::format("{:.{}g}", value == 0 ? 0.0 : value, digits));
}

}  // namespace petzval
