// SPDX-License-Identifier: BSD-3-Clause
// How far a path has come.
#pragma once

#include <petzval/render/path_tracer.h>

namespace petzval::render {

/// Share of one of two ways of sampling that could both have found a path (balance heuristic, Veach 1997).
inline double balanced(double pdf, double other) {
  return pdf / (pdf + other);
}

/// Paths through surfaces that are no boundary do not count as scattered; this many are enough for any scene.
inline constexpr int most_interfaces = 1000;

/// The way that must be open for light to come from a lamp. Between two places, each just in front of its
/// surface: at grazing angles a direction alone would miss by much.
inline Vector3 way_to(const LightSample& light, Vector3 from) {
  return light.place ? *light.place - from : light.direction;
}
/// The share of it on which it may be blocked: to the last roundings of a float.
inline double end_of_way(const LightSample& light) {
  constexpr double shadow_end = 1 - 0x1p-20;
  return light.place ? shadow_end : std::numeric_limits<double>::infinity();
}

/// Below, a density has nearly left the range of floats, and the light with it is nothing.
inline constexpr double least_density = 1e-30;

/// The medium on the side of a surface that a direction leads to. \param now  that in which it is met.
inline int medium_towards(const Geometry& geometry, const SurfacePoint& point, Vector3 direction, int now) {
  if (!geometry.parts_media) return now;
  return dot(point.normal, direction) > 0 ? geometry.outside : geometry.inside;
}

struct PathTracer::Path {
  Vector3 origin, direction;
  Lanes throughput = Lanes::all(1);
  double pdf = 0;      ///< of the last scattering; 0 after a mirror or at the camera
  bool alone = false;  ///< dispersed: only the hero wavelength is left
  int hero = 0, depth = 0;
  double index_scale = 1;  ///< what refraction has done to radiance so far, undone for Russian roulette
  LightPlan plan;          ///< of the last surface that is no mirror, or place in a medium
  std::span<SourceLight> of_sources;
  PathLight light;

  // Through media wavelengths lead differently. Light is divided by the mean of the densities with which each
  // would have led the path here (balance heuristic over the hero: Wilkie et al., Comput. Graph. Forum 33
  // (2014) 4), of which these are the single ones, over their mean.
  int medium = -1;        ///< that the path is in, into World::media; −1: none
  int lanes = 0;          ///< of the group, any of which might have led; 0: the world has no media
  Lanes led_by;           ///< density with this wavelength as hero
  Lanes asked;            ///< the same had the last stretch been that to a light that was asked
  double asked_mean = 1;  ///< of the lanes, or of the hero alone
  double hero_share = 1;  ///< of the hero, when the path began
  double beside = 0;      ///< density of add_beside() over the mean of `led_by`, where the medium scatters
  std::unique_ptr<const Medium>
      entered;  ///< what there is in `medium`, if it varies with where one enters it
  /// How much likelier a lamp that stands somewhere is asked from the last place by that.
  double asked_again = 1;

  double mean(const Lanes& of) const {
    if (alone) return static_cast<double>(of[hero]);
    double sum = 0;
    for (int i = 0; i < lanes; ++i) sum += static_cast<double>(of[i]);
    return sum / lanes;
  }
  /// \param led  as PathTracer::trace() is told. \param count  lanes of the group.
  void begin_with(const Lanes& led, int count) {
    lanes = count;
    led_by = led;
    led_by *= 1 / mean(led);
    hero_share = static_cast<double>(led_by[hero]);
    asked = led_by;
  }
  /// From now on nobody but the hero might have led.
  void leave_others() {
    if (alone) return;
    alone = true;
    if (lanes == 0) return;
    throughput *= hero_share / static_cast<double>(led_by[hero]);
    led_by = only(hero, 1);
  }
  /// Light that is asked for from now on is asked for from here.
  void begin_stretch() {
    if (lanes == 0) return;
    asked = led_by;
    asked_mean = 1;
  }
};

}  // namespace petzval::render
