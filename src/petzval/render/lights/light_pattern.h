// SPDX-License-Identifier: BSD-3-Clause
// Lights that stand at a point and shine by a picture.
#pragma once

#include <petzval/render/lights/light_tree.h>
#include <petzval/render/spectra/wavelength_groups.h>
#include <petzval/render/textures/picture_file.h>
#include <petzval/render/transform.h>

#include <memory>

namespace petzval::render {

/// What a light without extent sends into each direction, as a share of its strength: the pixel of a picture
/// that the direction meets, not interpolated (as pbrt-v4 has it).
class LightPattern {
 public:
  virtual ~LightPattern() = default;
  /// For the wavelengths of a group. \param direction  in world space, away from the light.
  virtual Lanes share(Vector3 direction, int group) const = 0;
  /// ∬ share dω over all directions, of a picture in grey or by its luminance [sr].
  virtual double emitted_sr() const = 0;
  /// Axis, spread and reach of the light, and its mean share as strength.
  virtual LightBounds bounds() const = 0;
};

/// A slide that is cast along +z of the light's space, upright and not mirrored for who looks along with the
/// light, +y up; `field_of_view_deg` across its shorter side. Colours are those of light of white. Dark
/// outside of the slide.
std::shared_ptr<const LightPattern> projected_pattern(const PictureFile& picture, double field_of_view_deg,
                                                      const WavelengthGroups& groups,
                                                      const Transform& world_from_light);

/// A square picture of all directions in the equal-area octahedral layout, its pole along +y of the light's
/// space; of colours the mean counts.
std::shared_ptr<const LightPattern> goniometric_pattern(const PictureFile& picture,
                                                        const Transform& world_from_light);

}  // namespace petzval::render
