// SPDX-License-Identifier: BSD-3-Clause
#include "ghost_drawing.h"

#include <fmt/format.h>
#include <petzval/analysis/field_values.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/units.h>
#include <petzval/flare/ghost_fan.h>
#include <petzval/report/colours.h>
#include <petzval/report/lens_drawing.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <optional>
#include <vector>

#include "plot_output.h"

namespace petzval::app {

namespace {

GhostPair parsed_pair(const std::string& text, std::size_t sensor) {
  std::vector<std::size_t> turns;
  bool right = true;
  for (const std::string& part : split_at(text, ',')) {
    const std::optional<int> surface = parse_integer(part);
    right = right && surface && *surface >= 0 && static_cast<std::size_t>(*surface) <= sensor;
    turns.push_back(right ? static_cast<std::size_t>(*surface) : 0);
  }
  right = right && (turns.size() == 2 || turns.size() == 4) && turns[1] < turns[0];
  if (!right || (turns.size() == 4 && (turns[2] <= turns[1] || turns[3] >= turns[2])))
    throw InputError(
        fmt::format("--draw {}: the surface that reflects first and one in front of it, of 0 to "
                    "{} (the sensor), as in {},0, would be right, or two such pairs",
                    text, sensor, sensor > 1 ? 2 : 1));
  if (turns.size() == 2) return {turns[0], turns[1]};
  return {turns[0], turns[1], turns[2], turns[3]};
}

/// A point of the field in the y-z plane; light at a positive field angle runs upwards.
BrightSource source_at(const Lens& lens, double object_field) {
  BrightSource source;
  source.distance_mm = lens.object_distance_mm;
  source.up =
      lens.object_distance_mm ? object_field / *lens.object_distance_mm : -std::tan(radians(object_field));
  return source;
}

}  // namespace

void GhostDrawing::check() const {
  if (pair.empty() != output.empty())
    throw InputError(pair.empty() ? "-o has no effect without --draw FIRST,SECOND"
                                  : "--draw needs a file to draw into: -o ghost.svg would be right");
  if (!output.empty()) require_drawing(output, "a drawing");
}

void GhostDrawing::draw(const Lens& lens, const FieldTableRequest& request, double sensor_reflectance,
                        const Shared& shared) const {
  if (pair.empty()) return;
  const GhostPair way = parsed_pair(pair, lens.surfaces.size());
  const double wavelength_nm = lens.reference_wavelength_nm;
  const GhostTracer tracer(lens, wavelength_nm, request.losses, sensor_reflectance, request.clip);
  LensDrawingOptions drawing;
  std::string surfaces = fmt::format("{} and {}", way.first, way.second);
  if (way.reflections() == 4)
    surfaces = fmt::format("{}, {}, {} and {}", way.first, way.second, way.third, way.fourth);
  drawing.title = fmt::format("{} — ghost of surfaces {} at {:g} nm", lens.name, surfaces, wavelength_nm);
  std::vector<DrawnRay> rays;
  constexpr int count = 7;
  for (std::size_t i = 0; i < request.fields.size(); ++i) {
    const SourceBeam beam(source_at(lens, object_field(lens, request.field_kind, request.fields[i])));
    const std::string colour = series_colour(i).hex();
    const std::vector<GhostRay> fan = ghost_fan(tracer, way, beam, count, 0.25 * lens.total_track_mm());
    if (fan.empty())
      note(shared, fmt::format("no light of field {:g} passes on this way", request.fields[i]));
    for (const GhostRay& ray : fan) rays.push_back({ray, colour});
    drawing.legend.push_back(
        {fmt::format("{:g} {}", request.fields[i], field_unit(request.field_kind)), colour});
  }
  write_drawing(output, draw_lens(lens, rays, drawing));
}

}  // namespace petzval::app
