// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/units.h>
#include <petzval/simulate/scene_lights.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace petzval {

namespace {

using render::Vector3;

/// What has been added up of one light.
struct LightSum {
  std::vector<double> irradiance;
  Vector3 towards{0, 0, 0};  ///< in the camera's space, weighted by light
  double distance = 0, weight = 0, solid_angle = 0;
  bool far = false;
};

class LightAdder {
 public:
  LightAdder(const render::World& world, const LensPlace& place)
      : world_(world), place_(place), eye_(place.world_from_camera.point({0, 0, place.vertex})) {}

  /// `share` of a spectrum as irradiance at the vertex, from `from` (towards it, if it is far).
  void add(const render::BandSpectrum& spectrum, double share, Vector3 from, bool far, double solid_angle,
           LightSum& sum) const {
    const Vector3 local = far ? place_.world_from_camera.inverse_direction(from)
                              : place_.world_from_camera.inverse_point(from) - Vector3{0, 0, place_.vertex};
    const double length = std::sqrt(dot(local, local));
    if (!(local.z > std::cos(radians(80.0)) * length) || !(share > 0)) return;
    // A hair short of the light, whose own surface is in the way there.
    constexpr double nearly = 1 - 1e-4;
    const Vector3 way = far ? from : from - eye_;
    if (world_.intersector->blocked(eye_, way, far ? 1e30 : nearly)) return;
    const std::size_t bands = world_.groups.wavelengths_nm().size();
    sum.irradiance.resize(bands);
    double light = 0;
    for (int group = 0; group < world_.groups.count(); ++group)
      for (int lane = 0; lane < world_.groups.lanes(group); ++lane) {
        const double value = share * double(spectrum[static_cast<std::size_t>(group)][lane]);
        sum.irradiance[static_cast<std::size_t>(world_.groups.band(group, lane))] += value;
        light += value;
      }
    sum.towards = sum.towards + light / length * local;
    sum.distance += light * local.z;
    sum.weight += light;
    sum.solid_angle += solid_angle;
    sum.far = far;
  }

  void add_surface(const render::AreaLight& light, LightSum& sum) const {
    const render::Geometry& geometry = world_.geometries[static_cast<std::size_t>(light.geometry)];
    // Many primitives are points enough themselves.
    const int side = geometry.primitives() > 64 ? 2 : 16;
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) {
        const render::SurfaceSample on =
            sample_primitive(geometry, light.primitive, (i + 0.5) / side, (j + 0.5) / side);
        const Vector3 away = eye_ - on.point.position;
        const double square = dot(away, away);
        double cosine = dot(away, on.point.normal) / std::sqrt(square);
        if (light.two_sided) cosine = std::abs(cosine);
        if (!(cosine > 0) || !(on.per_area > 0)) continue;
        const double solid_angle = cosine / (square * on.per_area * side * side);
        add(world_.lights.area_spectra[static_cast<std::size_t>(light.spectrum)], solid_angle,
            on.point.position, false, solid_angle, sum);
      }
  }

  void add_small(const render::SmallLight& light, LightSum& sum) const {
    if (light.kind == render::SmallLight::Kind::distant)
      return add(light.strength, 1, -light.direction, true, 0, sum);
    const Vector3 away = eye_ - light.position;
    const double square = dot(away, away);
    double share = 1 / square;
    if (light.kind == render::SmallLight::Kind::spot) {
      const double cosine = dot(away, light.direction) / std::sqrt(square);
      const double x =
          std::clamp((cosine - light.cos_end) / std::max(light.cos_begin - light.cos_end, 1e-12), 0.0, 1.0);
      share *= x * x * (3 - 2 * x);
    }
    if (!light.pattern) return add(light.strength, share, light.position, false, 0, sum);
    render::BandSpectrum sent = light.strength;
    for (std::size_t group = 0; group < sent.size(); ++group)
      sent[group] *= light.pattern->share(away, static_cast<int>(group));
    add(sent, share, light.position, false, 0, sum);
  }

  std::optional<BrightSource> source_of(const LightSum& sum) const {
    if (!(sum.weight > 0)) return {};
    BrightSource source;
    source.right = sum.towards.x / sum.towards.z;
    source.up = sum.towards.y / sum.towards.z;
    if (!sum.far) source.distance_mm = sum.distance / sum.weight * place_.unit_mm;
    source.radius_rad = std::min(std::sqrt(sum.solid_angle / pi), radians(44.0));
    source.irradiance = sum.irradiance;
    source.name = fmt::format("{:.1f}, {:.1f} degrees", degrees(std::atan(source.right)),
                              degrees(std::atan(source.up)));
    return source;
  }

 private:
  const render::World& world_;
  const LensPlace& place_;
  Vector3 eye_;
};

}  // namespace

SourcesFound lights_seen(const render::World& world, const LensPlace& place, int most) {
  const LightAdder adder(world, place);
  std::map<int, LightSum> surfaces;
  for (const render::AreaLight& light : world.lights.areas)
    adder.add_surface(light, surfaces[light.geometry]);
  std::vector<BrightSource> sources;
  for (const auto& [geometry, sum] : surfaces)
    if (auto source = adder.source_of(sum)) sources.push_back(*std::move(source));
  for (const render::SmallLight& light : world.lights.smalls) {
    LightSum sum;
    adder.add_small(light, sum);
    if (auto source = adder.source_of(sum)) sources.push_back(*std::move(source));
  }
  return brightest(std::move(sources), most);
}

bool is_seen(const render::World& world, const LensPlace& place, const BrightSource& far_source) {
  const Vector3 eye = place.world_from_camera.point({0, 0, place.vertex});
  const Vector3 way = place.world_from_camera.direction({far_source.right, far_source.up, 1});
  return !world.intersector->blocked(eye, way, 1e30);
}

}  // namespace petzval
