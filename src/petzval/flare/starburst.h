// SPDX-License-Identifier: BSD-3-Clause
// The star that the edges of a stop make of a bright point.
#pragma once

#include <petzval/flare/ghost_light.h>

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace petzval {

/// The light of a point as its image point sees it: a polygon, or a circle, of direction cosines.
struct StarPupil {
  std::vector<std::array<double, 2>> corners = {};  ///< anticlockwise; empty: a circle
  double radius = 0;                                ///< of the circle of the same area
  double x_mm = 0, y_mm = 0;                        ///< the image point on the sensor
  double core_mm = 0;    ///< how far from it its geometric image reaches, with that of the source
  double source_mm = 0;  ///< radius of the source's image
  double flux_mm2 = 0;   ///< light over the irradiance at the first vertex

  double area() const;
};

/// From real rays: directions at the sensor as a linear function of places at the stop, whose corners then
/// give those of the polygon. What other apertures cut off makes no edges here. Nothing where no ray passes.
std::optional<StarPupil> star_pupil(const GhostTracer& tracer, const BrightSource& source,
                                    const SensorGeometry& frame);

/// Mean irradiance over that of all its light, at (x, y) from the image point [1/mm²]: Fraunhofer diffraction
/// at the edges, from whose closed form fringes narrower than a pixel and the source's image are averaged
/// out. Each edge of length L sends, at the distance s across and t along it, L² s²/(4π² a (s² + t²)²) times
/// the mean of sinc² over t ± `blur_mm`, with sinc²(u) replaced by ½/(¼ + u²), of the same integral and mean
/// tail; a circle that of Airy's pattern, (2/π)(λ/π r³) over 2π times the radius. \param blur_mm  half a
/// pixel and the source's radius.
double star_irradiance(const StarPupil& pupil, double wavelength_nm, double x_mm, double y_mm,
                       double blur_mm);

/// The share of the light that is farther from the image point than `from_mm`.
double star_share_beyond(const StarPupil& pupil, double wavelength_nm, double from_mm, double blur_mm);

/// The stars of sources [W·m⁻²·nm⁻¹], each beyond its core; its light is taken from the core, where the layer
/// is negative, so that all of it together is none.
/// \param core_mm  the picture itself has the diffraction of points this near to their images; 0: none.
/// \throws InputError as straight_light(); Cancelled.
SpectralImage starburst_light(const Lens& lens, const SensorGeometry& frame,
                              const std::vector<double>& wavelengths_nm,
                              std::span<const BrightSource> sources, const GhostLightOptions& options = {},
                              double core_mm = 0);

}  // namespace petzval
