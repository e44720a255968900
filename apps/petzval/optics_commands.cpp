// SPDX-License-Identifier: BSD-3-Clause
// petzval optics build, petzval optics info: the lens data table.
#include <fmt/format.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/progress.h>
#include <petzval/base/units.h>
#include <petzval/camera/camera.h>
#include <petzval/optics/build.h>
#include <petzval/optics/irradiance_formula.h>
#include <petzval/optics/table_file.h>
#include <petzval/optics/table_interpolation.h>
#include <petzval/optics/table_layout.h>
#include <petzval/scene/wavelength_list.h>
#include <petzval/sensor/sensor.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>

#include "field_option.h"
#include "loss_option.h"
#include "optics_commands.h"
#include "output_option.h"

namespace petzval::app {

namespace {

struct BuildCommand {
  LensChoice lens;
  FieldChoice apertures;  ///< only --apertures and --ignore-apertures of it
  LossChoice losses;
  std::string output, wavelengths, sensor;
  std::string focus = "design";
  std::optional<double> f_number, image_height_mm;
  int field_count = TableOptions{}.field_count;
};

struct TableInfoCommand {
  std::string path;
  std::string fit = "monotone";
};

/// "design", "infinity", or a distance from the sensor [mm].
void take_focus(Camera& camera, const std::string& focus) {
  if (focus == "design") return;
  if (focus == "infinity" || focus == "inf") return camera.focus_at_m({});
  double distance_mm = 0;
  const auto [end, error] = std::from_chars(focus.data(), focus.data() + focus.size(), distance_mm);
  if (error != std::errc() || end != focus.data() + focus.size() || !(distance_mm > 0))
    throw InputError(fmt::format(
        "--focus {}: design, infinity or a distance from the sensor in mm would be right", focus));
  camera.focus_at_m(distance_mm / mm_per_m);
}

TableOptions table_options(const BuildCommand& command) {
  TableOptions options;
  options.field_count = command.field_count;
  if (!command.wavelengths.empty()) options.wavelengths_nm = parse_wavelengths_nm(command.wavelengths);
  if (command.apertures.ignore_apertures) options.clip = Tracer::Clip::stop_only;
  if (command.image_height_mm && !(*command.image_height_mm > 0))
    throw InputError(
        fmt::format("--image-height {}: a positive number of mm would be right", *command.image_height_mm));
  if (command.image_height_mm) options.max_image_height_mm = *command.image_height_mm;
  if (!command.sensor.empty())
    options.max_image_height_mm = read_sensor(command.sensor).geometry.half_diagonal_mm();
  options.validate();
  return options;
}

/// A table that ends before the height asked for is useful, but the user should know.
void note_short_table(const LensDataTable& table, double wanted_mm, const Shared& shared) {
  const std::size_t last = table.fields.size() - 1;
  double reached_mm = INFINITY;
  for (std::size_t w = 0; w < table.wavelengths_nm.size(); ++w)
    reached_mm = std::min(reached_mm, table.real_image_height_mm[table.index(last, w)]);
  if (reached_mm < wanted_mm)
    note(
        shared,
        fmt::format("{}: no ray passes beyond an image height of {:.4g} mm, short of the {:.4g} mm asked for",
                    table.lens_name, reached_mm, wanted_mm));
}

/// Windows that lose light are said: they were widened as far as they go.
void note_cut_psfs(const LensDataTable& table, const Shared& shared) {
  std::size_t cut = 0;
  double least = 1;
  for (const Psf& psf : table.psf) {
    if (psf.captured < PsfOptions{}.wanted_share) ++cut;
    least = std::min(least, psf.captured);
  }
  if (cut > 0)
    note(shared,
         fmt::format("{}: {} of {} PSFs hold less than {:g} % of their light, the least {:.3g} %",
                     table.lens_name, cut, table.psf.size(), 100 * PsfOptions{}.wanted_share, 100 * least));
}

void build(const BuildCommand& command, const Shared& shared) {
  require_extension(command.output, table_extensions(), "a lens data table");
  TableOptions options = table_options(command);
  Camera camera(command.apertures.prepare(command.lens.read(shared), shared));
  if (command.f_number) camera.set_f_number(*command.f_number);
  take_focus(camera, command.focus);
  options.losses = command.losses.losses(camera.lens(), shared);
  ProgressBar bar(!shared.quiet);
  const LensDataTable table = build_lens_data_table(camera.lens(), options, bar.callback());
  note_short_table(table, options.max_image_height_mm, shared);
  note_cut_psfs(table, shared);
  write_table(table, command.output);
}

/// What a lens without distortion would do with a field, at the reference wavelength; nothing for fields that
/// a plane image cannot hold.
std::optional<double> undistorted_height_mm(const LensDataTable& table, double field) {
  if (table.finite_object()) return std::abs(table.first_order.magnification * field);
  if (field >= 90) return {};
  return std::abs(table.first_order.efl_mm) * table.field_tangent(field);
}

std::optional<double> distortion_percent(const LensDataTable& table, std::size_t f, std::size_t w) {
  if (f == 0) return 0.0;
  const std::optional<double> ideal = undistorted_height_mm(table, table.fields[f]);
  if (!ideal || !std::isfinite(*ideal) || *ideal == 0) return {};
  return 100 * (table.real_image_height_mm[table.index(f, w)] / *ideal - 1);
}

nlohmann::ordered_json first_order_json(const FirstOrder& data) {
  nlohmann::ordered_json json;
  table_layout::for_each_first_order(data, [&](const std::string& name, double number) {
    for (const char* pupil : {"entrance_pupil", "exit_pupil"})
      if (name.starts_with(pupil)) {
        json[pupil][name.substr(std::string(pupil).size() + 1)] = number_or_null(number);
        return;
      }
    json[name] = number_or_null(number);
  });
  return json;
}

nlohmann::ordered_json rows_json(const LensDataTable& table) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (std::size_t f = 0; f < table.fields.size(); ++f)
    for (std::size_t w = 0; w < table.wavelengths_nm.size(); ++w) {
      const std::size_t i = table.index(f, w);
      const std::optional<double> distortion = distortion_percent(table, f, w);
      rows.push_back({{"field", table.fields[f]},
                      {"wavelength_nm", table.wavelengths_nm[w]},
                      {"real_image_height_mm", table.real_image_height_mm[i]},
                      {"distortion_percent", distortion ? nlohmann::ordered_json(*distortion) : nullptr},
                      {"g_source_sr", table.g_source_sr[i]},
                      {"g_sensor_sr", table.g_sensor_sr[i]},
                      {"relative_illumination", table.g_sensor_sr[i] / table.g_sensor_sr[w]},
                      {"psf_size", table.psf[i].size},
                      {"psf_spacing_um", table.psf[i].spacing_um},
                      {"psf_captured", table.psf[i].captured}});
    }
  return rows;
}

nlohmann::ordered_json fit_json(const LensDataTable& table, const RadialProfiles& profiles,
                                const std::string& fit) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const double wavelength : table.wavelengths_nm) {
    const FitResiduals r = profiles.residuals_at(wavelength);
    rows.push_back({{"wavelength_nm", wavelength},
                    {"height_rms_um", r.height_rms_um},
                    {"height_max_um", r.height_max_um},
                    {"g_source_rms", r.g_source_rms},
                    {"g_source_max", r.g_source_max},
                    {"g_sensor_rms", r.g_sensor_rms},
                    {"g_sensor_max", r.g_sensor_max},
                    {"monotone", r.monotone}});
  }
  return {{"kind", fit}, {"residuals", rows}};
}

/// What rays bring to the axis, and what formulas make of the f-number: at the reference wavelength's entry.
struct AxialLight {
  double traced_sr = 0, by_f_number_sr = 0, iset_sr = 0;
};

AxialLight axial_light(const LensDataTable& table) {
  const FirstOrder& first = table.first_order;
  std::size_t nearest = 0;
  for (std::size_t w = 0; w < table.wavelengths_nm.size(); ++w)
    if (std::abs(table.wavelengths_nm[w] - first.wavelength_nm) <
        std::abs(table.wavelengths_nm[nearest] - first.wavelength_nm))
      nearest = w;
  return {table.g_sensor_sr[nearest], iset_irradiance_sr(first.f_number, first.magnification),
          iset_irradiance_sr(first.working_f_number, first.magnification)};
}

nlohmann::ordered_json axial_light_json(const LensDataTable& table) {
  const AxialLight light = axial_light(table);
  return {{"g_sensor_sr", light.traced_sr},
          {"by_f_number_sr", number_or_null(light.by_f_number_sr)},
          {"by_isetcam_sr", number_or_null(light.iset_sr)}};
}

void print_axial_light(const LensDataTable& table) {
  const AxialLight light = axial_light(table);
  const auto line = [&](const char* what, double sr) {
    if (std::isfinite(sr))
      fmt::print("  {:<52} {:>9.5f} sr {:>+8.2f} %\n", what, sr, 100 * (sr / light.traced_sr - 1));
  };
  fmt::print("\nirradiance of a wall on the axis, per radiance\n  {:<52} {:>9.5f} sr\n", "g_sensor",
             light.traced_sr);
  line("π/(1 + 4N²(1 + |m|)²), N = f_number", light.by_f_number_sr);
  line("the same as ISETCam takes it, N = working_f_number", light.iset_sr);
}

nlohmann::ordered_json info_json(const LensDataTable& table, const RadialProfiles& profiles,
                                 const std::string& fit) {
  const Fields::Kind kind = table.finite_object() ? Fields::Kind::object_height_mm : Fields::Kind::angle_deg;
  return {{"lens", table.lens_name},
          {"provenance", table.provenance},
          {"object_distance_mm", number_or_null(table.object_distance_mm.value_or(INFINITY))},
          {"vertex_to_sensor_mm", table.vertex_to_sensor_mm},
          {"first_order", first_order_json(table.first_order)},
          {"axial_light", axial_light_json(table)},
          {"field_definition", field_definition(kind)},
          {"distortion_reference", "paraxial image at first_order.wavelength_nm"},
          {"wavelengths_nm", table.wavelengths_nm},
          {"rows", rows_json(table)},
          {"fit", fit_json(table, profiles, fit)}};
}

void print_header(const LensDataTable& table) {
  const std::string object = table.finite_object()
                                 ? fmt::format("{:g} mm before vertex 1", *table.object_distance_mm)
                                 : std::string("at infinity");
  fmt::print("{}\n{}\n\nobject {}, sensor {:.6g} mm behind vertex 1; at {:g} nm\n", table.lens_name,
             table.provenance, object, table.vertex_to_sensor_mm, table.first_order.wavelength_nm);
  table_layout::for_each_first_order(table.first_order, [](const std::string& name, double number) {
    if (name == "wavelength_nm") return;
    fmt::print("  {:<31} {:>14}\n", name, std::isnan(number) ? "not known" : fmt::format("{:.6f}", number));
  });
}

void print_rows(const LensDataTable& table) {
  fmt::print("\ndistortion against the paraxial image at {:g} nm, lateral colour included\n",
             table.first_order.wavelength_nm);
  fmt::print("{:>11} {:>15} {:>18} {:>15} {:>13} {:>13} {:>13} {:>11} {:>13} {:>9}\n",
             fmt::format("field [{}]", table.field_unit()), "wavelength [nm]", "image height [mm]",
             "distortion [%]", "g_source [sr]", "g_sensor [sr]", "relative ill.", "PSF samples",
             "spacing [um]", "captured");
  for (std::size_t f = 0; f < table.fields.size(); ++f)
    for (std::size_t w = 0; w < table.wavelengths_nm.size(); ++w) {
      const std::size_t i = table.index(f, w);
      const Psf& psf = table.psf[i];
      const std::optional<double> distortion = distortion_percent(table, f, w);
      fmt::print(
          "{:>11.5g} {:>15g} {:>18.6f} {:>15} {:>13.6f} {:>13.6f} {:>13.5f} {:>11} {:>13.4f} {:>9.4f}\n",
          table.fields[f], table.wavelengths_nm[w], table.real_image_height_mm[i],
          distortion ? fmt::format("{:.3f}", *distortion) : "-", table.g_source_sr[i], table.g_sensor_sr[i],
          table.g_sensor_sr[i] / table.g_sensor_sr[w], fmt::format("{0}x{0}", psf.size), psf.spacing_um,
          psf.captured);
    }
}

void print_fit(const LensDataTable& table, const RadialProfiles& profiles, const std::string& fit) {
  if (fit == "monotone") {
    fmt::print(
        "\nfit: monotone cubic through every entry (--fit 4 to 8 shows the residuals of polynomials)\n");
    return;
  }
  fmt::print("\nfit: polynomials of order {}, residuals rms and maximum, g relative to the axis\n", fit);
  fmt::print("{:>15} {:>23} {:>23} {:>23}\n", "wavelength [nm]", "image height [um]", "g_source", "g_sensor");
  for (const double wavelength : table.wavelengths_nm) {
    const FitResiduals r = profiles.residuals_at(wavelength);
    fmt::print("{:>15g} {:>11.4f} {:>11.4f} {:>11.2e} {:>11.2e} {:>11.2e} {:>11.2e}{}\n", wavelength,
               r.height_rms_um, r.height_max_um, r.g_source_rms, r.g_source_max, r.g_sensor_rms,
               r.g_sensor_max, r.monotone ? "" : "  turns back between fields: of no use");
  }
}

void info(const TableInfoCommand& command, const Shared& shared) {
  const RadialFit fit = RadialFit::parse(command.fit);
  const LensDataTable table = read_table(command.path);
  const RadialProfiles profiles(table, fit);
  if (shared.json) return print_json(info_json(table, profiles, command.fit));
  print_header(table);
  print_axial_light(table);
  print_rows(table);
  print_fit(table, profiles, command.fit);
}

void add_build(CLI::App& optics, Shared& shared) {
  auto options = std::make_shared<BuildCommand>();
  CLI::App* command =
      add_command(optics, shared, "build", "Compute the lens data table of a lens",
                  "petzval optics build edmund-54852 --sensor 768x576@6.25 --wavelengths 400:50:700 "
                  "-o edmund.h5",
                  false, [options, &shared] {
                    const ThreadLimit limit(shared.threads);
                    build(*options, shared);
                  });
  options->lens.add_to(*command);
  command->add_option("-o,--output", options->output, "The table, an HDF5 file")
      ->check(output_file())
      ->required();
  command->add_option("--wavelengths", options->wavelengths,
                      "In nm: 400:10:700, or a list 450,550,650; default: the lens's own");
  CLI::Option* sensor =
      command->add_option("--sensor", options->sensor,
                          "Reach the corner of this sensor: 768x576@6.25 (pitch in um), file or name");
  command->add_option("--image-height", options->image_height_mm, "Reach this real image height [mm]")
      ->excludes(sensor);
  command->add_option("--fields", options->field_count, "Number of fields, the axis included")
      ->capture_default_str();
  command->add_option("--focus", options->focus, "design, infinity, or a distance from the sensor [mm]")
      ->capture_default_str();
  command->add_option("--f-number", options->f_number, "Stop down to this paraxial f-number at infinity");
  command
      ->add_option_function<std::string>(
          "--apertures",
          [options](const std::string& choice) { options->apertures.from_fields = choice == "from-fields"; },
          "Clear apertures that the file leaves out: unbounded (file), or what the lens's fields need "
          "(from-fields)")
      ->check(CLI::IsMember({"file", "from-fields"}));
  command->add_flag("--ignore-apertures", options->apertures.ignore_apertures,
                    "Let nothing but the stop clip the rays");
  options->losses.add_to(*command);
}

void add_info(CLI::App& optics, Shared& shared) {
  auto options = std::make_shared<TableInfoCommand>();
  CLI::App* command = add_command(optics, shared, "info", "Show a lens data table and how well curves fit it",
                                  "petzval optics info edmund.h5 --fit 6", true,
                                  [options, &shared] { info(*options, shared); });
  command->add_option("table", options->path, "A lens data table (.h5)")->required();
  command->add_option("--fit", options->fit, "monotone, or the order of a polynomial: 4 to 8")
      ->capture_default_str();
}

}  // namespace

void add_optics_commands(CLI::App& app, Shared& shared) {
  CLI::App* optics = app.add_subcommand("optics", "Lens data tables: what a lens does to light, stored");
  optics->require_subcommand(1);
  add_build(*optics, shared);
  add_optics_import(*optics, shared);
  add_optics_export(*optics, shared);
  add_info(*optics, shared);
}

}  // namespace petzval::app
