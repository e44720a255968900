// SPDX-License-Identifier: BSD-3-Clause
// petzval lens draw.
#include <fmt/format.h>
#include <petzval/analysis/field_values.h>
#include <petzval/analysis/film_fan.h>
#include <petzval/analysis/ray_fan.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/report/colours.h>
#include <petzval/report/lens_drawing.h>

#include <filesystem>
#include <memory>

#include "camera_option.h"
#include "field_option.h"
#include "lens_commands.h"
#include "output_option.h"
#include "plot_output.h"

namespace petzval::app {

namespace {

struct DrawCommand {
  LensChoice lens;
  FieldChoice fields;
  CameraChoice camera;
  int rays = 5;
  std::string output;
  std::vector<double> film_heights_mm;
  std::string section = "meridional";
};

/// Rays from points of the film instead of fields.
std::vector<DrawnRay> film_rays(const DrawCommand& options, const Lens& lens, const Tracer& tracer,
                                LensDrawingOptions& drawing, const Shared& shared) {
  const FilmSection section = options.section == "sagittal" ? FilmSection::sagittal : FilmSection::meridional;
  std::vector<DrawnRay> rays;
  for (std::size_t i = 0; i < options.film_heights_mm.size(); ++i) {
    const double height = options.film_heights_mm[i];
    const std::string colour = series_colour(i).hex();
    const auto fan = film_fan(tracer, height, section, options.rays, 0.25 * lens.total_track_mm());
    if (fan.empty()) note(shared, fmt::format("no light reaches the film at {:g} mm", height));
    for (const FilmRay& path : fan) rays.push_back({path, colour});
    drawing.legend.push_back(
        {fmt::format("film point at {:g} mm, {} section", height, options.section), colour});
  }
  return rays;
}

/// Beside where the user is: "dgauss-50mm.svg".
std::string usual_output(const LensChoice& lens) {
  return std::filesystem::path(lens.path_or_name).stem().string() + ".svg";
}

void draw(const DrawCommand& options, const Shared& shared) {
  const std::string output = options.output.empty() ? usual_output(options.lens) : options.output;
  require_drawing(output, "a drawing");
  const Lens read = options.fields.prepare(options.lens.read(shared), shared);
  const Lens lens = options.camera.used(read, options.fields.request(read), shared);
  const FieldTableRequest request = options.fields.request(lens);
  FieldTracer tracer(
      lens,
      options.fields.wavelengths_nm.empty() ? lens.reference_wavelength_nm : request.wavelengths_nm.front(),
      request.clip, options.camera.field_azimuth_deg);
  LensDrawingOptions drawing;
  drawing.azimuth_deg = options.camera.field_azimuth_deg;
  drawing.title = fmt::format("{} — rays at {:g} nm", lens.name, tracer.tracer().wavelength_nm());
  std::vector<DrawnRay> rays = film_rays(options, lens, tracer.tracer(), drawing, shared);
  for (std::size_t i = 0; options.film_heights_mm.empty() && i < request.fields.size(); ++i) {
    const double field = object_field(lens, request.field_kind, request.fields[i]);
    const std::string colour = series_colour(i).hex();
    const auto fan = meridional_fan(tracer, field, options.rays, 0.25 * lens.total_track_mm());
    if (fan.empty()) note(shared, fmt::format("no ray passes at field {:g}", request.fields[i]));
    for (const MeridionalPath& path : fan) rays.push_back({path, colour});
    drawing.legend.push_back(
        {fmt::format("{:g} {}", request.fields[i], field_unit(request.field_kind)), colour});
  }
  write_drawing(output, draw_lens(lens, rays, drawing));
  if (!shared.quiet)
    fmt::print("{}: {} rays through {} surfaces\n", output, rays.size(), lens.surfaces.size());
}

}  // namespace

void add_lens_draw(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<DrawCommand>();
  CLI::App* command = add_command(lens, shared, "draw", "Draw the layout with rays of several fields as SVG",
                                  "petzval lens draw dgauss-50mm -o layout.svg", false,
                                  [=, &shared] { draw(*options, shared); });
  options->lens.add_to(*command);
  options->fields.add_to(*command);
  options->camera.add_to(*command);
  command->add_option("--rays", options->rays, "Rays a field")->check(CLI::Range(1, 1001));
  command
      ->add_option("--film-heights", options->film_heights_mm,
                   "Rays from these points of the film out through the lens, instead of fields [mm]")
      ->delimiter(',');
  command
      ->add_option(
          "--section", options->section,
          "Of the rays from film points: in the plane of point and axis, or across it, seen from above")
      ->check(CLI::IsMember({"meridional", "sagittal"}))
      ->capture_default_str();
  command->add_option("-o,--output", options->output, ".svg, .png or .pdf; default: NAME.svg, of the lens")
      ->check(output_file());
}

}  // namespace petzval::app
