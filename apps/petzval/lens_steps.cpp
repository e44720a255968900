// SPDX-License-Identifier: BSD-3-Clause
// petzval lens steps: one ray from surface to surface, and light on its way as a moving drawing.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/analysis/field_rows.h>
#include <petzval/base/whole_file.h>
#include <petzval/report/colours.h>
#include <petzval/report/ray_animation.h>
#include <petzval/scene/wavelength_list.h>

#include <cmath>
#include <memory>

#include "camera_option.h"
#include "field_option.h"
#include "lens_commands.h"
#include "output_option.h"
#include "table_output.h"

namespace petzval::app {

namespace {

struct StepsCommand {
  LensChoice lens;
  CameraChoice camera;
  std::optional<double> field, film_height_mm;
  std::string wavelengths;
  std::vector<double> stop{0, 0};
  std::string animate;
};

/// Rays of the moving drawing besides the one that is listed: across the stop both ways.
std::vector<AnimatedRay> animated(const FieldTracer& tracer, const ChiefRay& chief,
                                  const std::vector<RayStep>& listed) {
  std::vector<AnimatedRay> rays{{listed, series_colour(1).hex()}};
  for (const double share : {-0.95, -0.5, 0.0, 0.5, 0.95})
    for (const bool along_y : {true, false}) {
      std::vector<RayStep> steps = ray_steps(tracer, chief, along_y ? 0 : share, along_y ? share : 0);
      if (!steps.empty()) rays.push_back({std::move(steps), series_colour(0).hex()});
    }
  return rays;
}

/// The ray of one wavelength.
std::vector<RayStep> ray_of(const StepsCommand& options, FieldTracer& tracer, double field) {
  const Lens& lens = tracer.lens();
  const double x = options.stop[0], y = options.stop[1];
  if (options.film_height_mm) {
    std::vector<RayStep> ray = ray_steps_from_film(tracer.tracer(), *options.film_height_mm, x, y);
    if (ray.empty())
      throw InputError(
          fmt::format("{}: the glass brings no ray from {:g} mm of the film to ({:g}, {:g}) of the "
                      "stop; a smaller --film-height would be right",
                      lens.name, *options.film_height_mm, x, y));
    return ray;
  }
  const double object = object_field(lens, lens.fields.kind, field);
  const std::optional<ChiefRay> chief = tracer.chief_ray(object);
  std::vector<RayStep> ray = chief ? ray_steps(tracer, *chief, x, y) : std::vector<RayStep>();
  if (!ray.empty()) return ray;
  if (std::hypot(x, y) > 1)
    throw InputError(fmt::format("--stop {:g},{:g} lies outside of the stop, whose rim is at 1", x, y));
  if (const std::optional<BlockedRay> end = blocked(tracer, object, x, y))
    throw InputError(
        fmt::format("{}: the ray of {:g} {} through ({:g}, {:g}) of the stop {}; a smaller field, or "
                    "another point by --stop, would be right",
                    lens.name, field, field_unit(lens.fields.kind), x, y, end->text()));
  throw no_ray_passes(lens, field, tracer.tracer().wavelength_nm());
}

/// Tables of several wavelengths, one beneath the other.
Table joined(const std::vector<Table>& tables, const std::vector<double>& wavelengths_nm) {
  if (tables.size() == 1) return tables.front();
  Table all{{{"wavelength", "nm", 2, "wavelength_nm"}}, {}};
  all.columns.insert(all.columns.end(), tables.front().columns.begin(), tables.front().columns.end());
  for (std::size_t i = 0; i < tables.size(); ++i)
    for (const std::vector<TableCell>& row : tables[i].rows) {
      all.rows.push_back({wavelengths_nm[i]});
      all.rows.back().insert(all.rows.back().end(), row.begin(), row.end());
    }
  return all;
}

void steps(const StepsCommand& options, const Shared& shared) {
  if (!options.animate.empty()) require_extension(options.animate, {".html", ".htm"}, "a moving drawing");
  if (options.film_height_mm && (options.field || !options.animate.empty()))
    throw InputError(
        fmt::format("--film-height begins at the film, {} at the object; one of them would be right",
                    options.field ? "--field" : "--animate"));
  const Lens lens = options.camera.used(options.lens.read(shared), {}, shared);
  const double field = options.field.value_or(even_fields(lens.fields.values, 2).back());
  const std::vector<double> wavelengths_nm = options.wavelengths.empty()
                                                 ? std::vector{lens.reference_wavelength_nm}
                                                 : parse_wavelengths_nm(options.wavelengths);
  std::vector<Table> tables;
  for (const double nm : wavelengths_nm) {
    FieldTracer tracer(lens, nm);
    const std::vector<RayStep> ray = ray_of(options, tracer, field);
    tables.push_back(ray_steps_table(ray));
    if (!options.animate.empty() && tables.size() == 1)
      write_whole_file(
          options.animate,
          ray_animation_html(
              lens, animated(tracer, *tracer.chief_ray(object_field(lens, lens.fields.kind, field)), ray),
              0));
  }
  const Table table = joined(tables, wavelengths_nm);
  if (shared.json) {
    nlohmann::ordered_json json = {{"lens", lens.name}};
    if (options.film_height_mm)
      json["film_height_mm"] = *options.film_height_mm;
    else
      json.update({{"field_definition", field_definition(lens.fields.kind)}, {"field", field}});
    if (wavelengths_nm.size() == 1) json["wavelength_nm"] = wavelengths_nm.front();
    json.update({{"stop_x", options.stop[0]}, {"stop_y", options.stop[1]}, {"rows", rows_json(table)}});
    return print_json(json);
  }
  const std::string of = options.film_height_mm
                             ? fmt::format("backwards from {:g} mm of the film", *options.film_height_mm)
                             : fmt::format("of {:g} {}", field, field_unit(lens.fields.kind));
  fmt::print("{}: the ray {} at {:g} nm through ({:g}, {:g}) of the stop\n", lens.name, of,
             fmt::join(wavelengths_nm, ", "), options.stop[0], options.stop[1]);
  print_table(table);
}

}  // namespace

void add_lens_steps(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<StepsCommand>();
  CLI::App* command =
      add_command(lens, shared, "steps",
                  "One ray, refraction by refraction; with --animate light on its way in two views",
                  "petzval lens steps cooke-triplet --field 14 --stop 0,0.7 --animate light.html", true,
                  [=, &shared] { steps(*options, shared); });
  options->lens.add_to(*command);
  options->camera.add_to(*command);
  command->add_option("--field", options->field, "Field, in the lens file's kind; default: its largest");
  command
      ->add_option("--film-height", options->film_height_mm,
                   "Instead of a field: backwards from this height of the film [mm]")
      ->check(finite_number());
  command->add_option("--wavelength,--wavelengths", options->wavelengths,
                      "One or several [nm]; default: the reference wavelength");
  command
      ->add_option("--stop", options->stop, "Where the ray crosses the stop, X,Y in stop radii; default: 0,0")
      ->delimiter(',')
      ->expected(2);
  command->add_option("--animate", options->animate, "Also write a page in which the light moves (.html)")
      ->check(output_file());
}

}  // namespace petzval::app
