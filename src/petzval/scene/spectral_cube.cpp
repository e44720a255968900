// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/wavelength.h>
#include <petzval/colour/band_light.h>
#include <petzval/scene/illuminant_swap.h>
#include <petzval/scene/radiance_unit.h>
#include <petzval/scene/scene_light.h>
#include <petzval/scene/spectral_cube.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr double reflectance_luminance_cd_m2 = 100;  // as of charts
/// Measured reflectances exceed 1 by noise, by a reference that is not quite white, by glints.
constexpr float usual_overshoot = 1.2F;
/// Nothing in a scene is twice as bright as a perfect white, but per cent and counts are.
constexpr float most_reflectance = 2;

SceneQuantity quantity_of(const SpectralCube& cube, const CubeOptions& options) {
  if (options.quantity) return *options.quantity;
  if (cube.quantity) return *cube.quantity;
  throw InputError(
      "does not say what its numbers are; `scene.quantity` radiance, reflectance, emissivity or temperature "
      "does");
}

double angle_of(const SpectralCube& cube, const CubeOptions& options) {
  constexpr double any_angle_deg = 90;
  if (cube.panorama) return any_angle_deg;  // until the scene becomes one
  if (options.horizontal_angle_deg) return *options.horizontal_angle_deg;
  if (cube.horizontal_angle_deg) return *cube.horizontal_angle_deg;
  throw InputError("does not say how wide the scene is; `scene.horizontal_angle_deg` DEGREES does");
}

std::vector<double> bands_of(const SpectralCube& cube, const CubeOptions& options, SceneQuantity quantity) {
  if (quantity == SceneQuantity::temperature) {
    if (cube.bands != 1)
      throw InputError(fmt::format("is a map of temperatures with {} bands; one would be right", cube.bands));
    if (options.wavelengths_nm.empty())
      throw InputError(
          "is a map of temperatures; `wavelengths_nm` 8000:500:14000 or the like says where it shines");
    return options.wavelengths_nm;
  }
  const std::vector<double>& bands =
      options.file_bands_nm.empty() ? cube.wavelengths_nm : options.file_bands_nm;
  if (bands.empty())
    throw InputError(
        fmt::format("does not say the wavelengths of its {} bands; `scene.file_bands_nm` 400:10:700 or the "
                    "like does",
                    cube.bands));
  if (bands.size() != static_cast<std::size_t>(cube.bands))
    throw InputError(fmt::format("has {} bands, but {} wavelengths are given", cube.bands, bands.size()));
  for (const double nm : bands) require_wavelength(nm, "bands");
  return bands;
}

const std::string& radiance_unit_of(const SpectralCube& cube, const CubeOptions& options) {
  return options.radiance_unit.empty() ? cube.radiance_unit : options.radiance_unit;
}

/// What quantities of this kind need beside their numbers, and what they cannot have.
void check_light(const CubeOptions& options, SceneQuantity quantity, const std::vector<double>& bands) {
  const std::optional<Spectrum>& light = options.illuminant;
  if (quantity == SceneQuantity::reflectance) {
    if (!light)
      throw InputError(
          "holds reflectances; they need light to be a scene: `scene.illuminant` D65, for example");
    if (std::ranges::none_of(band_light(*light, bands), [](double value) { return value > 0; }))
      throw InputError("the illuminant has no light in the bands of the scene");
  } else if (quantity != SceneQuantity::radiance) {
    if (light) throw InputError("shines of its own warmth; `scene.illuminant` is for surfaces that are lit");
    options.thermal.validate();
    if (quantity == SceneQuantity::temperature && options.thermal.temperature_k)
      throw InputError("is a map of temperatures; `scene.temperature_k` is for emissivities");
    if (quantity == SceneQuantity::emissivity && options.thermal.emissivity != 1)
      throw InputError("holds emissivities; `scene.emissivity` is for maps of temperatures");
    if (quantity == SceneQuantity::emissivity && !options.thermal.temperature_k)
      throw InputError(
          "holds emissivities; they need a temperature to shine: `scene.temperature_k` 310, in kelvins, for "
          "example");
  }
}

/// \param greatest  of all reflectances. \param scale  what the user has multiplied them by.
void check_reflectances(Scene& scene, float greatest, double scale) {
  if (greatest > most_reflectance) {
    // A hundredth for per cent; for counts to 1,000, 10,000 … the power of ten that makes shares of them.
    const double tens = std::max(2.0, std::ceil(std::log10(double{greatest / usual_overshoot})));
    throw InputError(fmt::format(
        "holds reflectances up to {:.4g}, where a perfect white has 1; `scene.scale` {:.3g} would "
        "be right for {}",
        greatest, scale * std::pow(10, -tens), tens == 2 ? "per cent" : "counts"));
  }
  if (greatest > usual_overshoot)
    scene.notes.push_back(fmt::format(
        "holds reflectances up to {:.4g}, where a perfect white has 1: are they per cent, or counts? "
        "(`scene.scale` multiplies them)",
        greatest));
}

/// Reflectance × illuminant.
void put_under(Scene& scene, const CubeOptions& options) {
  const Spectrum& illuminant = *options.illuminant;
  const std::vector<double> light = band_light(illuminant, scene.wavelengths_nm());
  float greatest = 0;
  scene.for_each_band([&](std::size_t index, std::span<float> band) {
    const double factor = light[index];
    for (float& value : band) {
      greatest = std::max(greatest, value);
      value = static_cast<float>(value * factor);
    }
  });
  check_reflectances(scene, greatest, options.scale);
  scene.illuminant = illuminant;
  if (options.level_follows) return;
  if (!is_visible(illuminant)) return scene.scale(invisible_level(illuminant, scene));
  if (scene.mean_luminance_cd_m2() > 0) {
    scene.set_mean_luminance_cd_m2(reflectance_luminance_cd_m2);
    scene.notes.push_back(
        fmt::format("reflectances have no level of light: the scene is lit to a mean luminance of {:g} cd/m2 "
                    "(`scene.mean_luminance_cd_m2` sets another)",
                    reflectance_luminance_cd_m2));
  }
}

double scale_of(const SpectralCube& cube, const CubeOptions& options) {
  const double scale = cube.scale * options.scale;
  if (!(scale > 0 && std::isfinite(scale)))
    throw InputError(fmt::format("a scale of {}; a positive one would be right", scale));
  return scale;
}

void scale(SpectralCube& cube, const CubeOptions& options) {
  const double scale = scale_of(cube, options);
  if (scale == 1 && !options.negative_is_zero) return;
  for (std::size_t index = 0; index < static_cast<std::size_t>(cube.bands); ++index) {
    if (scale != 1)
      for (float& value : cube.plane(index)) value = static_cast<float>(value * scale);
    if (options.negative_is_zero)
      for (float& value : cube.plane(index)) value = value < 0 ? 0.0f : value;  // NaN stays, to be refused
    cube.values.release_memory();
  }
}

}  // namespace

SceneQuantity parse_scene_quantity(const std::string& word) {
  if (word == "radiance") return SceneQuantity::radiance;
  if (word == "reflectance") return SceneQuantity::reflectance;
  if (word == "emissivity") return SceneQuantity::emissivity;
  if (word == "temperature") return SceneQuantity::temperature;
  throw InputError(fmt::format(
      "a quantity '{}'; radiance, reflectance, emissivity or temperature would be right", quotable(word)));
}

void check_cube(const SpectralCube& cube, const CubeOptions& options) {
  const SceneQuantity quantity = quantity_of(cube, options);
  const std::vector<double> bands = bands_of(cube, options, quantity);
  angle_of(cube, options);
  scale_of(cube, options);
  check_light(options, quantity, bands);
  if (const std::string& unit = radiance_unit_of(cube, options);
      quantity == SceneQuantity::radiance && !unit.empty())
    radiance_scale(unit);
}

Scene scene_of(SpectralCube cube, const CubeOptions& options) {
  check_cube(cube, options);
  const SceneQuantity quantity = quantity_of(cube, options);
  std::vector<double> bands = bands_of(cube, options, quantity);
  const double angle = angle_of(cube, options);
  scale(cube, options);
  Scene scene =
      quantity == SceneQuantity::temperature
          ? Scene(cube.columns, cube.rows, std::move(bands), angle, cube.distance_m)
          : Scene(cube.columns, cube.rows, std::move(bands), angle, cube.distance_m, std::move(cube.values));
  scene.name = cube.name;
  scene.notes = std::move(cube.notes);
  scene.illuminant = cube.illuminant;
  scene.depth_m = std::move(cube.depth_m);
  scene.depth_from = cube.depth_from;
  if (cube.panorama) scene.make_panorama(*cube.panorama);
  if (quantity == SceneQuantity::temperature) {
    warm_temperatures(scene, cube.values.all(), options.thermal);
    return scene;
  }
  scene.validate();
  const std::string& unit = radiance_unit_of(cube, options);
  const double factor = quantity == SceneQuantity::radiance && !unit.empty() ? radiance_scale(unit) : 1;
  if (quantity == SceneQuantity::radiance && unit.empty())
    scene.notes.emplace_back(
        "does not say the unit of its radiance: W.m^-2.sr^-1.nm^-1 is taken (`scene.radiance_unit` sets "
        "another)");
  if (factor != 1)
    scene.for_each_band([factor](std::size_t, std::span<float> band) {
      for (float& value : band) value = static_cast<float>(value * factor);
    });
  if (quantity == SceneQuantity::reflectance) put_under(scene, options);
  if (quantity == SceneQuantity::radiance && options.illuminant) swap_illuminant(scene, *options.illuminant);
  if (quantity == SceneQuantity::emissivity) warm_emissivities(scene, options.thermal);
  return scene;
}

}  // namespace petzval
