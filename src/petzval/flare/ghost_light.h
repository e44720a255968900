// SPDX-License-Identifier: BSD-3-Clause
// The light of ghosts on a sensor.
#pragma once

#include <petzval/base/progress.h>
#include <petzval/flare/ghost_bundle.h>
#include <petzval/image/spectral_image.h>

#include <span>
#include <string>
#include <vector>

namespace petzval {

struct GhostLightOptions {
  Losses losses = {};  ///< coatings and absorption; surfaces without a coating reflect as bare glass
  SensorReflection sensor = {};
  /// 2, or 4: light that is reflected four times is followed, too, if by the reflectances along the axis it
  /// may be more than `neglected_share` of that of the brightest pair.
  int reflections = 2;
  Tracer::Clip clip = Tracer::Clip::apertures;
  BundleOptions bundle = {};
  /// Pairs that together hold at most this share of the light of all ghosts, by the bounds of a search with
  /// few rays, are left out, the faintest first.
  double neglected_share = 1e-4;

  /// \throws InputError saying what would be right.
  void validate() const;
};

/// One pair, over all sources and wavelengths.
struct GhostPairReport {
  GhostPair pair;
  double flux_w = 0;     ///< that reaches the plane of the sensor, over bands [W·nm⁻¹ added up]
  std::size_t rays = 0;  ///< that were followed
  double seconds = 0;    ///< of one thread
};

struct GhostLightReport {
  std::vector<GhostPairReport> pairs;       ///< the one with the most light first
  std::size_t followed = 0, neglected = 0;  ///< ways: of one pair, source and wavelength
  double neglected_share = 0;               ///< bound of their light over the light of all ghosts
  double ghost_flux_w = 0, frame_flux_w = 0;  ///< of all, and of what falls into the frame [W·nm⁻¹ added up]
};

/// Irradiance of all double reflections of sources [W·m⁻²·nm⁻¹], pixels being boxes: real rays through real
/// apertures and blades (after M. Hullin et al., ACM Trans. Graph. 30 (2011) 108), their light by coatings,
/// angle and polarisation, of four reflections if it is asked for. The bytes do not depend on
/// the number of threads. \param lens  focused as it is used. \throws InputError as
/// GhostTracer and BrightSource::validate(); Cancelled.
///
///     BrightSource sun{.name = "sun", .right = 0.2, .up = 0.1, .radius_rad = 0.0047, .irradiance = {1.3}};
///     const SpectralImage ghosts = ghost_light(lens, {1920, 1080, 5}, {550}, {{sun}});
SpectralImage ghost_light(const Lens& lens, const SensorGeometry& frame,
                          const std::vector<double>& wavelengths_nm, std::span<const BrightSource> sources,
                          const GhostLightOptions& options = {}, const ProgressCallback& progress = {},
                          GhostLightReport* report = nullptr);

/// What a picture loses: surfaces without a coating let all light through unless `given` counts reflection at
/// bare glass.
Losses losses_of_picture(const Lens& lens, double wavelength_nm, const Losses& given);

/// The image of the sources themselves, as their rays give it; a lens without losses lets all light through.
SpectralImage straight_light(const Lens& lens, const SensorGeometry& frame,
                             const std::vector<double>& wavelengths_nm, std::span<const BrightSource> sources,
                             const GhostLightOptions& options = {}, const ProgressCallback& progress = {});

}  // namespace petzval
