// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/ray_transfer.h>
#include <petzval/lens/surface_kind.h>
#include <petzval/lens/surface_shape.h>
#include <petzval/trace/kernel_path.h>
#include <petzval/trace/surface_step.h>
#include <petzval/trace/tracer.h>
#include <petzval/trace/transfer_step.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

SurfaceRay relative_to_vertex(const Ray& ray, double vertex_z) {
  return {ray.point_mm[0],  ray.point_mm[1], ray.point_mm[2] - vertex_z, ray.direction[0], ray.direction[1],
          ray.direction[2], ray.opl_mm};
}

/// To the ray's point nearest to the first vertex, at most a beam's width away: from the far end of a long
/// way the quadratic of a surface would lose its digits.
void come_near(const Tracer::PreparedSurface& first, bool backward, SurfaceRay& ray) {
  const double distance = -(ray.x * ray.l + ray.y * ray.m + ray.z * ray.n);
  ray.x += distance * ray.l;
  ray.y += distance * ray.m;
  ray.z += distance * ray.n;
  ray.opl += distance * (backward ? first.index_after : first.index_before);
}

void store(const SurfaceRay& from, double vertex_z, Ray& ray) {
  ray.point_mm = {from.x, from.y, from.z + vertex_z};
  ray.direction = {from.l, from.m, from.n};
  ray.opl_mm = from.opl;
}

/// Turns a ray towards another's place.
void aim_at(const SurfaceRay& target, SurfaceRay& ray) {
  const double x = target.x - ray.x, y = target.y - ray.y, z = target.z - ray.z;
  const double length = std::sqrt(x * x + y * y + z * z);
  ray.l = x / length, ray.m = y / length, ray.n = z / length;
}

/// Walks the surfaces in the sense of travel. `visit(index, ray at the surface, (r/r_clear)² of other
/// apertures there)` is called after each intersection, before refraction, in the surface's own axes, and
/// ends the walk by returning false; `after(index, ray, normal)` after refraction, in lens space but for the
/// normal.
template <class Visit, class After>
void walk(const std::vector<Tracer::PreparedSurface>& surfaces, bool backward, Ray& ray, Visit&& visit,
          After&& after) {
  const std::size_t count = surfaces.size();
  double vertex_z = surfaces[backward ? count - 1 : 0].vertex_z_mm;
  SurfaceRay at = relative_to_vertex(ray, vertex_z);
  come_near(surfaces[backward ? count - 1 : 0], backward, at);
  for (std::size_t step = 0; step < count; ++step) {
    const std::size_t i = backward ? count - 1 - step : step;
    const Tracer::PreparedSurface& surface = surfaces[i];
    at.z += vertex_z - surface.vertex_z_mm;
    vertex_z = surface.vertex_z_mm;
    const double before = backward ? surface.index_after : surface.index_before;
    const double behind = backward ? surface.index_before : surface.index_after;
    // Light leaves a mirror in the other sense; a ray that goes back comes against that.
    const double sense = backward ? (surface.mirror ? surface.sense : -surface.sense) : surface.sense;
    double normal[3] = {0, 0, 1};
    if (surface.posed) enter_frame(surface.frame, at);
    SurfaceRay met = at;
    if (surface.transfer) {
      TransferCrossing crossing;
      if (!carry(*surface.transfer, backward, at, crossing)) {
        ray.status = RayStatus::missed;
      } else {
        // Clipped where it meets the stop, and seen on the front plane, on its way straight across.
        SurfaceRay at_stop = crossing.front;
        at_stop.x = crossing.stop_x, at_stop.y = crossing.stop_y;
        if (!visit(i, at_stop, crossing.others_sq)) ray.status = RayStatus::vignetted;
        met = crossing.front;
        if (!backward) aim_at(at, met);
      }
    } else if (!intersect(surface, sense, before, at, normal)) {
      ray.status = RayStatus::missed;
    } else if (visit(i, at, 0.0)) {
      if (surface.bend) {
        if (!bend(backward ? surface.bend->turned_back() : *surface.bend, sense, at, normal))
          ray.status = RayStatus::tir;
      } else if (surface.mirror)
        reflect(at, normal);
      else if (!refract(before / behind, sense, at, normal))
        ray.status = RayStatus::tir;
      met = at;
    } else {
      ray.status = RayStatus::vignetted;
    }
    if (surface.posed) {
      leave_frame(surface.frame, at);
      leave_frame(surface.frame, met);
    }
    if (ray.status != RayStatus::ok) {
      ray.failed_at = static_cast<int>(i);
      break;
    }
    after(i, met, normal);
  }
  store(at, vertex_z, ray);
}

/// Image space of light that runs towards −z, seen in a mirror, and back.
void flip_image_space(const Tracer& tracer, Ray& ray) {
  if (tracer.image_sense() > 0) return;
  ray.point_mm[2] = tracer.image_z_mm() - (ray.point_mm[2] - tracer.image_z_mm());
  ray.direction[2] = -ray.direction[2];
}

/// Carries a ray that has passed all surfaces to the image plane, in the axes of the sensor.
void reach_image(const Tracer& tracer, Ray& ray) {
  if (ray.status != RayStatus::ok) return;
  if (tracer.sensor_posed()) {
    SurfaceRay at = relative_to_vertex(ray, tracer.image_z_mm());
    enter_frame(tracer.sensor_frame(), at);
    store(at, tracer.image_z_mm(), ray);
  }
  flip_image_space(tracer, ray);
  if (!(ray.direction[2] > 0)) {
    ray.status = RayStatus::missed;
    ray.failed_at = static_cast<int>(tracer.surface_count());
    return;
  }
  const double distance = (tracer.image_z_mm() - ray.point_mm[2]) / ray.direction[2];
  for (int axis = 0; axis < 2; ++axis) ray.point_mm[axis] += distance * ray.direction[axis];
  ray.point_mm[2] = tracer.image_z_mm();
  ray.opl_mm += tracer.image_index() * distance;
}

/// From the axes of the sensor into lens space.
void leave_image(const Tracer& tracer, Ray& ray) {
  flip_image_space(tracer, ray);
  if (!tracer.sensor_posed()) return;
  SurfaceRay at = relative_to_vertex(ray, tracer.image_z_mm());
  leave_frame(tracer.sensor_frame(), at);
  store(at, tracer.image_z_mm(), ray);
}

}  // namespace

Tracer::Tracer(const Lens& lens, double wavelength_nm)
    : Tracer(lens, wavelength_nm, petzval::stop_radius_mm(lens)) {}

Tracer::Tracer(const Lens& lens, double wavelength_nm, double stop_radius_mm)
    : wavelength_nm_(wavelength_nm), stop_index_(lens.stop_index()), stop_radius_mm_(stop_radius_mm) {
  double z = 0, index = lens.object_material.index(wavelength_nm), sense = 1;
  const std::vector<Frame> frames = frames_of(lens);
  for (const Surface& surface : lens.surfaces) {
    PreparedSurface prepared;
    prepared.frame = frames[surfaces_.size()];
    prepared.posed = !prepared.frame.is_none();
    centred_ = centred_ && prepared.frame.is_centred();
    prepared.shape = shape_of(surface);
    prepared.vertex_z_mm = z;
    prepared.index_before = index;
    prepared.mirror = surface.mirror;
    prepared.sense = sense;
    if (surface.mirror) sense = -sense;
    if (!surface.mirror) index = surface.material.index(wavelength_nm);
    prepared.index_after = index;
    prepared.apertures = surface.apertures;
    prepared.bend = bend_data(lens, surfaces_.size(), wavelength_nm, prepared.index_before, index);
    prepared.axes_count = surface.grating || (surface.shape && !surface_kind(surface.shape->kind).is_round);
    centred_ = centred_ && !prepared.axes_count &&
               std::all_of(surface.apertures.begin(), surface.apertures.end(),
                           [](const ApertureFigure& figure) { return figure.is_round(); });
    prepared.clear_radius_sq =
        surface.semi_diameter_mm ? *surface.semi_diameter_mm * *surface.semi_diameter_mm : infinity;
    if (surface.transfer) prepared.transfer = surface.transfer->at(wavelength_nm);
    surfaces_.push_back(std::move(prepared));
    z += surface.thickness_mm;
  }
  image_z_mm_ = z;
  image_sense_ = sense;
  sensor_frame_ = frames.back();
  sensor_posed_ = !sensor_frame_.is_none();
  centred_ = centred_ && sensor_frame_.is_centred();
  if (std::isfinite(stop_radius_mm)) {
    blades_ = lens.stop_blades();
    blade_normals_ = blades_.normals();
  }
}

double Tracer::clip_radius_sq(std::size_t surface, Clip clip) const {
  double limit = infinity;
  if (clip == Clip::apertures) limit = surfaces_[surface].clear_radius_sq;
  if (clip != Clip::none && surface == stop_index_)
    limit = std::min(limit, stop_radius_mm_ * stop_radius_mm_);
  return limit * (1 + rim_tolerance);
}

double Tracer::clip_share_sq(std::size_t surface, double x_mm, double y_mm, Clip clip,
                             bool with_obscurations) const {
  double share = (x_mm * x_mm + y_mm * y_mm) / clip_radius_sq(surface, clip);
  if (clip == Clip::apertures)
    for (const ApertureFigure& figure : surfaces_[surface].apertures)
      if (!figure.obscures || with_obscurations)
        share = std::max(share, figure.share_sq(x_mm, y_mm) / (1 + rim_tolerance));
  if (blade_normals_.empty() || surface != stop_index_ || clip == Clip::none) return share;
  double farthest = 0;
  for (const auto& [nx, ny] : blade_normals_) farthest = std::max(farthest, nx * x_mm + ny * y_mm);
  const double distance = stop_radius_mm_ * blades_.apothem();
  return std::max(share, farthest * farthest / (distance * distance * (1 + rim_tolerance)));
}

Tracer Tracer::with_blades(const StopBlades& blades) const {
  blades.validate();
  if (blades.count > 0 && !std::isfinite(stop_radius_mm_))
    throw InputError("blades close a stop of some radius, and this one is unbounded");
  Tracer bladed = *this;
  bladed.blades_ = blades;
  bladed.blade_normals_ = blades.normals();
  return bladed;
}

Tracer Tracer::turned(double angle) const {
  Tracer result = *this;
  for (PreparedSurface& surface : result.surfaces_) {
    for (ApertureFigure& figure : surface.apertures)
      if (!surface.axes_count) figure = figure.turned(angle);
    surface.frame = surface.axes_count ? surface.frame.turned_with_axes(angle) : surface.frame.turned(angle);
    surface.posed = surface.posed || surface.axes_count;
  }
  result.sensor_frame_ = sensor_frame_.turned(angle);
  result.blades_.rotation_deg += degrees(angle);
  result.blade_normals_ = result.blades_.normals();
  return result;
}

Tracer Tracer::mirrored() const {
  Tracer result = *this;
  for (PreparedSurface& surface : result.surfaces_) {
    for (ApertureFigure& figure : surface.apertures)
      if (!surface.axes_count) figure = figure.mirrored();
    surface.frame = surface.axes_count ? surface.frame.mirrored_with_axes() : surface.frame.mirrored();
    surface.posed = surface.posed || surface.axes_count;
  }
  result.sensor_frame_ = sensor_frame_.mirrored();
  result.blades_.rotation_deg = -blades_.rotation_deg;
  result.blade_normals_ = result.blades_.normals();
  return result;
}

namespace {

void trace_one(const Tracer& tracer, bool backward, Tracer::Clip clip, Ray& ray,
               std::vector<Intersection>* path) {
  if (backward) leave_image(tracer, ray);
  walk(
      tracer.surfaces(), backward, ray,
      [&](std::size_t i, const SurfaceRay& at, double others_sq) {
        return tracer.clip_share_sq(i, at.x, at.y, clip) <= 1 &&
               (clip != Tracer::Clip::apertures || others_sq <= 1 + Tracer::rim_tolerance);
      },
      [&](std::size_t i, const SurfaceRay& at, const double* normal) {
        if (path)
          path->push_back({{at.x, at.y, at.z + tracer.vertex_z_mm(i)},
                           {at.l, at.m, at.n},
                           tracer.surfaces()[i].frame.to_lens({normal[0], normal[1], normal[2]})});
      });
  if (!backward) {
    reach_image(tracer, ray);
    if (!path || ray.status != RayStatus::ok) return;
    Ray in_lens = ray;
    leave_image(tracer, in_lens);
    path->push_back({in_lens.point_mm, in_lens.direction, tracer.sensor_frame().to_lens({0, 0, 1})});
  }
}

void trace_ray_of_batch(const Tracer& tracer, bool backward, Tracer::Clip clip, RayBatch& rays,
                        std::size_t i) {
  Ray ray{{rays.x_mm[i], rays.y_mm[i], rays.z_mm[i]}, {rays.l[i], rays.m[i], rays.n[i]}, rays.opl_mm[i]};
  trace_one(tracer, backward, clip, ray, nullptr);
  rays.x_mm[i] = ray.point_mm[0];
  rays.y_mm[i] = ray.point_mm[1];
  rays.z_mm[i] = ray.point_mm[2];
  rays.l[i] = ray.direction[0];
  rays.m[i] = ray.direction[1];
  rays.n[i] = ray.direction[2];
  rays.opl_mm[i] = ray.opl_mm;
  rays.status[i] = ray.status;
  rays.failed_at[i] = static_cast<std::int16_t>(ray.failed_at);
}

void trace_batch(const Tracer& tracer, bool backward, Tracer::Clip clip, RayBatch& rays) {
  const bool all_alive = std::all_of(rays.status.begin(), rays.status.end(),
                                     [](RayStatus status) { return status == RayStatus::ok; });
  // The SIMD kernel leaves a ray that fails as it was: the scalar trace says why and where.
  std::vector<std::uint8_t> passes(rays.size(), 0);
  if (all_alive && rays.size() > 0)
    trace_columns(kernel_path<double>(tracer, backward, clip),
                  {rays.x_mm.data(), rays.y_mm.data(), rays.z_mm.data(), rays.l.data(), rays.m.data(),
                   rays.n.data(), rays.opl_mm.data(), passes.data(), rays.size()});
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (!passes[i] && rays.status[i] == RayStatus::ok) trace_ray_of_batch(tracer, backward, clip, rays, i);
}

}  // namespace

void Tracer::trace(RayBatch& rays, Clip clip) const {
  trace_batch(*this, false, clip, rays);
}
void Tracer::trace_backward(RayBatch& rays, Clip clip) const {
  trace_batch(*this, true, clip, rays);
}

Ray Tracer::trace(Ray ray, Clip clip, std::vector<Intersection>* path) const {
  trace_one(*this, false, clip, ray, path);
  return ray;
}

Ray Tracer::trace_backward(Ray ray, Clip clip, std::vector<Intersection>* path) const {
  trace_one(*this, true, clip, ray, path);
  return ray;
}

Ray Tracer::from_image(Ray ray) const {
  leave_image(*this, ray);
  return ray;
}

Tracer::Clearance Tracer::clearance(const Ray& ray, bool backward, Clip clip) const {
  Clearance result;
  result.ray = ray;
  if (backward) leave_image(*this, result.ray);
  result.worst = -infinity;
  walk(
      surfaces_, backward, result.ray,
      [&](std::size_t i, const SurfaceRay& at, double others_sq) {
        const double share = std::max(clip_share_sq(i, at.x, at.y, clip, false) * (1 + rim_tolerance),
                                      clip == Clip::apertures ? others_sq : 0.0);
        const double excess = share - 1;
        if (excess > result.worst) {
          result.worst = excess;
          result.surface = static_cast<int>(i);
        }
        if (i == stop_index_) {
          result.stop_x_mm = at.x;
          result.stop_y_mm = at.y;
          result.reached_stop = true;
        }
        return true;
      },
      [](std::size_t, const SurfaceRay&, const double*) {});
  if (!backward) reach_image(*this, result.ray);
  if (result.ray.status != RayStatus::ok) {
    result.worst = infinity;
    result.surface = result.ray.failed_at;
  }
  return result;
}

}  // namespace petzval
