// SPDX-License-Identifier: BSD-3-Clause
// Real rays on the ways of light that two surfaces of a lens reflect.
#pragma once

#include <petzval/flare/surface_reflection.h>
#include <petzval/trace/losses.h>
#include <petzval/trace/tracer.h>

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace petzval {

/// A way through a lens: to surface `first`, back to `second` in front of it, and on to the sensor. The
/// sensor's index is the number of surfaces. `straight()` is the way of the picture.
struct GhostPair {
  std::size_t first = none, second = none;

  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  static GhostPair straight() { return {}; }
  bool is_straight() const { return first == none; }
  bool operator==(const GhostPair&) const = default;
};

/// Where a ray ends up.
struct GhostLanding {
  bool arrives = false;       ///< else it missed a surface, or was not reflected or let through
  double x_mm = 0, y_mm = 0;  ///< on the sensor
  double share = 0;           ///< of its power
  /// By how much it clears all apertures that it crosses, each time: the largest (r/r_clear)² − 1, negative
  /// inside; infinity where it does not arrive.
  double clearance = std::numeric_limits<double>::infinity();
};

/// A lens at one wavelength, whose surfaces reflect.
class GhostTracer {
 public:
  /// Surfaces without a coating reflect as bare glass, whether or not `losses` counts that; absorption
  /// counts if it says so. \throws InputError for lenses that are not centred or have no glass, as
  /// Losses::validate(), and for a reflectance outside 0…1.
  GhostTracer(const Lens& lens, double wavelength_nm, const Losses& losses, double sensor_reflectance,
              Tracer::Clip clip = Tracer::Clip::apertures);

  /// All pairs of surfaces that reflect.
  std::vector<GhostPair> pairs() const;
  const Tracer& tracer() const { return tracer_; }
  /// \param ray  in object space. \param places  receives every place where it meets a surface and the
  /// sensor, in order, as far as it comes.
  GhostLanding follow(const Ray& ray, const GhostPair& pair,
                      std::vector<std::array<double, 3>>* places = nullptr) const;

 private:
  Tracer tracer_;
  Tracer::Clip clip_;
  std::vector<SurfaceReflection> surfaces_;  ///< the sensor last
  std::vector<double> absorption_per_mm_;    ///< of the gap behind each surface
};

}  // namespace petzval
