// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/colour/band_light.h>
#include <petzval/colour/observer.h>
#include <petzval/scene/illuminant_swap.h>

#include <algorithm>

namespace petzval {

namespace {

/// How bright a light is in some bands: Y, or all of it where none of them is seen.
double brightness(const std::vector<double>& light, const std::vector<double>& bands_nm) {
  const std::vector<Xyz> seen = Observer::cie_1931().weights(bands_nm);
  const std::vector<double> widths = band_widths_nm(bands_nm);
  double luminous = 0, all = 0;
  for (std::size_t i = 0; i < light.size(); ++i)
    luminous += light[i] * seen[i].y, all += light[i] * widths[i];
  return luminous > 0 ? luminous : all;
}

}  // namespace

void swap_illuminant(Scene& scene, const Spectrum& illuminant) {
  if (!scene.illuminant)
    throw InputError(
        "holds radiance and does not say under which light, so it cannot be put under another; "
        "`scene.illuminant` "
        "is "
        "for charts, photographs, reflectances and scenes whose light is known");
  const std::vector<double>& bands = scene.wavelengths_nm();
  const std::vector<double> fresh = band_light(illuminant, bands);
  std::vector<double> old;
  for (const double nm : bands) old.push_back(scene.illuminant->at(nm));
  const double bright = brightness(fresh, bands);
  if (!(bright > 0)) throw InputError("the new illuminant has no light in the bands of the scene");
  const double level = brightness(old, bands) / bright;
  for (std::size_t i = 0; i < bands.size(); ++i) {
    const std::span<float> band = scene.band(static_cast<int>(i));
    if (!(old[i] > 0) && std::any_of(band.begin(), band.end(), [](float value) { return value > 0; }))
      throw InputError(
          fmt::format("has radiance at {} nm, where its own illuminant has no light: it cannot be "
                      "put under another",
                      bands[i]));
    const double factor = old[i] > 0 ? level * fresh[i] / old[i] : 0;
    for (float& value : band) value = static_cast<float>(value * factor);
    scene.release_memory();
  }
  scene.illuminant = Spectrum(bands, fresh).scaled(level);
}

}  // namespace petzval
