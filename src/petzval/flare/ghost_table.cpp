// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/flare/ghost_table.h>
#include <petzval/flare/ghost_way.h>
#include <petzval/flare/source_beam.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace petzval {

namespace {

using Pair = std::array<double, 2>;

/// Columns are derivatives by the first and by the second number.
struct Matrix {
  Pair first{}, second{};

  double determinant() const { return first[0] * second[1] - second[0] * first[1]; }
  Pair operator*(const Pair& by) const {
    return {first[0] * by[0] + second[0] * by[1], first[1] * by[0] + second[1] * by[1]};
  }
  Matrix operator*(const Matrix& by) const { return {*this * by.first, *this * by.second}; }
  Matrix operator+(const Matrix& other) const {
    return {{first[0] + other.first[0], first[1] + other.first[1]},
            {second[0] + other.second[0], second[1] + other.second[1]}};
  }
  Matrix inverse() const {
    const double d = determinant();
    return {{second[1] / d, -first[1] / d}, {-second[0] / d, first[0] / d}};
  }
};

double inner(const Matrix& a, const Matrix& b) {
  return a.first[0] * b.first[0] + a.first[1] * b.first[1] + a.second[0] * b.second[0] +
         a.second[1] * b.second[1];
}

/// Where a ray meets the surfaces of its way, in their own axes; where it lands, and its slope there.
struct Course {
  std::vector<Pair> at;
  Pair sensor{}, slope{};
  double share = 0;
};

/// The surfaces that light of a way meets in order, but for the sensor at its end.
std::vector<std::size_t> surfaces_of(const GhostPair& pair, std::size_t sensor) {
  std::vector<std::size_t> met;
  std::size_t next = 0;
  for (const auto& [far, near] : {std::pair{pair.first, pair.second}, std::pair{pair.third, pair.fourth}}) {
    if (far == GhostPair::none) break;
    for (; next <= far; ++next) met.push_back(next);
    for (std::size_t i = far; i-- > near;) met.push_back(i);
    next = near + 1;
  }
  for (; next < sensor; ++next) met.push_back(next);
  return met;
}

/// Rays of a lens at one wavelength, close beside one another.
class GhostRays {
 public:
  GhostRays(const Lens& lens, double wavelength_nm, const GhostOptions& options)
      : tracer_(lens, wavelength_nm, options.losses, options.sensor_reflectance),
        distance_mm_(lens.object_distance_mm),
        step_mm_(step * tracer_.tracer().stop_radius_mm()) {
    step_slope_ = step_mm_ / std::max(lens.total_track_mm(), tracer_.tracer().stop_radius_mm());
    find_chief(lens);
  }

  const GhostTracer& tracer() const { return tracer_; }
  const Pair& chief() const { return chief_; }

  /// \param source  tangents of its angles from the axis. \param entrance  on the plane of the first vertex.
  std::optional<Course> follow(const Pair& source, const Pair& entrance, const GhostPair& pair) const {
    BrightSource point;
    point.right = source[0], point.up = source[1];
    point.distance_mm = distance_mm_;
    std::vector<std::array<double, 3>> places;
    const GhostLanding end = tracer_.follow(SourceBeam(point).ray(entrance[0], entrance[1]), pair, &places);
    if (!end.arrives) return {};
    Course course;
    course.sensor = {end.x_mm, end.y_mm}, course.share = end.share;
    const std::vector<std::size_t> met = surfaces_of(pair, tracer_.tracer().surface_count());
    for (std::size_t i = 0; i < met.size(); ++i) course.at.push_back(on_surface(met[i], places[i]));
    const auto &last = places[places.size() - 2], &there = places.back();
    const Tracer& lens = tracer_.tracer();
    const auto way =
        lens.sensor_frame().from_lens({there[0] - last[0], there[1] - last[1], there[2] - last[2]});
    const double along = way[2] * lens.image_sense();
    course.slope = {way[0] / along, way[1] / along};
    return course;
  }

  /// By the place at the entrance, or by the source. \param value  a pair of numbers of a Course.
  template <class Value>
  std::optional<Matrix> by(bool source, const GhostPair& pair, Value&& value) const {
    Matrix result;
    for (std::size_t k = 0; k < 2; ++k) {
      const double h = source ? step_slope_ : step_mm_;
      std::array<std::optional<Course>, 2> side;
      for (std::size_t s = 0; s < 2; ++s) {
        Pair at{}, entrance = chief_;
        (source ? at : entrance)[k] += s == 0 ? -h : h;
        side[s] = follow(at, entrance, pair);
        if (!side[s]) return {};
      }
      const Pair low = value(*side[0]), high = value(*side[1]);
      (k == 0 ? result.first : result.second) =
          Pair{(high[0] - low[0]) / (2 * h), (high[1] - low[1]) / (2 * h)};
    }
    return result;
  }

 private:
  static constexpr double step = 1e-4;  ///< of the stop: differences are exact to its square

  Pair on_surface(std::size_t i, const std::array<double, 3>& place) const {
    if (i == tracer_.tracer().surface_count()) return {};  // a sensor that reflects stops no light
    const Tracer::PreparedSurface& surface = tracer_.tracer().surfaces()[i];
    const auto own = surface.frame.point_from_lens(place, surface.vertex_z_mm);
    return {own[0], own[1]};
  }

  /// Newton's method on the place at the stop.
  void find_chief(const Lens& lens) {
    const std::size_t stop = tracer_.tracer().stop_index();
    const auto at_stop = [&](const Course& course) { return course.at[stop]; };
    for (int i = 0; i < 8; ++i) {
      const auto course = follow({}, chief_, GhostPair::straight());
      const auto slopes = course ? by(false, GhostPair::straight(), at_stop) : std::nullopt;
      if (!slopes || !(std::abs(slopes->determinant()) > 0))
        throw InputError(lens.name + ": no light of the middle of the field passes the middle of the stop");
      const Pair move = slopes->inverse() * course->at[stop];
      chief_[0] -= move[0], chief_[1] -= move[1];
      if (std::hypot(move[0], move[1]) < 1e-9 * tracer_.tracer().stop_radius_mm()) break;
    }
  }

  GhostTracer tracer_;
  std::optional<double> distance_mm_;
  double step_mm_, step_slope_ = 0;
  Pair chief_{};
};

/// What rays beside the chief ray make of the light of a source on one way.
struct ChiefWay {
  Course chief = {};
  double focus_mm = 0, entrance_mm = 0, diameter_mm = 0, source_mm = 0;
  Matrix chief_by_source = {};  ///< of rays through the middle of the stop

  double irradiance() const {
    const double beam = 2 * entrance_mm / std::max(diameter_mm, source_mm);
    return chief.share * beam * beam;
  }
};

/// How far along a direction a place stays within a radius: the positive root of |q + s d| = R.
double reach(const Pair& q, const Pair& d, double radius_sq) {
  const double a = d[0] * d[0] + d[1] * d[1], b = q[0] * d[0] + q[1] * d[1],
               c = q[0] * q[0] + q[1] * q[1] - radius_sq;
  if (c > 0) return 0;
  if (a == 0 || !std::isfinite(c)) return std::numeric_limits<double>::infinity();
  return (std::sqrt(b * b - a * c) - b) / a;
}

/// Radius of a circle with the area of the entrance whose light passes.
double entrance_mm(const GhostRays& rays, const GhostPair& pair, const Course& chief) {
  const Tracer& tracer = rays.tracer().tracer();
  const std::vector<std::size_t> met = surfaces_of(pair, tracer.surface_count());
  std::vector<Matrix> moves;
  for (std::size_t i = 0; i < met.size(); ++i) {
    const auto move = rays.by(false, pair, [&](const Course& course) { return course.at[i]; });
    if (!move) return 0;
    moves.push_back(*move);
  }
  constexpr int azimuths = 64;
  double square = 0;
  for (int k = 0; k < azimuths; ++k) {
    const double angle = 2 * pi * k / azimuths;
    double farthest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < met.size(); ++i) {
      if (met[i] == tracer.surface_count()) continue;
      farthest = std::min(farthest, reach(chief.at[i], moves[i] * Pair{std::cos(angle), std::sin(angle)},
                                          tracer.clip_radius_sq(met[i], Tracer::Clip::apertures)));
    }
    square += farthest * farthest / azimuths;
  }
  return std::sqrt(square);
}

std::optional<ChiefWay> chief_way(const GhostRays& rays, const GhostPair& pair, const Matrix& chief_by_source,
                                  double source_diameter_deg) {
  const auto chief = rays.follow({}, rays.chief(), pair);
  if (!chief) return {};
  const auto on_sensor = [](const Course& course) { return course.sensor; };
  const auto across = rays.by(false, pair, on_sensor);
  const auto turned = rays.by(true, pair, on_sensor);
  const auto slopes = rays.by(false, pair, [](const Course& course) { return course.slope; });
  if (!across || !turned || !slopes) return {};
  ChiefWay way;
  way.chief = *chief;
  const double change = inner(*slopes, *slopes);
  way.focus_mm = change == 0 ? std::numeric_limits<double>::infinity() : -inner(*across, *slopes) / change;
  way.entrance_mm = entrance_mm(rays, pair, *chief);
  way.diameter_mm = 2 * way.entrance_mm * std::sqrt(std::abs(across->determinant()));
  way.source_mm = 2 * std::tan(radians(source_diameter_deg) / 2) * std::sqrt(std::abs(turned->determinant()));
  way.chief_by_source = *turned + *across * chief_by_source;
  return way;
}

/// Of the brightest ghost.
constexpr double least_of_four_about_chief = 1e-4;

void add_ghosts(const Lens& lens, double wavelength_nm, const GhostOptions& options,
                std::vector<PosedGhost>& all) {
  const GhostRays rays(lens, wavelength_nm, options);
  const std::size_t stop = rays.tracer().tracer().stop_index();
  const auto at_stop = [&](const Course& course) { return course.at[stop]; };
  const auto by_entrance = rays.by(false, GhostPair::straight(), at_stop),
             by_source = rays.by(true, GhostPair::straight(), at_stop);
  // How the entrance moves with the source for rays through the middle of the stop.
  const Matrix back = by_entrance->inverse();
  const Matrix moved =
      Matrix{{-back.first[0], -back.first[1]}, {-back.second[0], -back.second[1]}} * *by_source;
  const auto image = chief_way(rays, GhostPair::straight(), moved, options.source_diameter_deg);
  if (!image) throw InputError(lens.name + ": no light of the middle of the field reaches the sensor");
  std::vector<PosedGhost> here;
  double brightest = 0;
  const auto add = [&](const GhostPair& pair, double least) {
    const auto way = chief_way(rays, pair, moved, options.source_diameter_deg);
    if (!way || way->irradiance() < least) return;
    Ghost ghost{pair.first,
                pair.second,
                wavelength_nm,
                way->focus_mm,
                way->diameter_mm,
                inner(way->chief_by_source, image->chief_by_source) /
                    inner(image->chief_by_source, image->chief_by_source),
                way->chief.share,
                way->irradiance(),
                way->irradiance() / image->irradiance(),
                {},
                {}};
    if (pair.third != GhostPair::none) ghost.third = pair.third, ghost.fourth = pair.fourth;
    brightest = std::max(brightest, ghost.irradiance);
    here.push_back({ghost, way->chief.sensor[0] - image->chief.sensor[0],
                    way->chief.sensor[1] - image->chief.sensor[1]});
  };
  for (const GhostPair& pair : rays.tracer().pairs()) add(pair, 0);
  const double least = least_of_four_about_chief * brightest;
  if (options.reflections == 4)
    for (const GhostPair& pair : rays.tracer().double_pairs()) add(pair, least);
  std::ranges::stable_sort(
      here, [](const PosedGhost& a, const PosedGhost& b) { return a.ghost.irradiance > b.ghost.irradiance; });
  all.insert(all.end(), here.begin(), here.end());
}

}  // namespace

std::vector<PosedGhost> ghosts_about_chief_ray(const Lens& lens, const GhostOptions& given) {
  lens.validate();
  GhostOptions options = given;
  options.losses = given.losses.of(lens);
  options.validate();
  if (options.wavelengths_nm.empty()) options.wavelengths_nm = {lens.reference_wavelength_nm};
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
    if (std::ranges::any_of(lens.surfaces[i].apertures,
                            [](const ApertureFigure& each) { return !each.is_round(); }))
      throw InputError(
          fmt::format("{0}: surfaces[{1}].apertures are not round, and the list of ghosts is that of "
                      "round ones; set surfaces[{1}].apertures=null",
                      lens.name, i));
  std::vector<PosedGhost> all;
  for (const double wavelength_nm : options.wavelengths_nm) add_ghosts(lens, wavelength_nm, options, all);
  return all;
}

}  // namespace petzval
