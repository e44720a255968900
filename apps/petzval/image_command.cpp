// SPDX-License-Identifier: BSD-3-Clause
// petzval image: a planar scene through a lens, onto a sensor.
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/progress.h>
#include <petzval/base/staged_files.h>
#include <petzval/base/units.h>
#include <petzval/base/whole_file.h>
#include <petzval/camera/camera.h>
#include <petzval/image/formats/irradiance.h>
#include <petzval/image/picture.h>
#include <petzval/imaging/field_of_view.h>
#include <petzval/imaging/image_formation.h>
#include <petzval/optics/build.h>
#include <petzval/optics/table_file.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>

#include "field_option.h"
#include "scene_option.h"
#include "sensor_option.h"
#include "shot_option.h"

namespace petzval::app {

namespace {

struct ImageCommand {
  SceneChoice scene;
  LensChoice lens;
  FieldChoice apertures;  ///< only --apertures and --ignore-apertures of it
  std::string optics, sensor;
  std::vector<std::string> sensor_settings;
  std::string focus = "auto", method = "product", interpolate = "psf", fit = "monotone", surround = "error";
  std::optional<double> f_number;
  SectionOptions sections;
  ProductOptions product;
  int supersample = 1;
  ShotChoice shot;
  std::vector<std::string> outputs;
};

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

void check_outputs(const std::vector<std::string>& outputs) {
  const std::vector<std::string> known = {".exr", ".npy", ".dng", ".png", ".tif", ".tiff"};
  for (const std::string& path : outputs) {
    if (std::find(known.begin(), known.end(), extension_of(path)) == known.end())
      throw InputError(
          path, "irradiance is written as .exr or .npy, a raw file as .dng, a picture as .png or .tif");
    WholeFile(std::string(path));  // says if there is no such folder
  }
}

/// Options of one method with another would do nothing.
void check_method(const ImageCommand& command) {
  const bool by_sections = command.method == "sections" || command.method == "blended";
  const SectionOptions sections;
  const ProductOptions product;
  const auto refuse = [&](bool given, const char* option, const char* methods) {
    if (given)
      throw InputError(
          fmt::format("{} has no effect on --method {}; it belongs to {}", option, command.method, methods));
  };
  refuse(!by_sections && command.sections.section != sections.section, "--section",
         "--method sections and blended");
  refuse(!by_sections && command.sections.transform != sections.transform, "--transform",
         "--method sections and blended");
  const bool by_product = command.method == "product";
  refuse(!by_product && command.product.tolerance != product.tolerance, "--tolerance", "--method product");
  refuse(!by_product && command.product.nodes != product.nodes, "--nodes", "--method product");
  refuse(!by_product && command.product.tile != product.tile, "--tile", "--method product");
}

ImagingOptions imaging_options(const ImageCommand& command) {
  check_method(command);
  ImagingOptions options;
  options.method = command.method == "none"       ? BlurMethod::none
                   : command.method == "exact"    ? BlurMethod::exact
                   : command.method == "sections" ? BlurMethod::sections
                   : command.method == "blended"  ? BlurMethod::blended
                                                  : BlurMethod::product;
  options.product = command.product;
  options.sections = command.sections;
  options.interpolation = command.interpolate == "otf" ? PsfInterpolation::otf : PsfInterpolation::psf;
  options.fit = RadialFit::parse(command.fit);
  options.supersample = command.supersample;
  options.surround = command.surround == "zero"     ? Surround::zero
                     : command.surround == "extend" ? Surround::extend
                                                    : Surround::error;
  options.validate();
  return options;
}

/// A stored table is what it is: options that would make another one are refused.
void check_sources(const ImageCommand& command) {
  const bool stored = !command.optics.empty();
  if (stored == !command.lens.path_or_name.empty())
    throw InputError("the light needs a lens: give either --lens LENS or --optics TABLE.h5");
  const auto refuse = [&](bool given, const char* option) {
    if (stored && given)
      throw InputError(
          fmt::format("{} has no effect on a lens data table; build another one with petzval optics build, "
                      "or give --lens",
                      option));
  };
  refuse(command.f_number.has_value(), "--f-number");
  refuse(command.focus != "auto", "--focus");
  refuse(!command.lens.settings.empty(), "--set");
  refuse(!command.lens.substitutions.empty(), "--substitute");
  refuse(command.apertures.from_fields, "--apertures");
  refuse(command.apertures.ignore_apertures, "--ignore-apertures");
}

/// The distance in --focus, if it is one; infinite for "infinity".
std::optional<double> focus_distance_mm(const std::string& focus) {
  if (focus == "auto" || focus == "design") return {};
  if (focus == "infinity" || focus == "inf") return INFINITY;
  double distance_mm = 0;
  const auto [end, error] = std::from_chars(focus.data(), focus.data() + focus.size(), distance_mm);
  if (error != std::errc() || end != focus.data() + focus.size() || !(distance_mm > 0))
    throw InputError(fmt::format(
        "--focus {}: auto (the scene), design, infinity or a distance from the sensor in mm would be right",
        focus));
  return distance_mm;
}

/// Where a chart or a photograph stands if nobody says: where the lens or its table expects the object.
Scene read_scene(const ImageCommand& command, std::optional<double> expected_m, bool expected) {
  SceneOptions defaults;
  if (expected && command.scene.is_open()) defaults.distance_m = expected_m.value_or(INFINITY);
  Scene scene = command.scene.read(defaults);
  scene.validate();
  return scene;
}

/// The lens as it is used: focused as asked, the object where the scene is.
Lens focused(Camera camera, const std::string& focus, std::optional<double> scene_distance_m) {
  if (focus == "auto") {
    camera.focus_at_m(scene_distance_m);
    return camera.lens();
  }
  if (const std::optional<double> distance_mm = focus_distance_mm(focus))
    camera.focus_at_m(*distance_mm / mm_per_m);
  // The sensor stays; only the object moves.
  Camera here(camera.lens());
  if (here.object_distance_from_sensor_m() != scene_distance_m) here.place_object_at_m(scene_distance_m);
  return here.lens();
}

/// How far from the axis light will be wanted: to the sensor's corner, or to that of the scene's image.
double image_height_mm(const Scene& scene, const Lens& lens, const std::optional<SensorGeometry>& sensor) {
  if (sensor) return sensor->half_diagonal_mm();
  return natural_pitch_um(scene, first_order(lens)) * mm_per_um * std::hypot(scene.columns(), scene.rows()) /
         2;
}

struct SceneAndTable {
  Scene scene;
  LensDataTable table;
};

SceneAndTable from_stored_table(const ImageCommand& command) {
  LensDataTable table = read_table(command.optics);
  std::optional<double> distance_m = object_to_sensor_mm(table);
  if (distance_m) *distance_m /= mm_per_m;
  return {read_scene(command, distance_m, true), std::move(table)};
}

SceneAndTable from_lens(const ImageCommand& command, const std::optional<SensorGeometry>& sensor,
                        const ProgressCallback& progress, const Shared& shared) {
  focus_distance_mm(command.focus);  // refuses nonsense before anything is read
  Camera camera(command.apertures.prepare(command.lens.read(shared), shared));
  if (command.f_number) camera.set_f_number(*command.f_number);
  Scene scene = read_scene(command, camera.object_distance_from_sensor_m(), command.focus == "design");
  const Lens lens = focused(camera, command.focus, scene.distance_m());
  TableOptions options;
  options.wavelengths_nm = scene.wavelengths_nm();
  if (command.apertures.ignore_apertures) options.clip = Tracer::Clip::stop_only;
  options.max_image_height_mm = image_height_mm(scene, lens, sensor);
  return {std::move(scene), build_lens_data_table(lens, options, progress)};
}

/// A chart or a photograph without an angle of its own fills the frame; without a sensor the frame follows
/// the scene.
SensorGeometry fit_to_each_other(const ImageCommand& command, const ImagingOptions& options, Scene& scene,
                                 const LensDataTable& table, const std::optional<SensorGeometry>& sensor,
                                 const Shared& shared) {
  if (!sensor) {
    const SensorGeometry frame = natural_sensor(scene, table, options);
    note(shared,
         fmt::format("no --sensor: {} x {} pixels of {:.5g} um, the scene's samples as the lens images them "
                     "on the axis, as many as the scene covers",
                     frame.columns, frame.rows, frame.pitch_um));
    return frame;
  }
  if (command.scene.is_open() && command.scene.angle.empty() && options.surround == Surround::error) {
    scene.set_horizontal_angle_deg(covering_angle_deg(scene, table, *sensor, options));
    note(shared,
         fmt::format("the {} is made {:.2f} degrees wide, to fill the frame and the margin of the PSF "
                     "(--scene-angle sets another)",
                     command.scene.is_chart() ? "chart" : "photograph", scene.horizontal_angle_deg()));
  }
  return *sensor;
}

std::string method_text(const ImagingOptions& options, const ImagingReport& report) {
  if (options.method == BlurMethod::none) return "distortion and illumination, no blur";
  const std::string between = options.interpolation == PsfInterpolation::otf ? "OTFs" : "PSFs";
  if (options.method == BlurMethod::exact)
    return fmt::format("exact, every cell its own PSF; {} interpolated", between);
  if (options.method == BlurMethod::product) {
    const ProductPlan& plan = report.product;
    const std::string error = fmt::format("estimated error {:.1e} of {:g}; {} interpolated",
                                          plan.estimated_error, options.product.tolerance, between);
    if (plan.transform == 0) return fmt::format("blended sections of {0} x {0} cells, {1}", plan.tile, error);
    return fmt::format("product, {0} x {0} nodes in tiles of {1} x {1} cells, transforms of {2} x {2}, {3}",
                       plan.nodes, plan.tile, plan.transform, error);
  }
  return fmt::format("{3}sections of {0} x {0} cells, transforms of {1} x {1}; {2} interpolated",
                     options.sections.section, report.transform_size, between,
                     options.method == BlurMethod::blended ? "blended " : "");
}

std::string distance_text(const Scene& scene) {
  return scene.distance_m() ? fmt::format("{:g} m from the sensor", *scene.distance_m()) : "at infinity";
}

nlohmann::ordered_json summary_json(const SpectralImage& image, const Scene& scene,
                                    const LensDataTable& table, const ImagingReport& report,
                                    const std::string& method, const std::optional<Shot>& shot,
                                    const std::vector<std::string>& outputs) {
  nlohmann::ordered_json json = {
      {"columns", image.columns()},
      {"rows", image.rows()},
      {"pitch_um", image.pitch_um()},
      {"wavelengths_nm", image.wavelengths_nm()},
      {"scene", scene.name},
      {"scene_angle_deg", scene.horizontal_angle_deg()},
      {"scene_distance_m", number_or_null(scene.distance_m().value_or(INFINITY))},
      {"lens", table.lens_name},
      {"working_f_number", number_or_null(table.first_order.working_f_number)},
      {"method", method},
      {"margin_cells", report.margin_cells},
      {"scene_points_per_cell", report.scene_points_per_cell * report.scene_points_per_cell},
      {"least_captured", report.least_captured},
      {"irradiance_unit", "W.m^-2.nm^-1"},
      {"irradiance_min", report.darkest},
      {"irradiance_max", report.brightest},
      {"estimated_error", report.product.estimated_error},
      {"distortion_seconds", report.distortion_seconds},
      {"blur_seconds", report.blur_seconds},
      {"kernel_seconds", report.kernel_seconds},
      {"notes", report.notes},
      {"outputs", outputs}};
  if (shot) {
    json["exposure_s"] = shot->raw.exposure_s;
    json["iso"] = shot->raw.iso;
    json["as_shot_neutral"] = shot->raw.as_shot_neutral;
  }
  if (shot && shot->development) {
    json["temperature_k"] = shot->development->temperature_k;
    json["defects_corrected"] = shot->development->defects;
  }
  return json;
}

void print_summary(const SpectralImage& image, const Scene& scene, const LensDataTable& table,
                   const ImagingReport& report, const std::string& method, const std::optional<Shot>& shot) {
  const auto& bands = image.wavelengths_nm();
  fmt::print("{} x {} pixels of {:.5g} um, ", image.columns(), image.rows(), image.pitch_um());
  if (bands.size() == 1)
    fmt::print("1 band at {:g} nm\n", bands.front());
  else
    fmt::print("{} bands from {:g} to {:g} nm\n", bands.size(), bands.front(), bands.back());
  fmt::print("  scene       {}, {:.4g} degrees wide, {}\n", scene.name, scene.horizontal_angle_deg(),
             distance_text(scene));
  fmt::print("  lens        {}, working f-number {:.4g}\n", table.lens_name,
             table.first_order.working_f_number);
  fmt::print("  method      {}\n", method);
  fmt::print("  irradiance  {:.4g} to {:.4g} W/(m2 nm)\n", report.darkest, report.brightest);
  if (!shot) return;
  fmt::print("  exposure    {:.4g} s, ISO {:.0f}, on {}\n", shot->raw.exposure_s, shot->raw.iso,
             shot->raw.sensor_name);
  if (shot->development && shot->raw.channels.size() > 1)
    fmt::print("  developed   white {:.4f}, {} defects corrected\n",
               fmt::join(shot->development->neutral, " "), shot->development->defects);
}

/// The white of the scene, if its light in these bands can be taken for white at all: two or three narrow
/// bands cannot.
std::optional<Spectrum> usable_white(const SpectralImage& image, const Scene& scene, const Shared& shared) {
  const SpectralImage one_pixel(1, 1, image.wavelengths_nm(), image.pitch_um());
  PictureOptions options;
  options.scene_white = scene.illuminant;
  try {
    PictureRenderer(one_pixel, options);
    return scene.illuminant;
  } catch (const InputError& error) {
    note(shared,
         fmt::format("colours are shown as they fall on the sensor, not adapted to white: {}", error.what()));
    return {};
  }
}

std::optional<Shot> write_outputs(const ImageCommand& command, const SpectralImage& image, const Scene& scene,
                                  const std::optional<Sensor>& sensor, const Shared& shared) {
  StagedFiles files;
  for (const std::string& path : command.outputs) {
    const std::string extension = extension_of(path);
    if (extension == ".exr" || extension == ".npy") {
      write_irradiance(files.stage(path), image);
    } else if (extension == ".png" && !command.shot.develops(sensor)) {
      PictureOptions options;
      options.scene_white = usable_white(image, scene, shared);
      options.false_colour = true;
      note(shared,
           fmt::format("{}: {}", path, write_picture(files.stage(path), image, options, command.shot.bits)));
    }
  }
  std::optional<Shot> shot = command.shot.shoot(image, sensor, command.outputs, files, shared);
  files.commit();
  return shot;
}

void image(const ImageCommand& command, const CLI::App& app, const Shared& shared) {
  check_outputs(command.outputs);
  check_sources(command);
  ImagingOptions options = imaging_options(command);
  std::optional<Sensor> camera_sensor;
  std::optional<SensorGeometry> wanted;
  if (command.sensor.empty() && !command.sensor_settings.empty())
    throw InputError("--sensor-set alters the --sensor, and there is none");
  if (!command.sensor.empty()) {
    camera_sensor = read_sensor(command.sensor, command.sensor_settings);
    wanted = camera_sensor->geometry;
    options.photosite = camera_sensor->photosite;
  }
  command.shot.check(camera_sensor, command.outputs, app);

  ProgressBar bar(!shared.quiet);
  auto [scene, table] = command.optics.empty() ? from_lens(command, wanted, bar.callback(), shared)
                                               : from_stored_table(command);
  const SensorGeometry sensor = fit_to_each_other(command, options, scene, table, wanted, shared);
  if (!scene.depth_m.empty())
    note(shared, "the scene's depth map is not used: the scene is imaged as a plane");

  ImagingReport report;
  SpectralImage picture = form_image(scene, table, sensor, options, bar.callback(), &report);
  const std::string method = method_text(options, report);
  picture.provenance =
      fmt::format("petzval {} image: {} {} through {}, working f-number {:.4g}; {}", version(), scene.name,
                  distance_text(scene), table.lens_name, table.first_order.working_f_number, method);
  for (const std::string& line : report.notes) note(shared, line);
  const std::optional<Shot> shot = write_outputs(command, picture, scene, camera_sensor, shared);
  if (shared.json)
    return print_json(summary_json(picture, scene, table, report, method, shot, command.outputs));
  if (!shared.quiet) print_summary(picture, scene, table, report, method, shot);
}

void add_lens_options(CLI::App& command, ImageCommand& options) {
  options.lens.add_to(command, false, false);
  command.add_option("--optics", options.optics,
                     "A lens data table (petzval optics build) in place of a lens");
  command.add_option("--f-number", options.f_number, "Stop down to this paraxial f-number at infinity");
  command
      .add_option(
          "--focus", options.focus,
          "auto: the scene, by moving the sensor; design: the prescription's; infinity, or a distance from "
          "the sensor [mm]")
      ->capture_default_str();
  command
      .add_option_function<std::string>(
          "--apertures",
          [&options](const std::string& choice) { options.apertures.from_fields = choice == "from-fields"; },
          "Clear apertures that the file leaves out: unbounded (file), or what the lens's fields need "
          "(from-fields)")
      ->check(CLI::IsMember({"file", "from-fields"}));
  command.add_flag("--ignore-apertures", options.apertures.ignore_apertures,
                   "Let nothing but the stop clip the rays");
}

void add_method_options(CLI::App& command, ImageCommand& options) {
  command
      .add_option(
          "--method", options.method,
          "Blur: as many PSFs as --tolerance needs (product); one PSF a section, which fades into the "
          "next (blended) or does not (sections, as in the 2005 paper); one PSF a cell (exact, slow); "
          "none")
      ->check(CLI::IsMember({"product", "blended", "sections", "exact", "none"}))
      ->capture_default_str();
  command
      .add_option("--tolerance", options.product.tolerance,
                  "Relative L2 error of product against exact, at most (of an image of points)")
      ->capture_default_str();
  command.add_option("--nodes", options.product.nodes,
                     "PSFs along a side of a tile of product; 0: as --tolerance needs");
  command.add_option("--tile", options.product.tile, "Cells along a side of a tile of product; 0: chosen");
  command.add_option("--section", options.sections.section, "Cells along a side of a section")
      ->capture_default_str();
  command
      .add_option("--transform", options.sections.transform,
                  "Size of the Fourier transforms; 0: the smallest")
      ->capture_default_str();
  command
      .add_option("--supersample", options.supersample,
                  "Source cells along a side of a pixel; 3 or more for scenes finer than a pixel")
      ->capture_default_str();
  command.add_option("--interpolate", options.interpolate, "What is interpolated between the table's fields")
      ->check(CLI::IsMember({"psf", "otf"}))
      ->capture_default_str();
  command
      .add_option("--fit", options.fit,
                  "Distortion and illumination: monotone, or a polynomial's order 4 to 8")
      ->capture_default_str();
  command.add_option("--surround", options.surround, "What lies beyond a scene that is too small")
      ->check(CLI::IsMember({"error", "zero", "extend"}))
      ->capture_default_str();
}

}  // namespace

void add_image_command(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<ImageCommand>();
  CLI::App* command =
      add_command(app, shared, "image", "Image a scene through a lens onto a sensor",
                  "petzval image studio --lens edmund-54852 --sensor 320x240@15 -o studio.png "
                  "-o studio.exr",
                  true, [options, &shared, &app] {
                    const ThreadLimit limit(shared.threads);
                    image(*options, *app.get_subcommand("image"), shared);
                  });
  options->scene.add_to(*command);
  add_lens_options(*command, *options);
  command->add_option("--sensor", options->sensor,
                      "768x576@6.25 (pitch in um), a file or a name; default: the scene's samples");
  add_sensor_settings(*command, options->sensor_settings);
  add_method_options(*command, *options);
  command
      ->add_option(
          "-o,--output", options->outputs,
          "Irradiance as .exr or .npy, what --sensor makes of it as .dng, a picture as .png or .tif; "
          "may be given several times")
      ->required()
      ->allow_extra_args(false);
  options->shot.add_to(*command);
  command->add_option("--bits", options->shot.bits, "Of the picture: 8 or 16")
      ->check(CLI::IsMember({8, 16}))
      ->capture_default_str();
}

}  // namespace petzval::app
