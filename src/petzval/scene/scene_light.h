// SPDX-License-Identifier: BSD-3-Clause
// The light on a scene: which of it falls into the bands, and how strong it is.
#pragma once

#include <petzval/scene/scene.h>

#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// Whether a light has at least 0.1 lm/W: it makes sense to say how bright it is to the eye.
bool is_visible(const Spectrum& light);

/// band_light() of an illuminant. \param name  of the illuminant, for messages.
/// \throws InputError if there is none in any of the bands.
std::vector<double> light_in_bands(const Spectrum& illuminant, const std::string& name,
                                   const std::vector<double>& bands_nm, std::optional<double> width_nm);

/// What an illuminant that no eye sees is multiplied by, so that 1 W/m² falls on the scene. A note of the
/// scene says so. \throws InputError for a light without power.
double invisible_level(const Spectrum& illuminant, Scene& scene);

/// Scales a scene so that its illuminant throws so much light on it: on a Lambertian white of radiance L
/// falls π L. \throws InputError unless the scene knows its illuminant, which has light of that kind.
void set_illuminance_lx(Scene& scene, double illuminance_lx);
void set_irradiance_w_m2(Scene& scene, double irradiance_w_m2);

/// The radiance of a scene that was taken from a file at its own bands, as that of bands of this width, or,
/// of a single band under a narrow light, as all of that light. \param light  of the scene as the file has
/// it.
void widen_bands(Scene& scene, const std::optional<Spectrum>& light, std::optional<double> width_nm);

/// Makes the scene's illuminant that of its bands, so that radiance over illuminant is reflectance, and notes
/// bands that no light reaches because the illuminant ends. \param width_nm  of every band, as band_light().
void settle_illuminant(Scene& scene, std::optional<double> width_nm);

/// A note for a scene of one band whose width nobody knows. \param light  before it was settled.
void note_unknown_width(Scene& scene, const std::optional<Spectrum>& light);

}  // namespace petzval
