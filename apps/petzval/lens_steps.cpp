// SPDX-License-Identifier: BSD-3-Clause
// petzval lens steps: one ray from surface to surface, and light on its way as a moving drawing.
#include <fmt/format.h>
#include <petzval/analysis/field_rows.h>
#include <petzval/base/wavelength.h>
#include <petzval/base/whole_file.h>
#include <petzval/report/colours.h>
#include <petzval/report/ray_animation.h>

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
  std::optional<double> field, wavelength_nm;
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

void steps(const StepsCommand& options, const Shared& shared) {
  if (!options.animate.empty()) require_extension(options.animate, {".html", ".htm"}, "a moving drawing");
  const Lens lens = options.camera.used(options.lens.read(shared), {}, shared);
  const double field = options.field.value_or(even_fields(lens.fields.values, 2).back());
  if (options.wavelength_nm)
    require_wavelength(*options.wavelength_nm, fmt::format("--wavelength {:g}", *options.wavelength_nm));
  FieldTracer tracer(lens, options.wavelength_nm.value_or(lens.reference_wavelength_nm));
  const double wavelength_nm = tracer.tracer().wavelength_nm();
  const std::optional<ChiefRay> chief = tracer.chief_ray(object_field(lens, lens.fields.kind, field));
  if (!chief) throw no_ray_passes(lens, field, wavelength_nm);
  const std::vector<RayStep> ray = ray_steps(tracer, *chief, options.stop[0], options.stop[1]);
  if (ray.empty() && options.stop[0] == 0 && options.stop[1] == 0)
    throw InputError(
        fmt::format("{}: no light of field {:g} passes through the middle of the stop; a smaller field, or "
                    "another point by --stop, would be right",
                    lens.name, field));
  if (ray.empty())
    throw InputError(
        fmt::format("{}: no ray of field {:g} passes at ({:g}, {:g}) of the stop; a point nearer to "
                    "its centre would be right",
                    lens.name, field, options.stop[0], options.stop[1]));
  if (!options.animate.empty())
    write_whole_file(options.animate, ray_animation_html(lens, animated(tracer, *chief, ray), 0));
  const Table table = ray_steps_table(ray);
  if (shared.json) {
    nlohmann::ordered_json json = {{"lens", lens.name},
                                   {"field_definition", field_definition(lens.fields.kind)},
                                   {"field", field},
                                   {"wavelength_nm", wavelength_nm},
                                   {"stop_x", options.stop[0]},
                                   {"stop_y", options.stop[1]},
                                   {"rows", rows_json(table)}};
    return print_json(json);
  }
  fmt::print("{}: the ray of {:g} {} at {:g} nm through ({:g}, {:g}) of the stop\n", lens.name, field,
             field_unit(lens.fields.kind), wavelength_nm, options.stop[0], options.stop[1]);
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
  command->add_option("--wavelength", options->wavelength_nm, "In nm; default: the reference wavelength")
      ->check(positive_number());
  command
      ->add_option("--stop", options->stop, "Where the ray crosses the stop, X,Y in stop radii; default: 0,0")
      ->delimiter(',')
      ->expected(2);
  command->add_option("--animate", options->animate, "Also write a page in which the light moves (.html)")
      ->check(output_file());
}

}  // namespace petzval::app
