// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>
#include <petzval/colour/spectrum_text.h>
#include <petzval/image/formats/spectral_exr.h>
#include <petzval/scene/depth_map.h>
#include <petzval/scene/formats/name_file.h>
#include <petzval/scene/formats/scene_exr.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr const char* angle_attribute = "sceneAngle_deg";
constexpr const char* distance_attribute = "sceneDistance_m";
constexpr const char* projection_attribute = "sceneProjection";
constexpr const char* equirectangular = "equirectangular";
constexpr const char* yaw_attribute = "sceneYaw_deg";
constexpr const char* pitch_attribute = "scenePitch_deg";
constexpr const char* name_attribute = "sceneName";
constexpr const char* depth_from_attribute = "sceneDepthFrom";
constexpr const char* illuminant_attribute = "sceneIlluminant";  // "400:0.12 410:0.13": nm, W·m⁻²·sr⁻¹·nm⁻¹
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

/// All but values and depth.
SpectralCube described_by(const SpectralExr& exr, const std::string& path) {
  SpectralCube cube;
  cube.columns = exr.width, cube.rows = exr.height;
  cube.bands = static_cast<int>(exr.wavelengths_nm.size());
  cube.wavelengths_nm = exr.wavelengths_nm;
  const bool light = exr.kind == SpectralExr::Kind::emissive;
  cube.quantity = light ? SceneQuantity::radiance : SceneQuantity::reflectance;
  if (light) cube.radiance_unit = exr.units;
  if (exr.also_reflective)
    cube.notes.emplace_back(
        "has light (S0 channels) and reflectances (T channels): the light is taken, the reflectances are "
        "left "
        "aside");
  if (const auto text = exr.strings.find(depth_from_attribute); text != exr.strings.end())
    cube.depth_from = naming_file(path, [&] { return parse_depth_from(text->second); });
  cube.horizontal_angle_deg = number(exr, angle_attribute);
  cube.distance_m = number(exr, distance_attribute);
  if (const auto name = exr.strings.find(name_attribute); name != exr.strings.end()) cube.name = name->second;
  if (const auto text = exr.strings.find(illuminant_attribute); text != exr.strings.end())
    cube.illuminant = spectrum_of(text->second, path);
  if (const auto text = exr.strings.find(projection_attribute); text != exr.strings.end()) {
    if (text->second != equirectangular)
      throw InputError(
          path, fmt::format("has the projection '{}'; {} is known", quotable(text->second), equirectangular));
    cube.panorama.emplace(
        PanoramaView{number(exr, yaw_attribute).value_or(0), number(exr, pitch_attribute).value_or(0)});
  }
  return cube;
}

}  // namespace

SpectralCube read_scene_exr(const std::string& path, const CubeCheck& check) {
  SpectralCube cube;
  SpectralExr exr = read_spectral_exr(path, [&](const SpectralExr& header) {
    cube = described_by(header, path);
    if (check) check(cube);
  });
  cube.values = std::move(exr.values);
  cube.depth_m = std::move(exr.depth);
  return cube;
}

void write_scene_exr(const std::string& path, const Scene& scene) {
  SpectralExr exr;
  exr.width = scene.columns();
  exr.height = scene.rows();
  exr.wavelengths_nm = scene.wavelengths_nm();
  exr.units = spectral_radiance_units;
  exr.numbers[angle_attribute] = scene.horizontal_angle_deg();
  if (scene.is_panorama()) {
    exr.strings[projection_attribute] = equirectangular;
    exr.numbers[yaw_attribute] = scene.view().yaw_deg;
    exr.numbers[pitch_attribute] = scene.view().pitch_deg;
  }
  if (scene.distance_m()) exr.numbers[distance_attribute] = *scene.distance_m();
  if (!scene.name.empty()) exr.strings[name_attribute] = scene.name;
  if (scene.illuminant) exr.strings[illuminant_attribute] = spectrum_text(*scene.illuminant);
  if (!scene.depth_m.empty()) {
    exr.depth = scene.depth_m;
    exr.strings[depth_from_attribute] = depth_from_word(scene.depth_from);
  }
  write_spectral_exr(path, exr, scene.values(), [&] { scene.release_memory(); });
}

}  // namespace petzval
