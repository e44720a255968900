// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/wavelength.h>
#include <petzval/colour/illuminants.h>
#include <petzval/colour/observer.h>
#include <petzval/colour/spectra_files.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string_view>

namespace petzval {

namespace {

constexpr double reference_nm = 560;
constexpr double shortest_visible_nm = 360, longest_visible_nm = 830;
/// At the usual temperatures less than 1e-4 of a black body's light lies beyond.
constexpr double shortest_thermal_nm = 200, longest_thermal_nm = 30000;
/// Half the width of a line [nm]: narrower than a laser drifts in a degree.
constexpr double line_half_width_nm = 0.01;
constexpr const char* led_set = "cie_leds";

/// The whole of `text` as a positive number.
std::optional<double> positive_number(std::string_view text) {
  double value = 0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  if (error != std::errc{} || end != text.data() + text.size() || !(value > 0) || std::isinf(value))
    return {};
  return value;
}

/// Chromaticity of daylight (CIE 15): the locus x_D(T), y_D(x_D).
Chromaticity daylight_chromaticity(double temperature_k) {
  const double t = 1e3 / temperature_k;
  const double x = temperature_k <= 7000 ? ((-4.6070 * t + 2.9678) * t + 0.09911) * t + 0.244063
                                         : ((-2.0064 * t + 1.9018) * t + 0.24748) * t + 0.237040;
  return {x, (-3.000 * x + 2.870) * x - 0.275};
}

Spectrum normalised(const Spectrum& spectrum) {
  return spectrum.scaled(100.0 / spectrum.at(reference_nm));
}

/// Every 5 nm as far as glass and silicon go, then in steps of 2 %.
Spectrum sampled_blackbody(double temperature_k) {
  constexpr double fine_to_nm = 2500, step_nm = 5, ratio = 1.02;
  std::vector<double> wavelengths;
  for (double nm = shortest_thermal_nm; nm <= fine_to_nm; nm += step_nm) wavelengths.push_back(nm);
  for (double nm = fine_to_nm * ratio; nm < longest_thermal_nm; nm *= ratio) wavelengths.push_back(nm);
  wavelengths.push_back(longest_thermal_nm);
  const Spectrum result = blackbody(temperature_k, wavelengths);
  return result.at(reference_nm) > 0 ? normalised(result) : result;
}

Spectrum line(double nm) {
  return Spectrum({nm - line_half_width_nm, nm, nm + line_half_width_nm}, {0, 1 / line_half_width_nm, 0});
}

/// Gaussian over three widths at half maximum on both sides, as far as no wavelength falls below 1 nm.
Spectrum led(double nm, double width_nm) {
  constexpr int samples = 60;
  constexpr double reach = 3;
  std::vector<double> wavelengths, values;
  for (int i = -samples; i <= samples; ++i) {
    const double widths = reach * i / samples, at = nm + widths * width_nm;
    if (at < 1) continue;
    wavelengths.push_back(at);
    values.push_back(std::exp(-4 * std::log(2.0) * widths * widths));
  }
  return Spectrum(std::move(wavelengths), std::move(values));
}

/// "850nm" and "850nm/30".
std::optional<Spectrum> single_colour(std::string_view text) {
  const std::size_t unit = text.find("nm");
  if (unit == text.npos) return {};
  const std::optional<double> nm = positive_number(text.substr(0, unit));
  const std::string_view rest = text.substr(unit + 2);
  if (!nm || (!rest.empty() && !rest.starts_with('/'))) return {};
  require_wavelength(*nm, fmt::format("illuminant {}", text));
  if (rest.empty()) return line(*nm);
  const std::optional<double> width_nm = positive_number(rest.substr(1));
  if (!width_nm || *width_nm > *nm)
    throw InputError(
        fmt::format("illuminant {}: the wavelength of a line (850nm), or of an LED with its width at half "
                    "maximum (850nm/30) would be right",
                    text));
  return led(*nm, *width_nm);
}

/// CIE 15 rounds the shares of the components so; only then are its tables met digit by digit.
double rounded_to_thousandths(double value) {
  return std::round(1000 * value) / 1000;
}

/// "D55", "D7500": the nominal temperature.
Spectrum nominal_daylight(double number) {
  const double nominal_k = number < 1000 ? 100 * number : number;
  return daylight(nominal_k * 1.4388 / 1.4380);
}

}  // namespace

std::vector<std::string> illuminant_names() {
  std::vector<std::string> names{"A", "D50", "D65", "E", "F11", "LED-850", "LED-940"};
  for (const NamedSpectrum& each : read_spectrum_set(led_set).spectra) names.push_back(each.name);
  return names;
}

Spectrum daylight(double temperature_k) {
  if (!(temperature_k >= 4000 && temperature_k <= 25000))
    throw InputError(fmt::format("daylight of {} K; it is defined from 4000 to 25000 K", temperature_k));
  const auto [x, y] = daylight_chromaticity(temperature_k);
  const double m = 0.0241 + 0.2562 * x - 0.7341 * y;
  const double m1 = rounded_to_thousandths((-1.3515 - 1.7703 * x + 5.9114 * y) / m);
  const double m2 = rounded_to_thousandths((0.0300 - 31.4424 * x + 30.0717 * y) / m);
  const SpectrumSet basis = read_spectrum_set("daylight_basis");
  const Spectrum &s0 = basis.find("s0"), &s1 = basis.find("s1"), &s2 = basis.find("s2");
  std::vector<double> values = s0.values();
  for (std::size_t i = 0; i < values.size(); ++i) values[i] += m1 * s1.values()[i] + m2 * s2.values()[i];
  return Spectrum(s0.wavelengths_nm(), std::move(values));
}

double blackbody_radiance(double wavelength_nm, double temperature_k) {
  constexpr double h = 6.62607015e-34, c = 299792458.0, k = 1.380649e-23;
  constexpr double per_nm = 1e-9;
  const double lambda_m = wavelength_nm * 1e-9;
  const double per_m =
      2 * h * c * c / (std::pow(lambda_m, 5) * std::expm1(h * c / (lambda_m * k * temperature_k)));
  return per_m * per_nm;
}

Spectrum blackbody(double temperature_k, std::span<const double> wavelengths_nm) {
  if (!(temperature_k > 0) || std::isinf(temperature_k))
    throw InputError(fmt::format("a black body of {} K; its temperature must be positive", temperature_k));
  std::vector<double> values;
  for (const double nm : wavelengths_nm) values.push_back(blackbody_radiance(nm, temperature_k));
  return Spectrum({wavelengths_nm.begin(), wavelengths_nm.end()}, std::move(values));
}

Spectrum illuminant(const std::string& name) {
  if (name == "A") return read_spectrum_set("illuminant_a").spectra[0].spectrum;
  if (name == "F11") return read_spectrum_set("illuminant_f11").spectra[0].spectrum;
  if (name == "E") return Spectrum({shortest_visible_nm, longest_visible_nm}, {1, 1});
  if (name == "LED-850") return led(850, 30);
  if (name == "LED-940") return led(940, 40);
  if (name.starts_with("LED-"))
    for (const NamedSpectrum& each : read_spectrum_set(led_set).spectra)
      if (each.name == name) return each.spectrum;
  if (const std::optional<Spectrum> found = single_colour(name)) return *found;
  const std::string_view text = name;
  if (text.starts_with('D'))
    if (const auto number = positive_number(text.substr(1))) return nominal_daylight(*number);
  if (text.ends_with('K'))
    if (const auto kelvins = positive_number(text.substr(0, text.size() - 1)))
      return sampled_blackbody(*kelvins);
  std::error_code ignored;
  if (std::filesystem::is_regular_file(name, ignored)) return read_spectrum_set(name).spectra[0].spectrum;
  throw InputError(
      fmt::format("no illuminant '{}'; known are {}, daylight such as D55, black bodies such as 3200K, "
                  "lines such as 532nm, LEDs such as 850nm/30, and files of spectra",
                  name, fmt::join(illuminant_names(), ", ")));
}

}  // namespace petzval
