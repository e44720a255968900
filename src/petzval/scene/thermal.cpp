// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/colour/illuminants.h>
#include <petzval/scene/thermal.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

bool is_temperature(double kelvin) {
  return kelvin > 0 && std::isfinite(kelvin);
}

/// \throws InputError at the first value that is not `right`, naming its place.
template <typename Right>
void check_values(std::span<const float> values, int columns, const char* what, const char* wanted,
                  const Right& right) {
  const auto bad = std::find_if_not(values.begin(), values.end(), right);
  if (bad == values.end()) return;
  const std::ptrdiff_t at = bad - values.begin();
  throw InputError(fmt::format("{} {} at row {}, column {}; {} would be right", what, *bad, at / columns,
                               at % columns, wanted));
}

}  // namespace

void ThermalOptions::validate() const {
  if (!(emissivity >= 0 && emissivity <= 1))
    throw InputError(fmt::format("an emissivity of {}; 0 to 1 would be right", emissivity));
  for (const std::optional<double>& kelvin : {temperature_k, background_k})
    if (kelvin && !is_temperature(*kelvin))
      throw InputError(fmt::format("a temperature of {} K; a positive one would be right", *kelvin));
}

double thermal_radiance(double wavelength_nm, double temperature_k, double emissivity,
                        std::optional<double> background_k) {
  const double own = emissivity * blackbody_radiance(wavelength_nm, temperature_k);
  return background_k ? own + (1 - emissivity) * blackbody_radiance(wavelength_nm, *background_k) : own;
}

void warm_emissivities(Scene& scene, const ThermalOptions& options) {
  options.validate();
  if (!options.temperature_k) throw InputError("emissivities need a temperature to shine");
  for (int index = 0; index < scene.bands(); ++index) {
    const double nm = scene.wavelengths_nm()[static_cast<std::size_t>(index)];
    const std::span<float> band = scene.band(index);
    check_values(band, scene.columns(), "an emissivity of", "0 to 1",
                 [](float e) { return e >= 0 && e <= 1; });
    const double own = blackbody_radiance(nm, *options.temperature_k);
    const double mirrored = options.background_k ? blackbody_radiance(nm, *options.background_k) : 0;
    for (float& value : band) value = static_cast<float>(value * own + (1 - double{value}) * mirrored);
    scene.release_memory();
  }
}

void warm_temperatures(Scene& scene, std::span<const float> temperatures_k, const ThermalOptions& options) {
  options.validate();
  check_values(temperatures_k, scene.columns(), "a temperature of", "kelvins above 0",
               [](float kelvin) { return is_temperature(kelvin); });
  // Air is liquid below; it is what degrees Celsius look like when they are taken for kelvins.
  constexpr float coldest_scene_k = 100;
  const float warmest = *std::max_element(temperatures_k.begin(), temperatures_k.end());
  if (warmest < coldest_scene_k)
    scene.notes.push_back(
        fmt::format("the warmest sample has {:g} K: temperatures are wanted in kelvins, which are degrees "
                    "Celsius + 273.15",
                    warmest));
  parallel_for(static_cast<std::size_t>(scene.bands()), [&](std::size_t index) {
    const std::span<float> band = scene.band(static_cast<int>(index));
    const double nm = scene.wavelengths_nm()[index];
    for (std::size_t i = 0; i < band.size(); ++i)
      band[i] = static_cast<float>(
          thermal_radiance(nm, temperatures_k[i], options.emissivity, options.background_k));
    scene.release_memory();
  });
}

}  // namespace petzval
