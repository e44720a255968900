// SPDX-License-Identifier: BSD-3-Clause
// petzval optics info: what a lens data table holds, and how well curves fit it.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/optics/irradiance_formula.h>
#include <petzval/optics/table_file.h>
#include <petzval/optics/table_interpolation.h>
#include <petzval/optics/table_layout.h>

#include <cmath>
#include <memory>

#include "field_option.h"
#include "optics_commands.h"

namespace petzval::app {

namespace {

struct TableInfoCommand {
  std::string path;
  std::string fit = "monotone";
};

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

/// Of a table over the frame: a row for each place and wavelength.
nlohmann::ordered_json frame_rows_json(const LensDataTable& table) {
  const FramePlaces& frame = *table.frame;
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (std::size_t place = 0; place < table.places(); ++place)
    for (std::size_t w = 0; w < table.wavelengths_nm.size(); ++w) {
      const std::size_t i = table.index(place, w);
      rows.push_back({{"image_x_mm", frame.x_mm[place % frame.x_mm.size()]},
                      {"image_y_mm", frame.y_mm[place / frame.x_mm.size()]},
                      {"wavelength_nm", table.wavelengths_nm[w]},
                      {"object_x", frame.object_x[i]},
                      {"object_y", frame.object_y[i]},
                      {"g_source_sr", table.g_source_sr[i]},
                      {"g_sensor_sr", table.g_sensor_sr[i]},
                      {"psf_azimuth_deg", frame.psf_azimuth_deg[i]},
                      {"psf_size", table.psf[i].size},
                      {"psf_spacing_um", table.psf[i].spacing_um},
                      {"psf_captured", table.psf[i].captured}});
    }
  return rows;
}

nlohmann::ordered_json frame_info_json(const LensDataTable& table) {
  return {{"lens", table.lens_name},
          {"provenance", table.provenance},
          {"object_distance_mm", number_or_null(table.object_distance_mm.value_or(INFINITY))},
          {"vertex_to_sensor_mm", table.vertex_to_sensor_mm},
          {"first_order", first_order_json(table.first_order)},
          {"object_unit", table.field_unit()},
          {"wavelengths_nm", table.wavelengths_nm},
          {"image_x_mm", table.frame->x_mm},
          {"image_y_mm", table.frame->y_mm},
          {"rows", frame_rows_json(table)}};
}

void print_frame(const LensDataTable& table) {
  const FramePlaces& frame = *table.frame;
  fmt::print("\n{} x {} places over the frame, x' from {:g} to {:g} mm, y' from {:g} to {:g} mm\n",
             frame.x_mm.size(), frame.y_mm.size(), frame.x_mm.front(), frame.x_mm.back(), frame.y_mm.front(),
             frame.y_mm.back());
  fmt::print("{:>10} {:>10} {:>15} {:>13} {:>13} {:>13} {:>13} {:>11} {:>13} {:>9}\n", "x' [mm]", "y' [mm]",
             "wavelength [nm]", fmt::format("object x [{}]", table.field_unit()),
             fmt::format("object y [{}]", table.field_unit()), "g_source [sr]", "g_sensor [sr]",
             "PSF samples", "spacing [um]", "captured");
  for (std::size_t place = 0; place < table.places(); ++place)
    for (std::size_t w = 0; w < table.wavelengths_nm.size(); ++w) {
      const std::size_t i = table.index(place, w);
      const Psf& psf = table.psf[i];
      fmt::print(
          "{:>10.4g} {:>10.4g} {:>15g} {:>13.5f} {:>13.5f} {:>13.6f} {:>13.6f} {:>11} {:>13.4f} {:>9.4f}\n",
          frame.x_mm[place % frame.x_mm.size()], frame.y_mm[place / frame.x_mm.size()],
          table.wavelengths_nm[w], frame.object_x[i], frame.object_y[i], table.g_source_sr[i],
          table.g_sensor_sr[i], fmt::format("{0}x{0}", psf.size), psf.spacing_um, psf.captured);
    }
}

void info(const TableInfoCommand& command, const Shared& shared) {
  const RadialFit fit = RadialFit::parse(command.fit);
  const LensDataTable table = read_table(command.path);
  if (table.frame) {
    if (fit.polynomial_order != 0)
      throw InputError(command.path, "its places lie over the frame; --fit is for tables by field height");
    if (shared.json) return print_json(frame_info_json(table));
    print_header(table);
    return print_frame(table);
  }
  const RadialProfiles profiles(table, fit);
  if (shared.json) return print_json(info_json(table, profiles, command.fit));
  print_header(table);
  print_axial_light(table);
  print_rows(table);
  print_fit(table, profiles, command.fit);
}

}  // namespace

void add_optics_info(CLI::App& optics, Shared& shared) {
  auto options = std::make_shared<TableInfoCommand>();
  CLI::App* command = add_command(optics, shared, "info", "Show a lens data table and how well curves fit it",
                                  "petzval optics info edmund.h5 --fit 6", true,
                                  [options, &shared] { info(*options, shared); });
  command->add_option("table", options->path, "A lens data table (.h5)")->required();
  command->add_option("--fit", options->fit, "monotone, or the order of a polynomial: 4 to 8")
      ->capture_default_str();
}

}  // namespace petzval::app
