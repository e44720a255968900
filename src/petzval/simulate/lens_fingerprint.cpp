// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/lens/lens_file.h>
#include <petzval/render/pbrt/scene_files.h>
#include <petzval/simulate/lens_fingerprint.h>

namespace petzval {

namespace {

std::string coating_text(const Coating& coating) {
  std::string text;
  for (const auto& [nm, reflectance] : coating.table) text += fmt::format(" {}:{}", nm, reflectance);
  for (const double deg : coating.angles_deg) text += fmt::format(" {}", deg);
  for (const auto& at_wavelength : coating.by_angle)
    for (const auto& [s, p] : at_wavelength) text += fmt::format(" {}|{}", s, p);
  for (const CoatingLayer& layer : coating.layers)
    text += fmt::format(" {}/{}", layer.material.description(), layer.thickness_nm);
  return text;
}

}  // namespace

std::string lens_fingerprint(const Lens& lens, const std::vector<double>& wavelengths_nm) {
  std::string indices;
  for (const Surface& surface : lens.surfaces)
    for (const double nm : wavelengths_nm) indices += fmt::format("{} ", surface.material.index(nm));
  return fmt::format("lens {} {} {}\n", lens.name, render::hash_text(lens_to_json(lens)),
                     render::hash_text(indices));
}

std::string losses_fingerprint(const Losses& losses) {
  std::string text = fmt::format("losses fresnel {} absorption {}", losses.fresnel, losses.absorption);
  if (losses.air_glass) text += " air_glass" + coating_text(*losses.air_glass);
  for (const auto& [surface, coating] : losses.surfaces)
    text += fmt::format(" surfaces[{}]", surface) + coating_text(coating);
  return text + "\n";
}

}  // namespace petzval
