// SPDX-License-Identifier: BSD-3-Clause
// What lights a scene.
#pragma once

#include <petzval/render/lights/environment.h>
#include <petzval/render/lights/light_pattern.h>
#include <petzval/render/lights/light_tree.h>
#include <petzval/render/shapes/geometry.h>
#include <petzval/render/spectra/named_spectra.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace petzval::render {

/// One primitive of a surface that shines.
struct AreaLight {
  int geometry = 0;
  std::size_t primitive = 0;
  int spectrum = 0;  ///< into Lights::area_spectra
  bool two_sided = false;
  int source = 0;  ///< the light of the scene that it is of: those of its file, then its area lights
};

/// A light without extent.
struct SmallLight {
  enum class Kind { point, spot, distant };
  Kind kind = Kind::point;
  BandSpectrum strength;  ///< intensity [W·sr⁻¹·nm⁻¹ per unit²]; distant: irradiance across the direction
  Vector3 position, direction;                  ///< direction in which spot and distant lights shine; unit
  double cos_begin = 1, cos_end = 1;            ///< of a spot: where its edge begins and ends
  std::shared_ptr<const LightPattern> pattern;  ///< of a point light that shines by a picture
  int source = 0;                               ///< as in AreaLight
};

/// How light arrives at a point.
struct LightSample {
  Vector3 direction;  ///< towards the light; unit
  /// Where it shines, just in front of its surface; absent: infinitely far away.
  std::optional<Vector3> place;
  Lanes light;         ///< radiance, or for small lights what stands for radiance / pdf times pdf
  double pdf = 0;      ///< over solid angle, with the choice of the light
  bool small = false;  ///< no other way of sampling finds it
  int source = -1;     ///< the light of the scene; −1: the skies
};

/// How likely each light is asked from one point.
struct LightPlan {
  LightReceiver to;
  LightTree::Weights nearby;  ///< of the tree's entries
  double nearby_sum = 0;      ///< areas, point lights and spots
  double far_sum = 0;         ///< distant lights and skies
};

/// All lights of a scene. Which one is asked is chosen by what each can do at the point: lights that stand
/// somewhere by a tree, those infinitely far away by the irradiance that they would give it in the open.
class Lights {
 public:
  std::vector<BandSpectrum> area_spectra;
  std::vector<AreaLight> areas;
  std::vector<SmallLight> smalls;
  std::vector<Environment> environments;
  std::vector<int> environment_sources;  ///< as in AreaLight
  std::vector<std::string> sources;      ///< the lights of the scene, as notes call them: "2 area diffuse"

  /// Builds what choosing takes; call when the lists are complete.
  void prepare(const std::vector<Geometry>& geometries);
  bool empty() const { return areas.empty() && smalls.empty() && environments.empty(); }

  LightPlan plan(const LightReceiver& to) const;
  /// Distances near to one of the lights that stand somewhere; absent where none does.
  std::optional<Equiangular> beside(const LightedRay& ray, double choice) const {
    if (tree_.empty()) return {};
    return tree_.beside(ray, choice);
  }
  /// Light towards a point. Nothing where the chosen light does not reach.
  std::optional<LightSample> sample(const std::vector<Geometry>& geometries, const LightPlan& plan,
                                    double choice, double u, double v, int group) const;
  /// Radiance of an area light at a point of it, towards `wo`.
  Lanes emitted(std::size_t area, const SurfacePoint& point, Vector3 wo, int group) const;
  /// The density with which sample() finds a point of an area light.
  double area_pdf(const std::vector<Geometry>& geometries, std::size_t area, const LightPlan& plan,
                  const SurfacePoint& point) const;
  /// From the skies. \param from  the place, \param direction  unit, towards them.
  Lanes sky(const Vector3& from, const Vector3& direction, int group) const;
  double sky_pdf(const LightPlan& plan, Vector3 direction) const;

 private:
  struct Sphere {
    Vector3 centre;
    double radius = 0;
  };
  std::optional<LightSample> sample_area(const std::vector<Geometry>& geometries, std::size_t index,
                                         Vector3 to, double u, double v, int group) const;
  std::optional<LightSample> sample_small(const SmallLight& light, Vector3 to, int group) const;
  std::optional<LightSample> sample_far(const LightPlan& plan, double choice, double u, double v,
                                        int group) const;
  LightBounds bounds_of(const Geometry& geometry, const AreaLight& light,
                        const std::optional<Sphere>& sphere) const;

  LightTree tree_;                   ///< of areas, then of smalls that stand somewhere
  std::vector<std::size_t> stands_;  ///< into smalls
  std::vector<std::size_t> distant_;
  std::vector<std::optional<Sphere>> spheres_;  ///< of area lights that are whole spheres
};

}  // namespace petzval::render
