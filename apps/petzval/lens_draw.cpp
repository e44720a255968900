// SPDX-License-Identifier: BSD-3-Clause
// petzval lens draw.
#include <fmt/format.h>
#include <petzval/analysis/field_values.h>
#include <petzval/analysis/film_fan.h>
#include <petzval/analysis/ray_fan.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_states.h>
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
  bool all_states = false;
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

/// What draw_lens() draws of a lens as it was read.
DrawnState drawn(const DrawCommand& options, const Lens& read, const Shared& shared) {
  DrawnState state;
  state.lens = options.camera.used(read, options.fields.request(read), shared);
  const Lens& lens = state.lens;
  const FieldTableRequest request = options.fields.request(lens);
  FieldTracer tracer(
      lens,
      options.fields.wavelengths_nm.empty() ? lens.reference_wavelength_nm : request.wavelengths_nm.front(),
      request.clip, options.camera.field_azimuth_deg);
  LensDrawingOptions& drawing = state.options;
  drawing.azimuth_deg = options.camera.field_azimuth_deg;
  drawing.title = fmt::format("{} — rays at {:g} nm", lens.name, tracer.tracer().wavelength_nm());
  state.rays = film_rays(options, lens, tracer.tracer(), drawing, shared);
  for (std::size_t i = 0; options.film_heights_mm.empty() && i < request.fields.size(); ++i) {
    const double field = object_field(lens, request.field_kind, request.fields[i]);
    const std::string colour = series_colour(i).hex();
    const auto fan = meridional_fan(tracer, field, options.rays, 0.25 * lens.total_track_mm());
    if (fan.empty()) note(shared, fmt::format("no ray passes at field {:g}", request.fields[i]));
    for (const MeridionalPath& path : fan) state.rays.push_back({path, colour});
    drawing.legend.push_back(
        {fmt::format("{:g} {}", request.fields[i], field_unit(request.field_kind)), colour});
  }
  return state;
}

/// All states of the lens, those that lie between them left out.
void draw_all_states(const DrawCommand& options, const std::string& output, const Shared& shared) {
  if (!options.lens.state.empty())
    throw InputError("--states draws all of them; without --state it would be right");
  const Lens read = options.fields.prepare(options.lens.read(shared), shared);
  if (read.states.empty()) throw InputError(fmt::format("--states: {} has no states", read.name));
  std::vector<DrawnState> states;
  for (std::size_t i = 0; i < read.states.size(); ++i) {
    states.push_back(drawn(options, in_state(read, static_cast<double>(i)), shared));
    LensDrawingOptions& drawing = states.back().options;
    drawing.title =
        fmt::format("{} — {:.4g} mm", read.states.names[i], first_order(states.back().lens).efl_mm);
    drawing.surface_numbers = false;
    if (i > 0) drawing.legend.clear();
    constexpr double tallest_px = 240;
    drawing.tallest_px = tallest_px;
  }
  write_drawing(output, draw_states(states));
  if (!shared.quiet) fmt::print("{}: {} states\n", output, states.size());
}

void draw(const DrawCommand& options, const Shared& shared) {
  const std::string output = options.output.empty() ? usual_output(options.lens) : options.output;
  require_drawing(output, "a drawing");
  if (options.all_states) return draw_all_states(options, output, shared);
  const Lens read = options.fields.prepare(options.lens.read(shared), shared);
  const DrawnState state = drawn(options, read, shared);
  write_drawing(output, draw_lens(state.lens, state.rays, state.options));
  if (!shared.quiet)
    fmt::print("{}: {} rays through {} surfaces\n", output, state.rays.size(), state.lens.surfaces.size());
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
  command->add_flag("--states", options->all_states,
                    "All states of the lens beneath each other, their sensors in one line");
  command->add_option("-o,--output", options->output, ".svg, .png or .pdf; default: NAME.svg, of the lens")
      ->check(output_file());
}

}  // namespace petzval::app
