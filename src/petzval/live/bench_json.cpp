// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_tables.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/field_values.h>
#include <petzval/analysis/ghosts.h>
#include <petzval/analysis/ray_fan.h>
#include <petzval/base/units.h>
#include <petzval/flare/ghost_fan.h>
#include <petzval/glass/catalogue.h>
#include <petzval/lens/first_order.h>
#include <petzval/live/bench_json.h>
#include <petzval/report/colours.h>
#include <petzval/report/lens_drawing.h>
#include <petzval/report/surface_profile.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <optional>

namespace petzval {

using nlohmann::json;

namespace {

json finite_or_null(double value) {
  return std::isfinite(value) ? json(value) : json();
}

/// With as many digits as a screen shows.
json short_values(const std::vector<double>& values) {
  json list = json::array();
  for (const double value : values) list.push_back(finite_or_null(static_cast<float>(value)));
  return list;
}

json axis_json(const PlotAxis& axis) {
  return {{"label", axis.label},
          {"unit", axis.unit},
          {"log", axis.scale == PlotScale::logarithmic},
          {"from", axis.from ? finite_or_null(*axis.from) : json()},
          {"to", axis.to ? finite_or_null(*axis.to) : json()}};
}

/// z and y of one point after the other, to 0.01 um: finer than a screen shows of any lens, and soon written
/// and read.
json points_json(const std::vector<PlanePoint>& points) {
  constexpr double steps_a_mm = 1e5;
  json::array_t list;
  list.reserve(2 * points.size());
  for (const auto& [z, y] : points)
    if (std::isfinite(z) && std::isfinite(y))
      for (const double at : {z, y}) list.emplace_back(std::round(at * steps_a_mm) / steps_a_mm);
  return list;
}

json first_order_json(const Lens& lens) {
  const FirstOrder data = first_order(lens);
  return {{"efl_mm", finite_or_null(data.efl_mm)},
          {"bfl_mm", finite_or_null(data.bfl_mm)},
          {"f_number", finite_or_null(data.f_number)},
          {"working_f_number", finite_or_null(data.working_f_number)},
          {"image_space_na", finite_or_null(data.image_space_na)},
          {"field_of_view_deg", finite_or_null(data.field_of_view_deg)},
          {"magnification", finite_or_null(data.magnification)},
          {"total_track_mm", finite_or_null(data.total_track_mm)},
          {"paraxial_image_mm", finite_or_null(data.paraxial_image_mm)},
          {"petzval_radius_mm", finite_or_null(data.petzval_radius_mm)},
          {"entrance_pupil_mm", finite_or_null(data.entrance_pupil.position_mm)},
          {"entrance_pupil_diameter_mm", finite_or_null(data.entrance_pupil.diameter_mm)},
          {"exit_pupil_mm", finite_or_null(data.exit_pupil.position_mm)},
          {"exit_pupil_diameter_mm", finite_or_null(data.exit_pupil.diameter_mm)},
          {"stop_semi_diameter_mm", finite_or_null(data.stop_semi_diameter_mm)}};
}

struct LayoutRays {
  std::vector<DrawnRay> drawn;
  json fields = json::array(), blocked = json::array();
};

LayoutRays layout_rays(const Lens& lens) {
  constexpr int rays_a_field = 5;
  constexpr double lead = 0.25;  // of the length of the lens
  LayoutRays rays;
  FieldTracer tracer(lens, lens.reference_wavelength_nm);
  const FieldTableRequest at = FieldTableRequest::of(lens);
  for (std::size_t i = 0; i < at.fields.size(); ++i) {
    const double field = object_field(lens, at.field_kind, at.fields[i]);
    json paths = json::array();
    for (const MeridionalPath& path :
         meridional_fan(tracer, field, rays_a_field, lead * lens.total_track_mm())) {
      rays.drawn.push_back({path, series_colour(i).hex()});
      paths.push_back(points_json({path.begin(), path.end()}));
    }
    if (paths.empty()) {
      int surface = -1;
      const std::string why = blocking_surface(tracer.tracer(), lens, field, surface);
      rays.blocked.push_back({{"field", at.fields[i]}, {"surface", surface}, {"text", why}});
    }
    rays.fields.push_back({{"value", at.fields[i]},
                           {"unit", field_unit(at.field_kind)},
                           {"colour", series_colour(i).hex()},
                           {"rays", std::move(paths)}});
  }
  return rays;
}

/// Rays of the sun, as far from the axis as it stands, or else along it.
json ghost_way(const CoatedLens& coated, const std::optional<Sun>& sun, const GhostPair& pair,
               double sensor_reflectance) {
  const Lens& lens = coated.lens;
  if (pair.first > lens.surfaces.size()) return json::array();
  constexpr int rays_a_source = 7;
  constexpr double lead = 0.25;  // of the length of the lens
  const GhostTracer tracer(lens, lens.reference_wavelength_nm, coated.losses, sensor_reflectance);
  BrightSource source;
  if (sun) {
    const double up = std::tan(radians(sun->up_deg));
    source.up = std::copysign(std::hypot(std::tan(radians(sun->right_deg)), up), up);
  }
  json rays = json::array();
  for (const GhostRay& ray :
       ghost_fan(tracer, pair, SourceBeam(source), rays_a_source, lead * lens.total_track_mm()))
    rays.push_back(points_json({ray.begin(), ray.end()}));
  return rays;
}

json sky_heights(Lens lens) {
  constexpr int steps = 32;
  constexpr double most_deg = 79;
  lens.object_distance_mm.reset();
  FieldTracer tracer(lens, lens.reference_wavelength_nm, Tracer::Clip::stop_only);
  json heights = json::array({{0, 0}});
  double before = 0;
  for (int i = 1; i <= steps; ++i) {
    const double angle_deg = most_deg * i / steps;
    const std::optional<ChiefRay> chief = tracer.chief_ray(angle_deg);
    if (!chief || !(std::abs(chief->image_height_mm) > before)) break;
    before = std::abs(chief->image_height_mm);
    heights.push_back({std::tan(radians(angle_deg)), before});
  }
  return heights;
}

/// A number of a search such as "1.62 60".
std::optional<std::array<double, 2>> two_numbers(const std::string& text) {
  double nd = 0, vd = 0;
  int end = 0;
  if (std::sscanf(text.c_str(), "%lf%*[ ,/]%lf %n", &nd, &vd, &end) < 2) return {};
  if (static_cast<std::size_t>(end) != text.size() || !(nd >= 1 && nd < 5 && vd > 0 && vd < 200)) return {};
  return std::array<double, 2>{nd, vd};
}

std::string letters_and_digits(const std::string& text) {
  std::string kept;
  for (const char c : text)
    if (std::isalnum(static_cast<unsigned char>(c)))
      kept += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return kept;
}

struct KnownGlass {
  std::string name, letters, status;
  double nd, vd;
};

/// Read once: what a search goes through.
const std::vector<KnownGlass>& known_glasses() {
  static const std::vector<KnownGlass> all = [] {
    std::vector<KnownGlass> list;
    const GlassCatalogue& catalogue = GlassCatalogue::bundled();
    for (const std::string& name : catalogue.full_names()) {
      const auto glass = catalogue.find(name);
      if (const auto abbe = glass->abbe())
        list.push_back({name, letters_and_digits(glass->name), glass->status, abbe->nd, abbe->vd});
    }
    return list;
  }();
  return all;
}

/// How far a glass is from what is sought: in steps of 0.001 of nd and 0.1 of Vd, or by how much its name
/// goes on.
double misfit(const KnownGlass& glass, const std::optional<std::array<double, 2>>& numbers,
              const std::string& letters) {
  constexpr double nd_step = 1e-3, vd_step = 0.1;
  if (numbers) return std::hypot((glass.nd - (*numbers)[0]) / nd_step, (glass.vd - (*numbers)[1]) / vd_step);
  const std::size_t at = letters_and_digits(glass.name).find(letters);
  if (at == std::string::npos) return INFINITY;
  constexpr double inside = 0.5;
  return static_cast<double>(glass.letters.size()) + (glass.letters.starts_with(letters) ? 0 : inside);
}

}  // namespace

json plot_json(const Plot& plot) {
  json series = json::array(), guides = json::array();
  for (const PlotSeries& line : plot.series)
    series.push_back({{"label", line.label},
                      {"x", short_values(line.x)},
                      {"y", short_values(line.y)},
                      {"stroke", static_cast<int>(line.stroke)},
                      {"marker", static_cast<int>(line.marker)},
                      {"colour", line.colour}});
  for (const PlotGuide& guide : plot.guides)
    guides.push_back({{"x", guide.at == PlotGuide::At::x}, {"value", guide.value}, {"label", guide.label}});
  return {{"title", plot.title},         {"x", axis_json(plot.x)},      {"y", axis_json(plot.y)},
          {"series", std::move(series)}, {"guides", std::move(guides)}, {"equal", plot.equal_aspect}};
}

json layout_json(const Lens& lens) {
  LayoutRays rays = layout_rays(lens);
  const std::vector<double> heights = drawn_semi_diameters_mm(lens, rays.drawn, {});
  json surfaces = json::array(), elements = json::array();
  std::vector<PlanePoint> before;
  double z = 0;
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
    const Surface& surface = lens.surfaces[i];
    const std::vector<PlanePoint> here = profile(surface, z, heights[i]);
    if (i > 0 && !lens.surfaces[i - 1].material.is_air())
      elements.push_back(points_json(element_outline(before, here)));
    surfaces.push_back(
        {{"z", z}, {"height", heights[i]}, {"stop", surface.stop}, {"profile", points_json(here)}});
    before = here;
    z += surface.thickness_mm;
  }
  double image_height = 0;
  for (const DrawnRay& ray : rays.drawn)
    if (std::isfinite(ray.zy_mm.back()[1]))
      image_height = std::max(image_height, std::abs(ray.zy_mm.back()[1]));
  return {{"surfaces", std::move(surfaces)},
          {"elements", std::move(elements)},
          {"fields", std::move(rays.fields)},
          {"blocked", std::move(rays.blocked)},
          {"image_z", z},
          {"image_height", image_height},
          {"first_order", first_order_json(lens)}};
}

json stray_json(const CoatedLens& coated, const std::optional<Sun>& sun,
                const std::optional<GhostPair>& ghost, double sensor_reflectance) {
  json rows = json::array();
  for (const Ghost& each :
       ghosts(coated.lens, {.losses = coated.losses, .sensor_reflectance = sensor_reflectance}))
    rows.push_back({{"first", each.first},
                    {"second", each.second},
                    {"focus_mm", finite_or_null(each.focus_mm)},
                    {"diameter_mm", finite_or_null(each.diameter_mm)},
                    {"relative_irradiance", finite_or_null(each.relative_irradiance)}});
  return {{"ghosts", std::move(rows)},
          {"way", ghost ? ghost_way(coated, sun, *ghost, sensor_reflectance) : json::array()},
          {"sky", sky_heights(coated.lens)}};
}

json sources_json(const Lens& lens, const SourcesFound& found) {
  json list = json::array();
  for (const BrightSource& source : found.sources) {
    Lens facing = lens;
    facing.object_distance_mm = source.distance_mm;
    FieldTracer tracer(facing, lens.reference_wavelength_nm, Tracer::Clip::stop_only);
    const double tangent = std::hypot(source.right, source.up);
    const std::optional<ChiefRay> chief =
        tracer.chief_ray(source.distance_mm ? tangent * *source.distance_mm : degrees(std::atan(tangent)));
    if (!chief) continue;
    const double scale = tangent > 0 ? std::abs(chief->image_height_mm) / tangent : 0;
    list.push_back({{"name", source.name}, {"x_mm", source.right * scale}, {"y_mm", source.up * scale}});
  }
  return list;
}

std::string blocking_surface(const Tracer& tracer, const Lens& lens, double object_field, int& surface) {
  constexpr int rays = 41;
  constexpr double degree = 3.14159265358979323846 / 180;
  double reach_mm = 0;
  for (const Surface& each : lens.surfaces) reach_mm = std::max(reach_mm, each.semi_diameter_mm.value_or(0));
  if (reach_mm == 0) reach_mm = tracer.stop_radius_mm();
  Ray farthest;
  farthest.failed_at = -1;
  for (int i = 0; i < rays; ++i) {
    const double height = reach_mm * (2.0 * i / (rays - 1) - 1);
    Ray ray;
    if (lens.object_distance_mm) {
      const double along = *lens.object_distance_mm, across = height - object_field;
      const double length = std::hypot(along, across);
      ray.point_mm = {0, object_field, -along};
      ray.direction = {0, across / length, along / length};
    } else {
      // At vertex 1, not in front of it: aimed through the height at which the surface is met.
      ray.direction = {0, std::sin(object_field * degree), std::cos(object_field * degree)};
      const double lead = lens.total_track_mm();
      ray.point_mm = {0, height - lead * std::tan(object_field * degree), -lead};
    }
    const Ray end = tracer.trace(ray);
    if (end.status != RayStatus::ok && end.failed_at > farthest.failed_at) farthest = end;
  }
  surface = farthest.failed_at;
  if (surface < 0) return "no ray finds its way through the stop";
  const char* what = farthest.status == RayStatus::missed      ? "rays miss surface"
                     : farthest.status == RayStatus::vignetted ? "the rim stops all rays at surface"
                                                               : "rays are totally reflected at surface";
  return fmt::format("{} {}", what, surface);
}

json glasses_json(const std::string& text, std::size_t most) {
  const auto numbers = two_numbers(text);
  const std::string letters = letters_and_digits(text);
  std::vector<std::pair<double, const KnownGlass*>> found;
  for (const KnownGlass& glass : known_glasses()) {
    const double far = misfit(glass, numbers, letters);
    if (std::isfinite(far)) found.emplace_back(far, &glass);
  }
  std::ranges::stable_sort(found, {}, [](const auto& each) { return each.first; });
  if (found.size() > most) found.resize(most);
  json list = json::array();
  for (const auto& [far, glass] : found)
    list.push_back({{"name", glass->name}, {"nd", glass->nd}, {"vd", glass->vd}, {"status", glass->status}});
  return list;
}

}  // namespace petzval
