// SPDX-License-Identifier: BSD-3-Clause
// What fills space and dims or scatters light: fog, smoke, coloured glass.
#pragma once

#include <petzval/render/lights/equiangular.h>
#include <petzval/render/lights/light_options.h>
#include <petzval/render/media/density_grid.h>
#include <petzval/render/media/emission.h>
#include <petzval/render/pbrt/scene_description.h>
#include <petzval/render/spectra/wavelength_groups.h>

#include <memory>
#include <optional>
#include <vector>

namespace petzval::render {

class TextureLibrary;
struct VariedMedium;

/// What a straight way through media does, wavelength by wavelength; everything up to one common factor.
/// (The path integral of null scattering: Miller, Georgiev & Jarosz, ACM Trans. Graph. 38 (2019) 4.)
struct Passage {
  Lanes light = Lanes::all(1);  ///< what is left of the light
  /// The density with which a path that this wavelength leads would have come through, or scattered there.
  Lanes flown = Lanes::all(1);
  /// The same for a way to a light that was asked, which nothing ends.
  Lanes asked = Lanes::all(1);

  Passage& operator*=(const Passage& next) {
    light *= next.light, flown *= next.flown, asked *= next.asked;
    return *this;
  }
};

/// A way that ends at its end or where light is scattered.
struct Flight {
  Passage passage;
  std::optional<double> scattered_at;  ///< distance; absent: nowhere
};

/// A medium, its coefficients at the bands of a picture.
struct Medium {
  BandSpectrum absorption, scattering;         ///< [group], per scene unit; none negative
  double g = 0;                                ///< of Henyey and Greenstein's phase function
  AngleShares angle_shares{0};                 ///< of g
  bool scatters = false;                       ///< else light only becomes less
  std::shared_ptr<const DensityGrid> density;  ///< that the coefficients are times; null: 1 everywhere
  /// In place of the coefficients, if not null; `density` is then what no wavelength's extinction exceeds.
  std::shared_ptr<const ColourCoefficients> colours;
  std::shared_ptr<const Emission> emission;  ///< null: dark
  /// Not null: what a path meets is that of where it has entered (Path::entered).
  std::shared_ptr<const VariedMedium> varied;

  Lanes extinction(int group) const {
    return absorption[static_cast<std::size_t>(group)] + scattering[static_cast<std::size_t>(group)];
  }
  /// Follows light that `hero` leads, up to where it is scattered. \param way  unit; up to `distance`, which
  /// may be infinite.
  Flight fly(Vector3 origin, Vector3 way, double distance, int group, int hero, Lots& lots) const;
  /// To where a homogeneous medium scatters it.
  Flight scattered_at(double distance, int group) const;
  /// What comes through from a light.
  Passage pass(Vector3 origin, Vector3 way, double distance, int group, int hero, Lots& lots) const;
  /// The radiance that reaches the origin of what the medium itself sends out on the way: the integral in a
  /// homogeneous medium, an estimate of it in a grid. Not of a dark one.
  Lanes glow(Vector3 origin, Vector3 way, double distance, int group, Lots& lots) const;

 private:
  Flight fly_through_colours(Vector3 origin, Vector3 way, double distance, int group, int hero, bool stops,
                             Lots& lots) const;
  Lanes glow_of_grid(Vector3 origin, Vector3 way, double distance, int group, Lots& lots) const;
  Passage passage_of(const DensityGrid::Walk& walk, int group, int hero) const;
};

/// What is below the boundary of a material "subsurface" of pbrt-v4. \throws InputError; through
/// `unsupported`.
Medium make_subsurface(const Entity& material, const TextureLibrary& textures, Unsupported& unsupported);

/// All media of a scene, in the order of its description. \throws InputError with file, line and column, and
/// through `unsupported`.
std::vector<Medium> make_media(const SceneDescription& scene, const WavelengthGroups& groups,
                               const LightOptions& options, Unsupported& unsupported);

}  // namespace petzval::render
