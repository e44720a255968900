// SPDX-License-Identifier: BSD-3-Clause
// All light of a source on one way through a lens, as triangles on the sensor.
#pragma once

#include <petzval/flare/facet_deposit.h>
#include <petzval/flare/ghost_way.h>
#include <petzval/flare/source_beam.h>
#include <petzval/sensor/sensor.h>

#include <cstddef>
#include <optional>
#include <vector>

namespace petzval {

/// How finely a bundle is followed.
struct BundleOptions {
  int cells = 24;           ///< along a side of what passes, 4 to 512
  int edge_divisions = 2;   ///< how often a cell that an aperture cuts is halved, 0 to 8
  int twist_divisions = 2;  ///< how often one that the lens twists by more than `twist` is halved, 0 to 8
  double twist_pixels = 2;

  /// \throws InputError saying what would be right.
  void validate() const;
};

/// A rectangle in the plane of the first vertex that holds what passes of a source on one way.
struct PupilBox {
  double left = 0, right = 0, low = 0, high = 0;                        ///< [mm]
  double middle_x = 0, middle_y = 0;                                    ///< a ray that passes
  double columns_from = 0, columns_to = 0, rows_from = 0, rows_to = 0;  ///< that its light reaches [pixels]
  /// At most so much passes, over the irradiance at the first vertex [mm²]: every cell that a ray passes
  /// counts whole.
  double most_mm2 = 0;
  std::size_t rays = 0;  ///< that were followed to find it

  double extent_pixels() const;
};

/// Where light that passes the first surface crosses the plane of its vertex; for a surface without a clear
/// radius twice as wide as the widest that has one.
PupilBox front_box(const Tracer& tracer, const SourceBeam& beam);

/// Looks for it with few rays: on a grid over the first surface, and, where none of them passes, again about
/// the one that fails least, which the height of paraxial rays at each surface being linear in the place
/// leads to what passes.
std::optional<PupilBox> find_pupil_box(const GhostTracer& tracer, const GhostPair& pair,
                                       const SourceBeam& beam, const SensorGeometry& frame);

/// Light of a source of unit irradiance at the first vertex, in pixels and mm².
struct GhostBundle {
  std::vector<LightFacet> facets;
  double flux_mm2 = 0;  ///< that reaches the plane of the sensor, in the frame or not
  std::size_t rays = 0;
};

/// Follows the corners of a grid over `box`; triangles between them carry the light that enters between
/// them, those that apertures cut are divided and cut along the line where the clearance is zero. A source
/// with an extent sends a bundle from each of several points or, where its image is wider than the ghost of
/// a point, triangles of its disc through each part of the pupil.
GhostBundle trace_bundle(const GhostTracer& tracer, const GhostPair& pair, const BrightSource& source,
                         const PupilBox& box, const SensorGeometry& frame, const BundleOptions& options);

}  // namespace petzval
