// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/flare/ghost_way.h>
#include <petzval/lens/ray_transfer.h>
#include <petzval/trace/surface_step.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace petzval {

namespace {

using Direction = std::array<double, 3>;

/// A ray on its way, relative to the vertex of the surface that it left.
struct Wanderer {
  SurfaceRay at{};
  double vertex_z = 0;
  LightFields light;

  Direction direction() const { return {at.l, at.m, at.n}; }
  std::array<double, 3> place() const { return {at.x, at.y, at.z + vertex_z}; }
  void move_vertex(double z) {
    at.z += vertex_z - z;
    vertex_z = z;
  }
};

/// Turns a ray by so much of its direction cosines, on the side where it is; false where there is none.
bool diffract(double l, double m, SurfaceRay& ray) {
  ray.l += l, ray.m += m;
  const double square = 1 - ray.l * ray.l - ray.m * ray.m;
  ray.n = std::copysign(std::sqrt(std::max(square, 0.0)), ray.n);
  return square > 0;
}

}  // namespace

GhostTracer::GhostTracer(const Lens& lens, double wavelength_nm, const Losses& given,
                         const SensorReflection& sensor, Tracer::Clip clip)
    : tracer_(lens, wavelength_nm), clip_(clip) {
  require_glass(lens, "ghosts need");
  require_no_bends(lens, "ghosts need");
  const Losses losses = given.of(lens);
  losses.validate(lens);
  sensor.validate();
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
    const Tracer::PreparedSurface& surface = tracer_.surfaces()[i];
    const Coating* coating = losses.coating(i, surface.index_before, surface.index_after);
    if (surface.mirror && !coating)
      surfaces_.push_back(SurfaceReflection::mirror(1, surface.index_before));
    else
      surfaces_.emplace_back(surface.index_before, surface.index_after, coating, wavelength_nm);
    const std::optional<double> k =
        losses.absorption ? lens.medium_behind(i).extinction(wavelength_nm) : std::nullopt;
    absorption_per_mm_.push_back(k ? 4 * pi * *k / (wavelength_nm * mm_per_nm) : 0.0);
  }
  surfaces_.push_back(SurfaceReflection::mirror(sensor.reflectance, tracer_.image_index()));
  orders_ = pixel_grating_orders(sensor, wavelength_nm);
  for (const GratingOrder& order : orders_)
    if (order.right == 0 && order.up == 0) straight_share_ = order.share;
  if (sensor.microlens_sag_um > 0)
    cosines_per_order_ = wavelength_nm * mm_per_nm / (sensor.pitch_um * mm_per_um * tracer_.image_index());
}

bool GhostTracer::turns_light(std::size_t surface) const {
  const bool mirror = surface < tracer_.surface_count() && tracer_.surfaces()[surface].mirror;
  return !mirror && surfaces_[surface].reflects();
}

std::vector<GhostPair> GhostTracer::pairs() const {
  std::vector<GhostPair> result;
  const std::size_t sensor = tracer_.surface_count();
  for (std::size_t first = 1; first < surfaces_.size(); ++first)
    for (std::size_t second = 0; second < first; ++second) {
      if (!turns_light(first) || !turns_light(second)) continue;
      GhostPair pair{first, second};
      if (first != sensor) result.push_back(pair);
      if (first == sensor)
        for (const GratingOrder& order : orders_) pair.order = order, result.push_back(pair);
    }
  return result;
}

std::vector<GhostPair> GhostTracer::double_pairs() const {
  std::vector<GhostPair> result;
  const auto each = [&](std::size_t from, std::size_t to, const auto& use) {
    for (std::size_t i = from; i < to; ++i)
      if (turns_light(i)) use(i);
  };
  each(1, surfaces_.size(), [&](std::size_t first) {
    each(0, first, [&](std::size_t second) {
      each(second + 1, surfaces_.size(), [&](std::size_t third) {
        each(0, third, [&](std::size_t fourth) { result.push_back({first, second, third, fourth}); });
      });
    });
  });
  return result;
}

GhostLanding GhostTracer::follow(const Ray& start, const GhostPair& pair,
                                 std::vector<std::array<double, 3>>* places) const {
  const std::size_t sensor = tracer_.surface_count();
  Wanderer ray;
  ray.vertex_z = tracer_.vertex_z_mm(0);
  ray.at = {start.point_mm[0],
            start.point_mm[1],
            start.point_mm[2] - ray.vertex_z,
            start.direction[0],
            start.direction[1],
            start.direction[2],
            0};
  ray.light = LightFields::unpolarised(start.direction);
  GhostLanding landing;
  double worst = -1, clear = 1;
  const GratingOrder order = pair.third == GhostPair::none ? pair.order : GratingOrder{0, 0, straight_share_};

  const auto absorb = [&](std::size_t gap, const std::array<double, 3>& from, const Direction& direction) {
    if (absorption_per_mm_[gap] == 0) return;
    const std::array<double, 3> to = ray.place();
    double along = 0;
    for (std::size_t i = 0; i < 3; ++i) along += (to[i] - from[i]) * direction[i];
    clear *= std::exp(-absorption_per_mm_[gap] * std::max(along, 0.0));
  };
  /// The sensor, or a surface: where the ray meets it, in its own axes.
  const auto reach = [&](std::size_t i, double sense, double normal[3]) {
    if (i == sensor) {
      if (!(sense * ray.at.n > 0)) return false;
      const double distance = -ray.at.z / ray.at.n;
      ray.at.x += distance * ray.at.l;
      ray.at.y += distance * ray.at.m;
      ray.at.z = 0;
      return true;
    }
    if (!intersect(tracer_.surfaces()[i], sense, 1, ray.at, normal)) return false;
    worst = std::max(worst, tracer_.clip_share_sq(i, ray.at.x, ray.at.y, clip_) - 1);
    return true;
  };
  /// To surface i, and through it or back from it; false where the ray ends. Fields are in lens space.
  const auto meet = [&](std::size_t i, bool backward, bool reflects) {
    const Tracer::PreparedSurface* surface = i == sensor ? nullptr : &tracer_.surfaces()[i];
    const bool mirror = surface && surface->mirror, posed = surface ? surface->posed : tracer_.sensor_posed();
    const Frame& frame = surface ? surface->frame : tracer_.sensor_frame();
    const double forward = surface ? surface->sense : tracer_.image_sense();
    const double sense = backward && !mirror ? -forward : forward;
    const std::array<double, 3> from = ray.place();
    double normal[3] = {0, 0, 1};
    ray.move_vertex(surface ? surface->vertex_z_mm : tracer_.image_z_mm());
    if (posed) enter_frame(frame, ray.at);
    if (!reach(i, sense, normal)) return false;
    const auto in_lens = [&](const Direction& own) { return posed ? frame.to_lens(own) : own; };
    const Direction before = in_lens(ray.direction()), across = in_lens({normal[0], normal[1], normal[2]});
    if (i == sensor) landing.x_mm = ray.at.x, landing.y_mm = ray.at.y;
    const bool ends = i == sensor && !reflects;
    if (reflects || mirror) {
      reflect(ray.at, normal);
      if (i == sensor) {
        if (!diffract(order.right * cosines_per_order_, order.up * cosines_per_order_, ray.at)) return false;
        clear *= order.share;
      }
    } else if (surface) {
      const double ratio = backward ? surface->index_after / surface->index_before
                                    : surface->index_before / surface->index_after;
      if (!refract(ratio, sense, ray.at, normal)) return false;
    }
    if (posed) leave_frame(frame, ray.at);
    if (backward || i > 0) absorb(backward ? i : i - 1, from, before);
    if (places) places->push_back(ray.place());
    if (ends) return true;
    ray.light = reflects || mirror
                    ? surfaces_[i].reflected(ray.light, before, ray.direction(), across, backward)
                    : surfaces_[i].transmitted(ray.light, before, ray.direction(), across, backward);
    return true;
  };

  std::size_t next = 0;
  for (const auto& [far, near] : {std::pair{pair.first, pair.second}, std::pair{pair.third, pair.fourth}}) {
    if (far == GhostPair::none) break;
    for (; next < far; ++next)
      if (!meet(next, false, false)) return landing;
    if (!meet(far, false, true)) return landing;
    for (std::size_t i = far; i-- > near + 1;)
      if (!meet(i, true, false)) return landing;
    if (!meet(near, true, true)) return landing;
    next = near + 1;
  }
  for (; next < sensor; ++next)
    if (!meet(next, false, false)) return landing;
  if (!meet(sensor, false, false)) return landing;
  landing.arrives = true;
  landing.share = clear * ray.light.power();
  landing.clearance = worst;
  return landing;
}

}  // namespace petzval
