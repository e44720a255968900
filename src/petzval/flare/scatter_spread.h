// SPDX-License-Identifier: BSD-3-Clause
// The scatter point-spread function of a lens.
#pragma once

#include <petzval/flare/scatter_way.h>

#include <array>
#include <span>
#include <vector>

namespace petzval {

struct ScatterSpreadOptions {
  int across = 48;  ///< rays along a side of what a source lights of each surface, 4 to 512

  /// \throws InputError saying what would be right.
  void validate() const;
};

/// The scattered light of a source on points of the sensor.
struct ScatterSpread {
  SourceImage image;
  /// By place and surface: irradiance there over that of the source at the first vertex.
  std::vector<std::vector<double>> by_surface;

  double at(std::size_t place) const;
  /// The glare spread function: irradiance over the light of the image, did nothing scatter [1/mm²].
  double per_light(std::size_t place) const { return at(place) / image.clear_flux_mm2; }
};

/// What each surface scatters of a source of unit irradiance onto points of the sensor: the sum over the rays
/// that light the surface of flux × BSDF × |d²β/d(x, y)|, the derivative being that of the one ray that goes
/// on from there to the point through all apertures. Near the axis β − β₀ is h′ times the distance from the
/// image, with the slope h′ of a paraxial ray through the image point and the surface at unit height, so that
/// each surface's lobe is as wide on the sensor as the beam is on the surface. \param places  (x, y) on the
/// sensor [mm]. \throws InputError as ScatterTracer, ScatterSpreadOptions and BrightSource::validate().
///
///     const ScatterTracer tracer(with_scatter(lens, parse_scatter("roughness=1.5")), 550, {});
///     const ScatterSpread spread = scatter_spread(tracer, BrightSource{.right = 0.1}, places);
ScatterSpread scatter_spread(const ScatterTracer& tracer, const BrightSource& source,
                             std::span<const std::array<double, 2>> places,
                             const ScatterSpreadOptions& options = {});

/// A point of the lens's object whose image lies at (x, y) on the sensor; where no light comes from there,
/// one nearer to the axis that sends some.
BrightSource source_imaged_at(const Lens& lens, const ScatterTracer& tracer, double x_mm, double y_mm);

}  // namespace petzval
