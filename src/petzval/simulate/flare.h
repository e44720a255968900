// SPDX-License-Identifier: BSD-3-Clause
// Light that goes astray in the lens, for every way to the sensor.
#pragma once

#include <petzval/base/context.h>
#include <petzval/flare/ghost_light.h>
#include <petzval/flare/scatter_light.h>
#include <petzval/flare/scene_sources.h>

#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// A disc of light at infinity that the scene does not hold: the Sun, unless told otherwise.
struct Sun {
  double right_deg = 0, up_deg = 0;  ///< angles whose tangents are those from the axis, for the photographer
  double illuminance_lx = 100000;    ///< at the lens, across its light
  double diameter_deg = 0.53;
  std::string light = "5772K";  ///< an illuminant (colour/illuminants.h)

  /// As a source at these wavelengths. \throws InputError for angles of 80 degrees or more, an illuminance
  /// or a diameter that is not positive, and for light that no eye sees.
  BrightSource at(const std::vector<double>& wavelengths_nm) const;
};

/// "20,15" or "20,15:80000": degrees to the right and up, illuminance [lx].
/// \throws InputError for anything else.
Sun parse_sun(const std::string& text);

struct FlareOptions {
  std::vector<Sun> suns = {};  ///< added to the scene: their images as their rays give them
  bool ghosts = false;         ///< of suns, and of the bright sources that the scene itself holds
  int ghost_reflections = 2;   ///< or 4: ghosts of light that is reflected four times, too
  bool starburst = false;      ///< of the same: what the edges of the stop diffract
  bool scatter = false;        ///< of all light: what the surfaces of the lens turn aside
  /// How surfaces scatter that say nothing themselves; absent: as the lens says.
  std::optional<Scatter> surfaces_scatter = {};
  ScatterLightOptions::Surround scatter_surround = ScatterLightOptions::Surround::dark;
  SourceSearch search = {};
  double neglected_share = 1e-4;  ///< of the light of all ghosts, that may be left out

  bool seeks() const { return ghosts || starburst || scatter; }
  bool any() const { return seeks() || !suns.empty(); }
};

/// A lens as it is used: what light meets on its way.
struct LitLens {
  Lens lens = {};
  Losses losses = {};
  Tracer::Clip clip = Tracer::Clip::apertures;
  SensorReflection sensor = {};
  double psf_mm = 0;  ///< the picture of what the scene holds has diffraction this near to its image points
};

/// Light that is added to a picture, each layer by itself.
struct FlareLayers {
  std::optional<SpectralImage> suns, ghosts, stars, scatter;
  std::vector<BrightSource> sources;  ///< suns first, then what the scene itself holds
  std::size_t sun_count = 0;
  GhostLightReport report = {};
  ScatterLightReport scatter_report = {};
};

/// \param found  sources that the scene itself holds. Notes tell what was left out.
/// \throws InputError as ghost_light() and Sun::at(); Cancelled.
FlareLayers flare_layers(const LitLens& lens, const SensorGeometry& frame,
                         const std::vector<double>& wavelengths_nm, const SourcesFound& found,
                         const FlareOptions& options, const Context& context = {});

/// The lens as scatter is asked for. \throws InputError for a lens that says nothing of it where nothing else
/// does, and as ScatterTracer.
Lens scattering_lens(const Lens& lens, const std::optional<Scatter>& surfaces_scatter);

/// What scatter does to a picture that has its other layers: the layer, which is added to it as well. Sources
/// of `layers` that the frame does not hold take part. \throws InputError as scatter_light(); Cancelled.
void add_scatter(const LitLens& lens, const FlareOptions& options, FlareLayers& layers, SpectralImage& light,
                 const Context& context = {});

/// Adds the layers to a picture of the same frame and bands, which its provenance then says.
void add_layers(const FlareLayers& layers, SpectralImage& light);

}  // namespace petzval
