// SPDX-License-Identifier: BSD-3-Clause
// petzval lens info.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/wavelength.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_states.h>
#include <petzval/lens/surface_shape.h>

#include <cmath>
#include <memory>
#include <optional>

#include <petzval/simulate/frame_view.h>

#include "camera_option.h"
#include "field_option.h"
#include "lens_commands.h"

namespace petzval::app {

namespace {

struct InfoCommand {
  LensChoice lens;
  CameraChoice camera;
  std::optional<double> wavelength_nm;
};

nlohmann::ordered_json pupil_json(const PupilData& pupil, const char* origin) {
  return {{"position_mm", number_or_null(pupil.position_mm)},
          {"position_from", origin},
          {"diameter_mm", number_or_null(pupil.diameter_mm)}};
}

nlohmann::ordered_json info_json(const Lens& lens, const FirstOrder& data) {
  return {
      {"lens", lens.name},
      {"source", lens.source},
      {"wavelength_nm", data.wavelength_nm},
      {"object_distance_mm", lens.object_distance_mm ? number_or_null(*lens.object_distance_mm) : nullptr},
      {"efl_mm", number_or_null(data.efl_mm)},
      {"bfl_mm", number_or_null(data.bfl_mm)},
      {"ffl_mm", number_or_null(data.ffl_mm)},
      {"f_number", f_number_or_null(data)},
      {"working_f_number", number_or_null(data.working_f_number)},
      {"image_space_na", number_or_null(data.image_space_na)},
      {"field_of_view_deg", number_or_null(data.field_of_view_deg)},
      {"magnification", number_or_null(data.magnification)},
      {"entrance_pupil", pupil_json(data.entrance_pupil, "vertex 1")},
      {"exit_pupil", pupil_json(data.exit_pupil, "image surface")},
      {"petzval_radius_mm", number_or_null(data.petzval_radius_mm)},
      {"total_track_mm", number_or_null(data.total_track_mm)},
      {"paraxial_image_mm", number_or_null(data.paraxial_image_mm)},
      {"stop_semi_diameter_mm", number_or_null(stop_radius_mm(lens))},
      {"paraxial_stop_semi_diameter_mm", number_or_null(data.stop_semi_diameter_mm)},
      {"lagrange_invariant_mm", number_or_null(data.lagrange_invariant_mm)}};
}

void print_first_order(const Lens& lens, const FirstOrder& data) {
  const auto line = [](const char* what, double value, const char* remark) {
    const std::string number = std::isfinite(value) ? fmt::format("{:.6f}", value)
                               : std::isnan(value)  ? "none"
                                                    : "infinite";
    fmt::print("  {:<28} {:>16}  {}\n", what, number, remark);
  };
  fmt::print("{}\n{}\n\nAt {:g} nm, lengths in mm\n", lens.name, lens.source, data.wavelength_nm);
  line("object distance", lens.object_distance_mm.value_or(INFINITY), "in front of vertex 1");
  line("focal length", data.efl_mm, "");
  line("back focal length", data.bfl_mm, "last vertex to rear focal point");
  line("front focal length", data.ffl_mm, "vertex 1 to front focal point");
  line("f-number", has_f_number(data) ? data.f_number : NAN, "paraxial, object at infinity");
  line("working f-number", data.working_f_number, "paraxial, at the object distance");
  line("image-space NA", data.image_space_na, "paraxial, at the object distance");
  line("field of view [deg]", data.field_of_view_deg,
       "full angle at the entrance pupil, of the file's fields");
  line("magnification", data.magnification, "");
  line("entrance pupil position", data.entrance_pupil.position_mm, "from vertex 1");
  line("entrance pupil diameter", data.entrance_pupil.diameter_mm, "");
  line("exit pupil position", data.exit_pupil.position_mm, "from the image surface");
  line("exit pupil diameter", data.exit_pupil.diameter_mm, "");
  line("stop semi-diameter", stop_radius_mm(lens), "height of the real marginal ray");
  line("paraxial stop semi-d.", data.stop_semi_diameter_mm, "height of the paraxial marginal ray");
  line("Petzval radius", data.petzval_radius_mm, "");
  line("total track", data.total_track_mm, "vertex 1 to image surface");
  line("paraxial image", data.paraxial_image_mm, "behind the last vertex");
}

nlohmann::ordered_json view_json(const FrameView& view) {
  return {{"object_plane", view.at_infinity ? "infinity" : "object distance"},
          {view.at_infinity ? "width_deg" : "width_mm", number_or_null(view.width)},
          {view.at_infinity ? "height_deg" : "height_mm", number_or_null(view.height)},
          {view.at_infinity ? "diagonal_deg" : "diagonal_mm", number_or_null(view.diagonal)}};
}

void print_view(const FrameView& view) {
  const auto number = [&](double value) {
    return std::isfinite(value) ? fmt::format("{:.4g} {}", value, view.at_infinity ? "deg" : "mm")
                                : std::string("beyond the lens");
  };
  fmt::print("  the sensor sees {} x {}, diagonal {}\n", number(view.width), number(view.height),
             number(view.diagonal));
}

void print_surfaces(const Lens& lens) {
  fmt::print("\n{:>3} {:>14} {:>12} {:>12}  {}\n", "", "radius [mm]", "to next [mm]", "semi-d. [mm]",
             "behind it");
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
    const Surface& surface = lens.surfaces[i];
    const double c = surface.curvature_per_mm;
    std::string remark = surface.mirror ? "mirror" : surface.material.description();
    if (surface.stop) remark += "; stop";
    if (surface.blades.count > 0)
      remark +=
          fmt::format(" of {} blades turned by {:g}°", surface.blades.count, surface.blades.rotation_deg);
    for (const std::string& shape : shape_remarks(surface)) remark += "; " + shape;
    fmt::print("{:>3} {:>14} {:>12.6g} {:>12}  {}\n", i, c == 0 ? "flat" : fmt::format("{:.6g}", 1 / c),
               surface.thickness_mm,
               surface.semi_diameter_mm ? fmt::format("{:.6g}", *surface.semi_diameter_mm) : "unbounded",
               remark);
  }
}

nlohmann::ordered_json states_json(const Lens& lens, std::optional<double> wavelength_nm) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < lens.states.size(); ++i) {
    const Lens state = in_state(lens, static_cast<double>(i));
    const FirstOrder data = first_order(state, wavelength_nm);
    rows.push_back({{"state", i},
                    {"name", lens.states.names[i]},
                    {"object_distance_mm",
                     state.object_distance_mm ? number_or_null(*state.object_distance_mm) : nullptr},
                    {"efl_mm", number_or_null(data.efl_mm)},
                    {"f_number", f_number_or_null(data)},
                    {"working_f_number", number_or_null(data.working_f_number)},
                    {"field_of_view_deg", number_or_null(data.field_of_view_deg)},
                    {"magnification", number_or_null(data.magnification)},
                    {"total_track_mm", number_or_null(data.total_track_mm)}});
  }
  return rows;
}

/// A line a state, and what differs between them.
void print_states(const Lens& lens, std::optional<double> wavelength_nm) {
  if (lens.states.empty()) return;
  const std::optional<std::size_t> present = present_state(lens);
  fmt::print("\n{:>3} {:<12} {:>12} {:>10} {:>10} {:>10} {:>12} {:>10}\n", "", "state", "object", "focal l.",
             "f-number", "view [deg]", "magnific.", "track");
  for (std::size_t i = 0; i < lens.states.size(); ++i) {
    const Lens state = in_state(lens, static_cast<double>(i));
    const FirstOrder data = first_order(state, wavelength_nm);
    fmt::print("{:>3} {:<12} {:>12.6g} {:>10.4f} {:>10.4f} {:>10.2f} {:>12.6f} {:>10.3f}{}\n", i,
               lens.states.names[i], state.object_distance_mm.value_or(INFINITY), data.efl_mm,
               has_f_number(data) ? data.f_number : NAN, data.field_of_view_deg, data.magnification,
               data.total_track_mm, i == present ? "  (this one)" : "");
  }
  std::vector<std::string> paths;
  for (const StateRow& row : lens.states.rows) paths.push_back(row.path);
  fmt::print("    that differ in {}\n", fmt::join(paths, ", "));
}

void info(const InfoCommand& options, const Shared& shared) {
  const auto wavelength_nm = options.wavelength_nm;
  if (wavelength_nm) require_wavelength(*wavelength_nm, fmt::format("--wavelength {:g}", *wavelength_nm));
  const Lens read = options.lens.read(shared);
  const Lens lens = options.camera.used(read, {}, shared);
  const FirstOrder data = first_order(lens, wavelength_nm);
  std::optional<SensorGeometry> frame;
  if (!options.camera.sensor.empty()) {
    frame = read_sensor(options.camera.sensor, options.camera.sensor_settings).geometry;
    note_short_field(lens, *frame, context_of(shared));
  }
  if (shared.json) {
    nlohmann::ordered_json json = info_json(lens, data);
    if (!lens.states.empty()) json["states"] = states_json(read, wavelength_nm);
    if (frame) json["sensor_view"] = view_json(frame_view(lens, *frame));
    return print_json(json);
  }
  print_first_order(lens, data);
  if (frame) print_view(frame_view(lens, *frame));
  print_surfaces(lens);
  print_states(read, wavelength_nm);
}

}  // namespace

void add_lens_info(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<InfoCommand>();
  CLI::App* command =
      add_command(lens, shared, "info", "First-order data and surfaces",
                  "petzval lens info edmund-54852 --wavelength 486.13 --set object_distance_mm=500", true,
                  [options, &shared] { info(*options, shared); });
  options->lens.add_to(*command);
  options->camera.add_to(*command);
  options->camera.add_sensor(*command, "By name or file, or 768x576@6.25: what it sees");
  command->add_option("--wavelength", options->wavelength_nm,
                      "In nm; the lens's reference wavelength if not given");
}

}  // namespace petzval::app
