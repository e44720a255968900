// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/numeric/random.h>
#include <petzval/render/camera/stop_diffraction.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval::render {

namespace {

/// Nearer to an edge than this, light is bent out of every lens.
constexpr double least_distance_mm = 1e-9;
/// Numbers in [0, 1) for the quantile, whose ends lie at infinity.
constexpr double least_share = 0x1p-40;

double normal(double share) {
  return normal_quantile(std::clamp(share, least_share, 1 - least_share));
}

}  // namespace

StopDiffraction::StopDiffraction(const Tracer& tracer, double wavelength_nm)
    : to_stop_(kernel_path<double>(tracer, true, Tracer::Clip::apertures)),
      to_scene_(to_stop_),
      radius_mm_(tracer.stop_radius_mm()),
      edges_(tracer.stop_blades().normals()) {
  if (!std::isfinite(radius_mm_))
    throw InputError("diffraction needs a stop with a radius; an aperture of the lens would give one");
  if (tracer.surfaces()[tracer.stop_index()].transfer)
    throw InputError("diffraction bends rays at a stop, and that of a ray transfer is not to be reached");
  for (const Tracer::PreparedSurface& surface : tracer.surfaces())
    if (surface.mirror)
      throw InputError("diffraction bends rays at a stop between lenses, and this lens has mirrors");
  if (tracer.surfaces()[tracer.stop_index()].posed)
    throw InputError("diffraction bends rays at a stop on the axis, and this one has a pose");
  apothem_mm_ = radius_mm_ * tracer.stop_blades().apothem();
  // Light travels backwards, and meets the stop as the surface of this number.
  const std::size_t stop = tracer.surface_count() - 1 - tracer.stop_index();
  const auto behind = to_scene_.surfaces.begin() + static_cast<std::ptrdiff_t>(stop) + 1;
  const double stop_z = to_stop_.flip * tracer.vertex_z_mm(tracer.stop_index());
  to_stop_.surfaces.erase(to_stop_.surfaces.begin() + (behind - to_scene_.surfaces.begin()),
                          to_stop_.surfaces.end());
  to_stop_.last_vertex_z_mm = stop_z;
  to_scene_.surfaces.erase(to_scene_.surfaces.begin(), behind);
  to_scene_.first_vertex_z_mm = stop_z;
  to_scene_.sensor_posed = false;  // left behind on the way to the stop
  wavelength_mm_ = wavelength_nm * mm_per_nm / tracer.surfaces()[tracer.stop_index()].index_before;
}

StopDiffraction::Surroundings StopDiffraction::round_stop(double x_mm, double y_mm) const {
  const double r = std::hypot(x_mm, y_mm);
  Surroundings at;
  if (r > 0) at.across = {x_mm / r, y_mm / r};
  at.to_edge_mm = radius_mm_ - r;
  at.to_sides_mm = std::sqrt(std::max(0.0, radius_mm_ * radius_mm_ - r * r));
  return at;
}

StopDiffraction::Surroundings StopDiffraction::bladed_stop(double x_mm, double y_mm) const {
  Surroundings at;
  at.to_edge_mm = at.to_sides_mm = std::numeric_limits<double>::max();
  const auto to_edge = [&](const std::array<double, 2>& normal) {
    return apothem_mm_ - normal[0] * x_mm - normal[1] * y_mm;
  };
  for (const auto& normal : edges_)
    if (to_edge(normal) < at.to_edge_mm) at.to_edge_mm = to_edge(normal), at.across = normal;
  for (const auto& normal : edges_) {
    const double share = std::abs(normal[1] * at.across[0] - normal[0] * at.across[1]);
    if (share > 1e-9) at.to_sides_mm = std::min(at.to_sides_mm, to_edge(normal) / share);
  }
  return at;
}

/// \return whether the ray still goes forward.
bool StopDiffraction::bend(const RayColumns<double>& rays, std::size_t i,
                           const std::array<double, 2>& numbers) const {
  const Surroundings at =
      edges_.empty() ? round_stop(rays.x[i], rays.y[i]) : bladed_stop(rays.x[i], rays.y[i]);
  const auto width = [&](double distance_mm) {
    return wavelength_mm_ / (4 * pi * std::max(distance_mm, least_distance_mm));
  };
  const double across = width(at.to_edge_mm) * normal(numbers[0]);
  const double along = width(at.to_sides_mm) * normal(numbers[1]);
  rays.l[i] += across * at.across[0] - along * at.across[1];
  rays.m[i] += across * at.across[1] + along * at.across[0];
  const double n2 = 1 - rays.l[i] * rays.l[i] - rays.m[i] * rays.m[i];
  if (!(n2 > 0)) return false;
  rays.n[i] = -std::sqrt(n2);
  return true;
}

void StopDiffraction::trace(const RayColumns<double>& rays,
                            std::span<const std::array<double, 2>> numbers) const {
  trace_columns(to_stop_, rays);
  std::vector<std::uint8_t> goes_on(rays.count);
  for (std::size_t i = 0; i < rays.count; ++i) goes_on[i] = rays.passes[i] && bend(rays, i, numbers[i]);
  // What was bent straight back is no ray; any other direction does, since it counts for nothing.
  for (std::size_t i = 0; i < rays.count; ++i)
    if (!goes_on[i]) rays.l[i] = rays.m[i] = 0, rays.n[i] = -1;
  trace_columns(to_scene_, rays);
  for (std::size_t i = 0; i < rays.count; ++i) rays.passes[i] = rays.passes[i] && goes_on[i];
}

}  // namespace petzval::render
