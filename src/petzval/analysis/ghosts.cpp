// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/ghosts.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/ray_transfer.h>
#include <petzval/lens/surface_shape.h>
#include <petzval/trace/tracer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace petzval {

namespace {

/// A surface, and the gap behind it, at one wavelength.
struct GhostSurface {
  double curvature_per_mm = 0, index_before = 1, index_after = 1, gap_mm = 0;
  double clear_mm = std::numeric_limits<double>::infinity();  ///< largest height that passes
  double reflectance = 0;                                     ///< at normal incidence
  double gap_transmittance = 1;

  double power() const { return (index_after - index_before) * curvature_per_mm; }
};

double bare_reflectance(double before, double after) {
  const double r = (before - after) / (before + after);
  return r * r;
}

/// A paraxial ray: height and index × slope, the latter along the unfolded way.
struct UnfoldedRay {
  double height = 0, reduced_slope = 0;

  void refract(double power) { reduced_slope -= power * height; }
  void move(double gap_mm, double index) { height += gap_mm / index * reduced_slope; }
};

/// The unfolded way of a ghost, or of the image if nothing is reflected.
class UnfoldedLens {
 public:
  UnfoldedLens(const Lens& lens, double wavelength_nm, const GhostOptions& options) {
    require_no_mirrors(lens, "ghosts are those of lenses without one");
    double before = lens.object_material.index(wavelength_nm);
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
      const Surface& given = lens.surfaces[i];
      GhostSurface surface;
      surface.curvature_per_mm = vertex_curvature_per_mm(given);
      surface.index_before = before;
      surface.index_after = before = given.material.index(wavelength_nm);
      surface.gap_mm = given.thickness_mm;
      if (given.semi_diameter_mm) surface.clear_mm = *given.semi_diameter_mm;
      if (given.stop) surface.clear_mm = std::min(surface.clear_mm, stop_radius_mm(lens));
      surface.reflectance = reflectance(i, surface, wavelength_nm, options.losses);
      if (options.losses.absorption)
        if (const std::optional<double> k = given.material.extinction(wavelength_nm))
          surface.gap_transmittance =
              std::exp(-4 * pi * *k / (wavelength_nm * mm_per_nm) * std::max(surface.gap_mm, 0.0));
      surfaces_.push_back(surface);
    }
    GhostSurface sensor;
    sensor.index_before = sensor.index_after = before;
    sensor.reflectance = options.sensor_reflectance;
    surfaces_.push_back(sensor);
  }

  std::size_t sensor() const { return surfaces_.size() - 1; }
  const GhostSurface& operator[](std::size_t i) const { return surfaces_[i]; }
  double image_index() const { return surfaces_.back().index_before; }

  /// What happens to a ray from in front of vertex 1 to the sensor. \param turns  where it is reflected,
  /// twice for each way back. \param visit  the height at each surface that it meets.
  template <class Visit>
  UnfoldedRay follow(UnfoldedRay ray, std::span<const std::size_t> turns, Visit&& visit) const {
    std::size_t next = 0;
    for (std::size_t turn = 0; turn + 1 < turns.size(); turn += 2) {
      const std::size_t far = turns[turn], near = turns[turn + 1];
      forwards(ray, next, far, visit);
      // Met from the front; then backwards, where the powers are the same; then from behind.
      ray.refract(-2 * surfaces_[far].index_before * surfaces_[far].curvature_per_mm);
      for (std::size_t i = far; i-- > near;) {
        ray.move(surfaces_[i].gap_mm, surfaces_[i].index_after);
        visit(i, ray.height);
        if (i > near) ray.refract(surfaces_[i].power());
      }
      ray.refract(2 * surfaces_[near].index_after * surfaces_[near].curvature_per_mm);
      ray.move(surfaces_[near].gap_mm, surfaces_[near].index_after);
      next = near + 1;
    }
    forwards(ray, next, sensor(), visit);
    return ray;
  }

  double transmittance(std::span<const std::size_t> turns) const {
    double share = 1;
    const auto through = [&](std::size_t i) { share *= 1 - surfaces_[i].reflectance; };
    const auto along = [&](std::size_t gap) { share *= surfaces_[gap].gap_transmittance; };
    std::size_t next = 0;
    const auto onwards = [&](std::size_t to) {
      for (; next < to; ++next) through(next), along(next);
    };
    for (std::size_t turn = 0; turn + 1 < turns.size(); turn += 2) {
      const std::size_t far = turns[turn], near = turns[turn + 1];
      onwards(far);
      share *= surfaces_[far].reflectance * surfaces_[near].reflectance;
      for (std::size_t i = far; i-- > near;) {
        along(i);
        if (i > near) through(i);
      }
      along(near);
      next = near + 1;
    }
    onwards(sensor());
    return share;
  }

 private:
  static double reflectance(std::size_t index, const GhostSurface& surface, double wavelength_nm,
                            const Losses& losses) {
    if (const Coating* coating = losses.coating(index, surface.index_before, surface.index_after))
      return coating->reflectance(wavelength_nm, surface.index_before, surface.index_after);
    return bare_reflectance(surface.index_before, surface.index_after);
  }

  /// From the front of surface `from` to the front of surface `to`.
  template <class Visit>
  void forwards(UnfoldedRay& ray, std::size_t from, std::size_t to, Visit&& visit) const {
    for (std::size_t i = from; i < to; ++i) {
      visit(i, ray.height);
      ray.refract(surfaces_[i].power());
      ray.move(surfaces_[i].gap_mm, surfaces_[i].index_after);
    }
    if (to < sensor()) visit(to, ray.height);
  }

  std::vector<GhostSurface> surfaces_;
};

/// What paraxial rays make of the light of a source on one way.
struct Way {
  double entrance_mm = 0;  ///< height at vertex 1 of the ray from the axial point that just passes
  double diameter_mm = 0;  ///< of a point's light on the sensor
  double source_mm = 0;    ///< diameter of what each point of the entrance makes of the source there
  double focus_mm = 0;
  double chief_mm = 0;  ///< on the sensor, of one ray through the middle of the stop
  double transmittance = 0;

  /// Over the irradiance of the front: flux over the larger of the two discs.
  double irradiance() const {
    const double widest = std::max(std::abs(diameter_mm), source_mm);
    const double beam = 2 * entrance_mm / widest;
    return transmittance * beam * beam;
  }
};

Way way(const UnfoldedLens& unfolded, const Lens& lens, std::span<const std::size_t> turns,
        double source_diameter_deg) {
  const auto ignore = [](std::size_t, double) {};
  const double slope = lens.object_distance_mm ? 1 / *lens.object_distance_mm : 0;
  Way result;
  result.entrance_mm = std::numeric_limits<double>::infinity();
  const UnfoldedRay axial = unfolded.follow({1, slope}, turns, [&](std::size_t surface, double height) {
    result.entrance_mm = std::min(result.entrance_mm, unfolded[surface].clear_mm / std::abs(height));
  });
  result.diameter_mm = 2 * axial.height * result.entrance_mm;
  result.focus_mm = axial.reduced_slope == 0
                        ? std::copysign(std::numeric_limits<double>::infinity(), axial.height)
                        : -axial.height / axial.reduced_slope * unfolded.image_index();
  // A source that is turned by a small angle moves what one point of the entrance sends.
  const UnfoldedRay turned = unfolded.follow({0, 1}, turns, ignore);
  result.source_mm = std::abs(turned.height) * 2 * std::tan(radians(source_diameter_deg) / 2);
  // Through the middle of the stop, where light first comes to it.
  const auto height_at_stop = [&](const UnfoldedRay& start) {
    double at_stop = 0;
    unfolded.follow(start, {}, [&](std::size_t surface, double height) {
      if (surface == lens.stop_index()) at_stop = height;
    });
    return at_stop;
  };
  const UnfoldedRay chief{-height_at_stop({0, 1}), height_at_stop({1, 0})};
  result.chief_mm = unfolded.follow(chief, turns, ignore).height;
  result.transmittance = unfolded.transmittance(turns);
  return result;
}

/// Of the brightest ghost.
constexpr double least_of_four = 1e-4;

/// The farther one first.
std::vector<std::array<std::size_t, 2>> reflecting_pairs(const UnfoldedLens& unfolded) {
  std::vector<std::array<std::size_t, 2>> pairs;
  for (std::size_t far = 1; far <= unfolded.sensor(); ++far)
    for (std::size_t near = 0; near < far; ++near)
      if (unfolded[far].reflectance > 0 && unfolded[near].reflectance > 0) pairs.push_back({far, near});
  return pairs;
}

}  // namespace

void GhostOptions::validate() const {
  if (!(sensor_reflectance >= 0 && sensor_reflectance <= 1))
    throw InputError(fmt::format("`sensor_reflectance` is {:g}; 0 to 1 would be right", sensor_reflectance));
  if (reflections != 2 && reflections != 4)
    throw InputError(fmt::format("`ghost_reflections` is {}; 2 or 4 would be right", reflections));
  if (!(source_diameter_deg > 0 && source_diameter_deg < 180))
    throw InputError(fmt::format(
        "`source_diameter_deg` is {:g}; more than 0 and less than 180 would be right", source_diameter_deg));
}

std::vector<Ghost> ghosts(const Lens& lens, const GhostOptions& given) {
  require_glass(lens, "ghosts need");
  require_no_bends(lens, "ghosts need");
  lens.validate();
  GhostOptions options = given;
  options.losses = given.losses.of(lens);
  require_centred(lens, "paraxial ghosts are those of centred lenses");
  options.losses.validate(lens);
  options.validate();
  std::vector<Ghost> all;
  const std::vector<double> wavelengths = options.wavelengths_nm.empty()
                                              ? std::vector<double>{lens.reference_wavelength_nm}
                                              : options.wavelengths_nm;
  for (const double wavelength_nm : wavelengths) {
    const UnfoldedLens unfolded(lens, wavelength_nm, options);
    const Way image = way(unfolded, lens, {}, options.source_diameter_deg);
    const auto ghost_of = [&](const std::vector<std::size_t>& turns) {
      const Way found = way(unfolded, lens, turns, options.source_diameter_deg);
      Ghost ghost{turns[0],
                  turns[1],
                  wavelength_nm,
                  found.focus_mm,
                  std::abs(found.diameter_mm),
                  found.chief_mm / image.chief_mm,
                  found.transmittance,
                  found.irradiance(),
                  found.irradiance() / image.irradiance(),
                  {},
                  {}};
      if (turns.size() == 4) ghost.third = turns[2], ghost.fourth = turns[3];
      return ghost;
    };
    std::vector<Ghost> here;
    const std::vector<std::array<std::size_t, 2>> pairs = reflecting_pairs(unfolded);
    double brightest = 0;
    for (const auto& [first, second] : pairs) {
      here.push_back(ghost_of({first, second}));
      brightest = std::max(brightest, here.back().irradiance);
    }
    if (options.reflections == 4)
      for (const auto& [first, second] : pairs)
        for (const auto& [third, fourth] : pairs) {
          if (third <= second) continue;
          const Ghost ghost = ghost_of({first, second, third, fourth});
          if (ghost.irradiance >= least_of_four * brightest) here.push_back(ghost);
        }
    std::stable_sort(here.begin(), here.end(),
                     [](const Ghost& a, const Ghost& b) { return a.irradiance > b.irradiance; });
    all.insert(all.end(), here.begin(), here.end());
  }
  return all;
}

}  // namespace petzval
