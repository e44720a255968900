// SPDX-License-Identifier: BSD-3-Clause
// Many rays through a lens in single precision: for radiance, where an optical path is not asked for.
#pragma once

#include <petzval/trace/batch_kernel.h>
#include <petzval/trace/tracer.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace petzval {

/// Rays of one wavelength in lens space [mm]. Directions are made unit vectors to float precision.
struct RadianceRays {
  std::vector<float> x_mm, y_mm, z_mm;
  std::vector<float> l, m, n;        ///< direction cosines
  std::vector<std::uint8_t> passes;  ///< set by the trace: 1, or 0 for a ray that is left as it was

  RadianceRays() = default;
  explicit RadianceRays(std::size_t count) { resize(count); }
  std::size_t size() const { return x_mm.size(); }
  void resize(std::size_t count);
};

/// A lens made ready for tracing float rays in one direction at one wavelength, with the same meaning of
/// forward, backward and clipping as Tracer. Immutable; may be used from many threads. Against Tracer: 1e-5
/// mm and 2e-6 in direction for lenses of some 50 mm (ulps of their coordinates, times what the lens
/// magnifies them by).
class RadianceTracer {
 public:
  enum class Direction { forward, backward };
  RadianceTracer(const Tracer& tracer, Direction direction, Tracer::Clip clip = Tracer::Clip::apertures);

  /// In place: from object space to the image surface, or from image space to just in front of surface 0.
  void trace(RadianceRays& rays) const;

 private:
  KernelPath<float> path_;
};

}  // namespace petzval
