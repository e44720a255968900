// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/colour/band_light.h>
#include <petzval/colour/observer.h>
#include <petzval/scene/scene_light.h>
#include <petzval/scene/wavelength_list.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace petzval {

namespace {

constexpr const char* usual_level =
    "no eye sees the illuminant: 1 W/m2 falls on the scene (`scene.irradiance_w_m2` 5W/m2 sets another)";

double power(const Spectrum& light) {
  return light.integral(light.front_nm(), light.back_nm());
}

const Spectrum& illuminant_of(const Scene& scene, const char* parameter) {
  if (scene.illuminant) return *scene.illuminant;
  throw InputError(scene.name,
                   fmt::format("does not say which light falls on it, so `{}` cannot set its strength; "
                               "`scene.mean_luminance_cd_m2` or `scene.scale` would be right",
                               parameter));
}

void check_positive(double value, const char* parameter) {
  if (!(value > 0 && std::isfinite(value)))
    throw InputError(fmt::format("`{}` {}: a number above 0 would be right", parameter, value));
}

}  // namespace

bool is_visible(const Spectrum& light) {
  constexpr double least_lm_per_w = 0.1;
  const double sum = power(light), seen = luminance(light);
  return sum > 0 ? seen >= least_lm_per_w * sum : seen > 0;
}

std::vector<double> light_in_bands(const Spectrum& illuminant, const std::string& name,
                                   const std::vector<double>& bands_nm, std::optional<double> width_nm) {
  std::vector<double> light = band_light(illuminant, bands_nm, width_nm);
  if (std::ranges::none_of(light, [](double value) { return value > 0; }))
    throw InputError(
        fmt::format("illuminant {} has no light at the scene's wavelengths; it reaches from {:g} to {:g} nm",
                    name, illuminant.front_nm(), illuminant.back_nm()));
  return light;
}

double invisible_level(const Spectrum& illuminant, Scene& scene) {
  const double sum = power(illuminant);
  if (!(sum > 0)) throw InputError("the illuminant has no light");
  scene.notes.emplace_back(usual_level);
  return 1 / (std::numbers::pi * sum);
}

void set_illuminance_lx(Scene& scene, double illuminance_lx) {
  constexpr const char* parameter = "scene.illuminance_lx";
  check_positive(illuminance_lx, parameter);
  const double now = std::numbers::pi * luminance(illuminant_of(scene, parameter));
  if (!is_visible(*scene.illuminant))
    throw InputError(scene.name,
                     "is lit by light that no eye sees, which has no lux; `scene.irradiance_w_m2` 5W/m2 "
                     "would be right");
  scene.scale(illuminance_lx / now);
}

void set_irradiance_w_m2(Scene& scene, double irradiance_w_m2) {
  constexpr const char* parameter = "scene.irradiance_w_m2";
  check_positive(irradiance_w_m2, parameter);
  const double now = std::numbers::pi * power(illuminant_of(scene, parameter));
  if (!(now > 0)) throw InputError(scene.name, "is lit by a spectrum without width, which has no W/m2");
  scene.scale(irradiance_w_m2 / now);
  std::erase(scene.notes, usual_level);
}

void widen_bands(Scene& scene, const std::optional<Spectrum>& light, std::optional<double> width_nm) {
  if (width_nm) {
    const std::vector<double> factors =
        band_light(Spectrum({1, 1e6}, {1, 1}), scene.wavelengths_nm(), width_nm);
    scene.scale_bands(factors);
    if (!scene.illuminant) return;
    std::vector<double> white;
    for (std::size_t i = 0; i < factors.size(); ++i)
      white.push_back(factors[i] * scene.illuminant->at(scene.wavelengths_nm()[i]));
    scene.illuminant = Spectrum(scene.wavelengths_nm(), white);
  } else if (scene.bands() == 1 && light && is_narrow(*light)) {
    const double at_band = light->at(scene.wavelengths_nm()[0]);
    if (at_band > 0) scene.scale(band_light(*light, scene.wavelengths_nm())[0] / at_band);
  }
}

void settle_illuminant(Scene& scene, std::optional<double> width_nm) {
  if (!scene.illuminant) return;
  const std::vector<double>& bands = scene.wavelengths_nm();
  const Spectrum settled(bands, band_light(*scene.illuminant, bands, width_nm));
  const std::string dark = runs_of_bands(bands, [&](double nm) { return settled.at(nm) == 0; });
  if (!dark.empty() && !is_narrow(*scene.illuminant))
    scene.notes.push_back(fmt::format(
        "no light reaches {} nm, beyond the illuminant of the scene: these bands are dark", dark));
  scene.illuminant = settled;
}

void note_unknown_width(Scene& scene, const std::optional<Spectrum>& light) {
  if (scene.bands() != 1 || (light && is_narrow(*light))) return;
  scene.notes.push_back(
      fmt::format("the band at {0:g} nm stands for 1 nm of broad light; `scene.band_width_nm` 20 makes it 20 "
                  "nm, a narrow illuminant ({0:g}nm/30) falls into it wholly, and more bands share out all "
                  "of the light",
                  scene.wavelengths_nm().front()));
}

}  // namespace petzval
