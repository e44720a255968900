// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/flare/ghost_bundle.h>
#include <petzval/flare/scatter_way.h>
#include <petzval/lens/ray_transfer.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

using Vector = std::array<double, 3>;

double dot_of(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The rectangle of rays that reach a surface.
struct Reached {
  double left = INFINITY, right = -INFINITY, low = INFINITY, high = -INFINITY;

  void add(double x, double y) {
    left = std::min(left, x), right = std::max(right, x);
    low = std::min(low, y), high = std::max(high, y);
  }
  bool any() const { return right >= left; }
};

constexpr int search_rays = 40;

}  // namespace

/// A ray on its way in, at the last surface that it met.
struct ScatterTracer::Inward {
  SurfaceRay ray{};
  double vertex_z = 0;
  Vector before{}, normal{};
  std::array<double, 2> cosines{};  ///< behind it, in its own axes
  double kept = 1;                  ///< what the surfaces in front have not scattered
  std::vector<Intersection> path;

  Vector direction() const { return {ray.l, ray.m, ray.n}; }
  Vector place() const { return {ray.x, ray.y, ray.z + vertex_z}; }
  void move_vertex(double z) {
    ray.z += vertex_z - z;
    vertex_z = z;
  }
};

struct ScatterTracer::Landing {
  double x_mm = 0, y_mm = 0;
  double kept = 1;
  bool passes = true;
};

/// What a ray meets at a surface, in lens space.
struct ScatterTracer::Crossing {
  Vector before{}, normal{};
  std::array<double, 2> cosines{};  ///< behind it, in the surface's own axes
  bool inside = true;               ///< of its apertures
};

/// To a surface and through it, or back from a mirror; false where the ray ends.
bool ScatterTracer::cross(std::size_t i, SurfaceRay& ray, Crossing& at) const {
  const Tracer::PreparedSurface& surface = tracer_.surfaces()[i];
  if (surface.posed) enter_frame(surface.frame, ray);
  double normal[3] = {0, 0, 1};
  if (!intersect(surface, surface.sense, 1, ray, normal)) return false;
  at.inside = tracer_.clip_share_sq(i, ray.x, ray.y, clip_) <= 1 + Tracer::rim_tolerance;
  at.before = {ray.l, ray.m, ray.n};
  at.normal = {normal[0], normal[1], normal[2]};
  if (surface.mirror)
    reflect(ray, normal);
  else if (!refract(surface.index_before / surface.index_after, surface.sense, ray, normal))
    return false;
  at.cosines = {ray.l, ray.m};
  if (!surface.posed) return true;
  leave_frame(surface.frame, ray);
  at.before = surface.frame.to_lens(at.before), at.normal = surface.frame.to_lens(at.normal);
  return true;
}

/// The direction of these cosines behind a surface, in lens space.
std::array<double, 3> ScatterTracer::behind(std::size_t i, const std::array<double, 2>& cosines) const {
  const Tracer::PreparedSurface& surface = tracer_.surfaces()[i];
  const double forward = std::sqrt(std::max(0.0, 1 - cosines[0] * cosines[0] - cosines[1] * cosines[1]));
  const Vector own{cosines[0], cosines[1], (surface.mirror ? -surface.sense : surface.sense) * forward};
  return surface.posed ? surface.frame.to_lens(own) : own;
}

ScatterTracer::ScatterTracer(const Lens& lens, double wavelength_nm, const Losses& losses, Tracer::Clip clip)
    : tracer_(lens, wavelength_nm), clip_(clip) {
  require_glass(lens, "scatter needs");
  require_no_bends(lens, "scatter needs");
  require_clean_mirrors(lens);
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
    const Tracer::PreparedSurface& surface = tracer_.surfaces()[i];
    const bool between = surface.index_before != surface.index_after;
    const std::optional<Scatter>& own = lens.surfaces[i].scatter;
    const std::optional<Scatter>& scatter = own || !between ? own : lens.scatter;
    if (scatter)
      bsdfs_.emplace_back(*scatter, wavelength_nm, surface.index_before, surface.index_after);
    else
      bsdfs_.emplace_back();
  }
  if (losses.of(lens).any()) transmittance_.emplace(lens, wavelength_nm, losses);
}

bool ScatterTracer::scatters() const {
  return std::ranges::any_of(bsdfs_, [](const SurfaceBsdf& bsdf) { return bsdf.scatters(); });
}

bool ScatterTracer::inward(const Ray& start, std::size_t last, Inward& at) const {
  at.vertex_z = tracer_.vertex_z_mm(0);
  at.ray = {start.point_mm[0],
            start.point_mm[1],
            start.point_mm[2] - at.vertex_z,
            start.direction[0],
            start.direction[1],
            start.direction[2],
            0};
  at.kept = 1;
  at.path.clear();
  Crossing met;
  for (std::size_t i = 0; i <= last; ++i) {
    at.move_vertex(tracer_.vertex_z_mm(i));
    if (!cross(i, at.ray, met) || !met.inside) return false;
    at.before = met.before, at.normal = met.normal, at.cosines = met.cosines;
    if (transmittance_) at.path.push_back({at.place(), at.direction(), at.normal});
    if (i < last && bsdfs_[i].scatters())
      at.kept *=
          bsdfs_[i]
              .shares(std::abs(dot_of(at.before, at.normal)), std::abs(dot_of(at.direction(), at.normal)))
              .specular();
  }
  return true;
}

std::optional<LitPlace> ScatterTracer::lit_place(const SourceBeam& beam, double x_mm, double y_mm,
                                                 std::size_t surface) const {
  const Ray start = beam.ray(x_mm, y_mm);
  Inward at;
  if (!inward(start, surface, at)) return {};
  LitPlace place;
  place.point_mm = at.place();
  place.after = at.direction();
  place.cosines = at.cosines;
  place.normal = at.normal;
  place.flux_mm2 = beam.weight(x_mm, y_mm) * at.kept;
  place.kept = at.kept;
  place.cosine_before = std::abs(dot_of(at.before, at.normal));
  place.cosine_after = std::abs(dot_of(place.after, at.normal));
  place.shares = bsdfs_[surface].shares(place.cosine_before, place.cosine_after);
  place.start = start;
  place.path = std::move(at.path);
  return place;
}

template <typename Meet>
bool ScatterTracer::follow_onward(std::size_t surface, const LitPlace& place,
                                  const std::array<double, 2>& direction, Landing& end,
                                  const Meet& meet) const {
  const double flat = direction[0] * direction[0] + direction[1] * direction[1];
  if (!(flat < 1)) return false;
  double vertex_z = 0;
  const Vector towards = behind(surface, direction);
  SurfaceRay ray{
      place.point_mm[0], place.point_mm[1], place.point_mm[2], towards[0], towards[1], towards[2], 0};
  end = {};
  Crossing met;
  for (std::size_t i = surface + 1; i < bsdfs_.size(); ++i) {
    ray.z += vertex_z - tracer_.vertex_z_mm(i);
    vertex_z = tracer_.vertex_z_mm(i);
    if (!cross(i, ray, met)) return false;
    if (!met.inside) end.passes = false;
    meet(i, met.before, Intersection{{ray.x, ray.y, ray.z + vertex_z}, {ray.l, ray.m, ray.n}, met.normal});
  }
  if (tracer_.sensor_posed()) {
    ray.z += vertex_z - tracer_.image_z_mm();
    vertex_z = tracer_.image_z_mm();
    enter_frame(tracer_.sensor_frame(), ray);
  }
  if (!(tracer_.image_sense() * ray.n > 0)) return false;
  const double distance = (tracer_.image_z_mm() - vertex_z - ray.z) / ray.n;
  end.x_mm = ray.x + distance * ray.l;
  end.y_mm = ray.y + distance * ray.m;
  return true;
}

/// d(x, y)/d(L, M), where a ray lands by its direction behind the surface.
struct ScatterTracer::LandingSlopes {
  double xx = 0, xy = 0, yx = 0, yy = 0;

  double determinant() const { return xx * yy - xy * yx; }
};

/// \param end  where the ray of direction `at` lands.
bool ScatterTracer::differentiate(std::size_t surface, const LitPlace& place, const std::array<double, 2>& at,
                                  const Landing& end, LandingSlopes& by) const {
  constexpr double differential = 1e-6;
  Landing beside;
  if (!onward(surface, place, {at[0] + differential, at[1]}, beside)) return false;
  by.xx = (beside.x_mm - end.x_mm) / differential, by.yx = (beside.y_mm - end.y_mm) / differential;
  if (!onward(surface, place, {at[0], at[1] + differential}, beside)) return false;
  by.xy = (beside.x_mm - end.x_mm) / differential, by.yy = (beside.y_mm - end.y_mm) / differential;
  return std::abs(by.determinant()) > 0;
}

bool ScatterTracer::onward(std::size_t surface, const LitPlace& place, const std::array<double, 2>& direction,
                           Landing& end) const {
  return follow_onward(surface, place, direction, end,
                       [](std::size_t, const Vector&, const Intersection&) {});
}

bool ScatterTracer::onward_with_light(std::size_t surface, const LitPlace& place,
                                      const std::array<double, 2>& direction, Landing& end,
                                      std::vector<Intersection>* path) const {
  Vector last = behind(surface, direction);
  if (path && !path->empty()) path->back().direction_after = last;
  double kept = 1;
  const bool arrives = follow_onward(
      surface, place, direction, end, [&](std::size_t i, const Vector& before, const Intersection& met) {
        if (bsdfs_[i].scatters())
          kept *= bsdfs_[i]
                      .shares(std::abs(dot_of(before, met.normal)),
                              std::abs(dot_of(met.direction_after, met.normal)))
                      .specular();
        last = met.direction_after;
        if (path) path->push_back(met);
      });
  end.kept = kept;
  if (!arrives || !path) return arrives;
  Vector place_there{end.x_mm, end.y_mm, tracer_.image_z_mm()};
  if (tracer_.sensor_posed())
    place_there = tracer_.sensor_frame().point_to_lens(place_there, tracer_.image_z_mm());
  path->push_back({place_there, last, tracer_.sensor_frame().to_lens({0, 0, 1})});
  return arrives;
}

SourceImage ScatterTracer::image_of(const std::vector<LitPlace>& behind) const {
  SourceImage image;
  double x = 0, y = 0, sum = 0;
  for (const LitPlace& place : behind) {
    Landing end;
    if (!onward(bsdfs_.size() - 1, place, place.cosines, end)) continue;
    const double through = transmittance_ ? transmittance_->along(place.start, place.path) : 1;
    const double flux = place.flux_mm2 * through;
    image.flux_mm2 += flux * place.shares.specular();
    image.clear_flux_mm2 += flux / place.kept;
    x += flux * end.x_mm, y += flux * end.y_mm, sum += flux;
  }
  if (sum > 0) image.x_mm = x / sum, image.y_mm = y / sum;
  return image;
}

std::vector<std::vector<LitPlace>> ScatterTracer::light(const SourceBeam& beam, int across,
                                                        SourceImage* image) const {
  const std::size_t count = bsdfs_.size();
  const PupilBox front = front_box(tracer_, beam);
  std::vector<Reached> reached(count);
  const double step_x = (front.right - front.left) / search_rays,
               step_y = (front.high - front.low) / search_rays;
  Inward at;
  for (int j = 0; j < search_rays; ++j)
    for (int i = 0; i < search_rays; ++i) {
      const double x = front.left + (i + 0.5) * step_x, y = front.low + (j + 0.5) * step_y;
      const Ray start = beam.ray(x, y);
      // The farthest surface that it passes, by halving.
      std::size_t passed = 0, failed = count + 1;
      while (failed - passed > 1) {
        const std::size_t middle = passed + (failed - passed) / 2;
        (inward(start, middle - 1, at) ? passed : failed) = middle;
      }
      for (std::size_t k = 0; k < passed; ++k) reached[k].add(x, y);
    }
  std::vector<std::vector<LitPlace>> lit(count);
  for (std::size_t k = 0; k < count; ++k) {
    const bool last = k + 1 == count && image != nullptr;
    if (!reached[k].any() || !(bsdfs_[k].scatters() || last)) continue;
    const double left = reached[k].left - step_x, low = reached[k].low - step_y;
    const double cell_x = (reached[k].right + step_x - left) / across,
                 cell_y = (reached[k].high + step_y - low) / across;
    for (int j = 0; j < across; ++j)
      for (int i = 0; i < across; ++i) {
        std::optional<LitPlace> place =
            lit_place(beam, left + (i + 0.5) * cell_x, low + (j + 0.5) * cell_y, k);
        if (!place) continue;
        place->flux_mm2 *= cell_x * cell_y;
        lit[k].push_back(std::move(*place));
      }
  }
  if (image) {
    *image = image_of(lit[count - 1]);
    if (!bsdfs_[count - 1].scatters()) lit[count - 1].clear();
  }
  return lit;
}

/// Newton's method towards a point of the sensor. \param at  where it starts; then the direction that it
/// found.
bool ScatterTracer::aim_onward(std::size_t surface, const LitPlace& place, double x_mm, double y_mm,
                               const std::array<double, 2>& home, std::array<double, 2>& at) const {
  constexpr int most_steps = 25;
  constexpr double longest_step = 0.3, settled = 1e-6, slow = 0.1;
  Landing end;
  LandingSlopes by;
  // The derivatives of the first step serve the next ones as long as these get shorter fast.
  bool found = false, differentiated = false;
  double before = INFINITY;
  for (int step = 0; step < most_steps && !found; ++step) {
    if (!onward(surface, place, at, end)) {
      at = {(at[0] + home[0]) / 2, (at[1] + home[1]) / 2};
      differentiated = false;
      continue;
    }
    if (!differentiated && !differentiate(surface, place, at, end, by)) return false;
    const double determinant = by.determinant();
    const double dx = x_mm - end.x_mm, dy = y_mm - end.y_mm;
    std::array<double, 2> move{(by.yy * dx - by.xy * dy) / determinant,
                               (by.xx * dy - by.yx * dx) / determinant};
    const double length = std::hypot(move[0], move[1]);
    if (!std::isfinite(length)) return false;
    differentiated = length < slow * before || length < settled;
    before = length;
    const double scale = std::min(1.0, longest_step / std::max(length, settled));
    at[0] += scale * move[0], at[1] += scale * move[1];
    found = length < settled;
  }
  return found;
}

std::optional<ScatterLink> ScatterTracer::link(std::size_t surface, const LitPlace& place, double x_mm,
                                               double y_mm,
                                               const std::optional<std::array<double, 2>>& guess) const {
  // The light itself may be too steep for the surfaces behind: then the way starts along the axis.
  Landing end;
  constexpr std::array<double, 2> axis{};
  const std::array<double, 2> home = onward(surface, place, place.cosines, end) ? place.cosines : axis;
  std::array<double, 2> at = guess.value_or(home);
  bool found = aim_onward(surface, place, x_mm, y_mm, home, at);
  for (const std::array<double, 2>& start : {home, axis}) {
    if (found) break;
    at = start;
    found = aim_onward(surface, place, x_mm, y_mm, start, at);
  }
  if (!found) return {};
  std::vector<Intersection> path;
  if (transmittance_) path = place.path;
  if (!onward_with_light(surface, place, at, end, transmittance_ ? &path : nullptr) || !end.passes) return {};
  LandingSlopes by;
  if (!differentiate(surface, place, at, end, by)) return {};
  ScatterLink link;
  link.direction = at;
  const double index = tracer_.surfaces()[surface].index_after;
  const Vector after = behind(surface, at);
  const double forward = std::sqrt(1 - at[0] * at[0] - at[1] * at[1]);
  Vector change;
  for (std::size_t k = 0; k < 3; ++k) change[k] = index * (after[k] - place.after[k]);
  const double along = dot_of(change, place.normal);
  for (std::size_t k = 0; k < 3; ++k) change[k] -= along * place.normal[k];
  link.tau = std::hypot(change[0], change[1], change[2]);
  link.offset = {index * (at[0] - place.cosines[0]), index * (at[1] - place.cosines[1])};
  // d²β = n² cosθ/N dL dM.
  const double density =
      index * index * std::abs(dot_of(after, place.normal)) / forward / std::abs(by.determinant());
  const double through = transmittance_ ? transmittance_->along(place.start, path) : 1;
  link.per_mm2 = place.flux_mm2 * density * end.kept * through;
  return link;
}

void require_clean_mirrors(const Lens& lens) {
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
    if (lens.surfaces[i].mirror && lens.surfaces[i].scatter)
      throw InputError(
          fmt::format("surfaces[{0}] is a mirror, and the scatter of mirrors is not followed; set "
                      "surfaces[{0}].scatter=null",
                      i));
}

Lens with_scatter(Lens lens, const Scatter& scatter) {
  scatter.validate();
  lens.scatter = scatter;
  return lens;
}

bool states_scatter(const Lens& lens) {
  return lens.scatter.has_value() ||
         std::ranges::any_of(lens.surfaces, [](const Surface& each) { return each.scatter.has_value(); });
}

}  // namespace petzval
