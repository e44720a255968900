// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/colour/spectrum_text.h>
#include <petzval/image/formats/spectral_exr.h>
#include <petzval/scene/formats/name_file.h>
#include <petzval/scene/formats/scene_exr.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr const char* angle_attribute = "sceneAngle_deg";
constexpr const char* distance_attribute = "sceneDistance_m";
constexpr const char* name_attribute = "sceneName";
constexpr const char* illuminant_attribute = "sceneIlluminant";  // "400:0.12 410:0.13": nm, W·m⁻²·sr⁻¹·nm⁻¹
constexpr const char* radiance_units_elsewhere = "W.m^-2.sr^-1";
constexpr double reflectance_luminance_cd_m2 = 100;  // as of charts

/// \throws InputError naming the attribute.
Spectrum spectrum_of(const std::string& text, const std::string& path) {
  try {
    return parse_spectrum_text(text);
  } catch (const InputError& error) {
    throw InputError(path, fmt::format("the attribute {}: {}", illuminant_attribute, error.what()));
  }
}

/// An attribute that is one number, if it is there.
std::optional<double> number(const SpectralExr& exr, const char* attribute) {
  const auto found = exr.numbers.find(attribute);
  return found == exr.numbers.end() ? std::nullopt : std::optional(found->second);
}

void check_units(const SpectralExr& exr, const std::string& path) {
  if (exr.kind == SpectralExr::Kind::emissive && !exr.units.empty() && exr.units != spectral_radiance_units &&
      exr.units != radiance_units_elsewhere)
    throw InputError(path, fmt::format("its values are in {}; a scene is radiance [{}]", exr.units,
                                       spectral_radiance_units));
}

/// What each band's values are multiplied with to become radiance.
std::vector<double> light(const SpectralExr& exr, const SceneExrOptions& options, const std::string& path) {
  if (exr.kind == SpectralExr::Kind::emissive) {
    if (options.illuminant)
      throw InputError(path,
                       "holds radiance, the light is in it; --illuminant is for charts and reflectances");
    return std::vector<double>(exr.wavelengths_nm.size(), 1.0);
  }
  if (!options.illuminant)
    throw InputError(path,
                     "holds reflectances; they need light to be a scene: --illuminant D65, for example");
  std::vector<double> factors;
  for (double nm : exr.wavelengths_nm) factors.push_back(options.illuminant->at(nm));
  return factors;
}

Scene scene_of(const SpectralExr& exr, const SceneExrOptions& options, const std::string& path) {
  check_units(exr, path);
  const std::vector<double> factors = light(exr, options, path);
  const std::optional<double> stored_angle = number(exr, angle_attribute);
  if (!stored_angle && !options.horizontal_angle_deg)
    throw InputError(
        path, fmt::format("does not say how wide the scene is (attribute {}); --scene-angle DEGREES does",
                          angle_attribute));
  Scene scene(exr.width, exr.height, exr.wavelengths_nm,
              stored_angle ? *stored_angle : *options.horizontal_angle_deg, number(exr, distance_attribute));
  for (std::size_t band = 0; band < factors.size(); ++band) {
    const std::span<const float> from = exr.plane(band);
    std::transform(from.begin(), from.end(), scene.band(static_cast<int>(band)).begin(),
                   [&](float value) { return static_cast<float>(value * factors[band]); });
  }
  if (const auto name = exr.strings.find(name_attribute); name != exr.strings.end())
    scene.name = name->second;
  if (const auto text = exr.strings.find(illuminant_attribute); text != exr.strings.end())
    scene.illuminant = spectrum_of(text->second, path);
  scene.validate();
  if (exr.kind == SpectralExr::Kind::reflective) {
    scene.illuminant = options.illuminant;
    scene.set_mean_luminance_cd_m2(reflectance_luminance_cd_m2);
  }
  return scene;
}

}  // namespace

Scene read_scene_exr(const std::string& path, const SceneExrOptions& options) {
  const SpectralExr exr = read_spectral_exr(path);
  return naming_file(path, [&] { return scene_of(exr, options, path); });
}

void write_scene_exr(const std::string& path, const Scene& scene) {
  SpectralExr exr;
  exr.width = scene.columns();
  exr.height = scene.rows();
  exr.wavelengths_nm = scene.wavelengths_nm();
  exr.units = spectral_radiance_units;
  exr.numbers[angle_attribute] = scene.horizontal_angle_deg();
  if (scene.distance_m()) exr.numbers[distance_attribute] = *scene.distance_m();
  if (!scene.name.empty()) exr.strings[name_attribute] = scene.name;
  if (scene.illuminant) exr.strings[illuminant_attribute] = spectrum_text(*scene.illuminant);
  write_spectral_exr(path, exr, scene.values());
}

}  // namespace petzval
