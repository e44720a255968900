// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/wavelength.h>
#include <petzval/base/whole_file.h>
#include <petzval/colour/illuminants.h>
#include <petzval/colour/observer.h>
#include <petzval/colour/rgb_to_spectrum.h>
#include <petzval/colour/spectra_files.h>
#include <petzval/glass/catalogue.h>
#include <petzval/render/pbrt/parameter_reader.h>
#include <petzval/render/spectra/named_spectra.h>

#include <map>

namespace petzval::render {

namespace {

/// pbrt's names of glasses, as the makers' catalogues have them.
const std::map<std::string, std::string> pbrt_glasses{
    {"glass-BK7", "SCHOTT:N-BK7"},     {"glass-BAF10", "SCHOTT:N-BAF10"}, {"glass-FK51A", "SCHOTT:N-FK51A"},
    {"glass-LASF9", "SCHOTT:N-LASF9"}, {"glass-SF5", "SCHOTT:N-SF5"},     {"glass-SF10", "SCHOTT:N-SF10"},
    {"glass-SF11", "SCHOTT:N-SF11"}};

/// A lamp emits nothing outside its table; a surface carries on as at its ends.
SceneSpectrum tabulated(const Spectrum& spectrum, SpectrumRole role) {
  SceneSpectrum result;
  if (role == SpectrumRole::illuminant)
    result.at = [spectrum](double nm) { return spectrum.at(nm); };
  else
    result.at = [spectrum](double nm) { return spectrum.at_extended(nm); };
  result.photometric = Observer::cie_1931().xyz(spectrum).y;
  return result;
}

/// Diamond after F. Peter, Z. Phys. 15 (1923) 358.
double diamond_index(double nm) {
  const double l2 = nm * nm * 1e-6;
  return std::sqrt(1 + 0.3306 * l2 / (l2 - 0.175 * 0.175) + 4.3356 * l2 / (l2 - 0.106 * 0.106));
}

/// "metal-Au-eta" → the column of data/spectra/metals.csv.
std::optional<SceneSpectrum> metal(const std::string& name) {
  if (!name.starts_with("metal-")) return {};
  const SpectrumSet metals = read_spectrum_set("metals");
  for (const NamedSpectrum& each : metals.spectra)
    if ("metal-" + each.name == name) return tabulated(each.spectrum, SpectrumRole::unbounded);
  return {};
}

std::optional<SceneSpectrum> glass(const std::string& name) {
  const auto found = pbrt_glasses.find(name);
  const std::string full = found != pbrt_glasses.end() ? found->second : name;
  if (full.find(':') == std::string::npos) return {};
  const std::shared_ptr<const Glass> glass = GlassCatalogue::bundled().find(full);
  return SceneSpectrum{[glass](double nm) { return glass->index(nm); }};
}

std::optional<SceneSpectrum> named(const std::string& name) {
  if (const auto found = metal(name)) return found;
  if (name == "diamond" || name == "glass-diamond") return SceneSpectrum{diamond_index};
  if (const auto found = glass(name)) return found;
  constexpr std::string_view standard = "stdillum-";
  if (name.starts_with(standard)) {
    const std::string which = name.substr(standard.size());
    for (const std::string& known : illuminant_names())
      if (which == known || (which.starts_with("D") && which.size() == 3))
        return tabulated(illuminant(which), SpectrumRole::illuminant);
  }
  return {};
}

/// Pairs of wavelength and value, in nm.
SceneSpectrum from_pairs(const Location& at, const std::vector<double>& numbers, SpectrumRole role) {
  std::vector<double> nm, values;
  for (std::size_t i = 0; i + 1 < numbers.size(); i += 2)
    nm.push_back(numbers[i]), values.push_back(numbers[i + 1]);
  if (numbers.size() % 2 != 0)
    throw scene_error(at, "a spectrum of an odd number of values; pairs of nm and value would be right");
  if (!nm.empty() && nm.back() < shortest_wavelength_nm)
    throw scene_error(at, "a spectrum of pairs of nm and value: " + wavelength_fault(nm.back()));
  try {
    return tabulated(Spectrum(nm, values), role);
  } catch (const InputError& error) {
    throw scene_error(at, error.what());
  }
}

SceneSpectrum from_file(const Location& at, const std::string& name, SpectrumRole role) {
  std::string text;
  try {
    text = read_whole_file(resolved_path(at, name), largest_text);
  } catch (const InputError& error) {
    throw scene_error(at, fmt::format("\"{}\" is neither a spectrum that Petzval knows nor a file: {}", name,
                                      error.what()));
  }
  std::vector<double> numbers;
  Tokens tokens(text, std::make_shared<const std::string>(resolved_path(at, name)));
  while (const std::optional<Token> token = tokens.next()) {
    const std::optional<double> number = parse_scene_number(token->text);
    if (!number) throw scene_error(tokens.location(*token), "a number would be right: pairs of nm and value");
    numbers.push_back(*number);
  }
  return from_pairs(at, numbers, role);
}

SceneSpectrum from_rgb(const Parameter& parameter, SpectrumRole role) {
  const auto& v = parameter.numbers;
  const double largest = v.size() == 3 ? std::max({v[0], v[1], v[2]}) : 0;
  if (v.size() != 3 || !(std::min({v[0], v[1], v[2]}) >= 0) || !std::isfinite(largest))
    throw scene_error(parameter.at,
                      fmt::format("\"rgb {}\" takes three numbers, none below 0", parameter.name));
  if (role == SpectrumRole::albedo) {
    if (largest > 1)
      throw scene_error(parameter.at, fmt::format("\"rgb {}\" is a reflectance; no part of it may exceed 1",
                                                  parameter.name));
    const SigmoidReflectance reflectance = reflectance_of({v[0], v[1], v[2]});
    return {[reflectance](double nm) { return reflectance.at(nm); }, v[0] == v[1] && v[1] == v[2]};
  }
  // Twice the colour at half brightness, where the sigmoid is far from its ends (pbrt-v4).
  const double scale = 2 * largest;
  const SigmoidReflectance shape =
      largest > 0 ? reflectance_of({v[0] / scale, v[1] / scale, v[2] / scale}) : SigmoidReflectance{};
  if (role == SpectrumRole::unbounded)
    return {[shape, scale](double nm) { return scale * shape.at(nm); }, v[0] == v[1] && v[1] == v[2]};
  const SceneSpectrum white = white_light();
  return {[shape, scale, white](double nm) { return scale * shape.at(nm) * white.at(nm); }, false,
          white.photometric};
}

SceneSpectrum from_blackbody(const Parameter& parameter) {
  const double kelvin = parameter.numbers.empty() ? 0 : parameter.numbers[0];
  if (parameter.numbers.size() != 1 || !(kelvin >= 100) || !(kelvin <= 1e6))
    throw scene_error(parameter.at, "\"blackbody\" takes one temperature, from 100 to 1000000 K");
  SceneSpectrum result{[kelvin](double nm) { return blackbody_radiance(nm, kelvin); }};
  std::vector<double> nm;
  for (double at = 360; at <= 830; at += 1) nm.push_back(at);
  result.photometric = Observer::cie_1931().xyz(blackbody(kelvin, nm)).y;
  return result;
}

}  // namespace

SceneSpectrum constant_spectrum(double value) {
  SceneSpectrum result{[value](double) { return value; }, true};
  result.photometric = value * Observer::cie_1931().xyz(Spectrum({360, 830}, {1, 1})).y;
  return result;
}

SceneSpectrum white_light() {
  const Spectrum light = illuminant("D65");
  return {[light](double nm) { return light.at_extended(nm); }, false, Observer::cie_1931().xyz(light).y};
}

std::optional<SceneSpectrum> spectrum_parameter(const Parameters& parameters, const std::string& name,
                                                SpectrumRole role, Unsupported& unsupported) {
  const Parameter* parameter = parameters.find(name, {"rgb", "color", "blackbody", "spectrum", "float"});
  if (!parameter) return {};
  if (parameter->type == "rgb" || parameter->type == "color") return from_rgb(*parameter, role);
  if (parameter->type == "blackbody") return from_blackbody(*parameter);
  if (parameter->type == "float") return constant_spectrum(parameters.number(name, 0));
  if (parameter->strings.empty()) return from_pairs(parameter->at, parameter->numbers, role);
  const std::string& text = parameter->strings[0];
  try {
    if (const auto found = named(text)) return found;
  } catch (const InputError& error) {
    throw scene_error(parameter->at, error.what());
  }
  if (text.find('.') != std::string::npos) return from_file(parameter->at, text, role);
  unsupported.report(parameter->at, fmt::format("the spectrum \"{}\"", text));
  return constant_spectrum(1);
}

}  // namespace petzval::render
