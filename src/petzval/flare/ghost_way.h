// SPDX-License-Identifier: BSD-3-Clause
// Real rays on the ways of light that two or four surfaces of a lens reflect.
#pragma once

#include <petzval/flare/pixel_grating.h>
#include <petzval/flare/surface_reflection.h>
#include <petzval/trace/losses.h>
#include <petzval/trace/tracer.h>

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace petzval {

/// A way through a lens: to surface `first`, back to `second` in front of it, and on to the sensor; or on to
/// `third`, back to `fourth` in front of that, and on. The sensor's index is the number of surfaces.
/// `straight()` is the way of the picture.
struct GhostPair {
  std::size_t first = none, second = none, third = none, fourth = none;
  GratingOrder order = {};  ///< in which the sensor reflects, where it is `first` and there is no `third`

  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  static GhostPair straight() { return {}; }
  bool is_straight() const { return first == none; }
  int reflections() const { return is_straight() ? 0 : third == none ? 2 : 4; }
  bool operator==(const GhostPair&) const = default;
};

/// Where a ray ends up.
struct GhostLanding {
  bool arrives = false;       ///< else it missed a surface, or was not reflected or let through
  double x_mm = 0, y_mm = 0;  ///< on the sensor, in its own axes
  double share = 0;           ///< of its power
  /// By how much it clears all apertures that it crosses, each time: the largest (r/r_clear)² − 1, negative
  /// inside; infinity where it does not arrive.
  double clearance = std::numeric_limits<double>::infinity();
};

/// A lens at one wavelength, whose surfaces reflect.
class GhostTracer {
 public:
  /// Surfaces without a coating reflect as bare glass, whether or not `losses` counts that; absorption
  /// counts if it says so. Mirrors of the lens reflect all light unless a coating says how much, and
  /// make no ghosts. \throws InputError for lenses with gratings, ideal lenses or ray transfers, as
  /// Losses::validate() and SensorReflection::validate().
  GhostTracer(const Lens& lens, double wavelength_nm, const Losses& losses, const SensorReflection& sensor,
              Tracer::Clip clip = Tracer::Clip::apertures);

  /// All pairs of surfaces that reflect, those with the sensor once for each order of its grating.
  std::vector<GhostPair> pairs() const;
  /// All ways with four reflections. Of the sensor's grating they have the order 0 alone.
  std::vector<GhostPair> double_pairs() const;
  const Tracer& tracer() const { return tracer_; }
  /// \param ray  in object space. \param places  receives every place where it meets a surface and the
  /// sensor, in order, as far as it comes.
  GhostLanding follow(const Ray& ray, const GhostPair& pair,
                      std::vector<std::array<double, 3>>* places = nullptr) const;

 private:
  /// Whether light that shall go on is reflected there: not by the mirrors of the lens.
  bool turns_light(std::size_t surface) const;

  Tracer tracer_;
  Tracer::Clip clip_;
  std::vector<SurfaceReflection> surfaces_;  ///< the sensor last
  std::vector<GratingOrder> orders_;         ///< of the sensor
  double straight_share_ = 1;                ///< of what it reflects, in the order 0
  double cosines_per_order_ = 0;
  std::vector<double> absorption_per_mm_;  ///< of the gap behind each surface
};

}  // namespace petzval
