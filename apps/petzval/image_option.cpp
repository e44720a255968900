// SPDX-License-Identifier: BSD-3-Clause
#include "image_option.h"

#include "image_depth.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>

#include <algorithm>

#include "output_option.h"
#include "sensor_option.h"

namespace petzval::app {

namespace {

void check_outputs(const std::vector<std::string>& outputs) {
  const std::vector<std::string> known = {".exr", ".npy", ".dng", ".png", ".tif", ".tiff"};
  for (const std::string& path : outputs) {
    if (std::find(known.begin(), known.end(), extension_of(path)) == known.end())
      throw InputError(
          path, "irradiance is written as .exr or .npy, a raw file as .dng, a picture as .png or .tif");
  }
}

/// A stored table is what it is: options that would make another one are refused.
void check_sources(const ImageChoice& choice) {
  const bool stored = !choice.optics.empty();
  if (stored == !choice.lens.path_or_name.empty())
    throw InputError("the light needs a lens: give either --lens LENS or --optics TABLE.h5");
  const auto refuse = [&](bool given, const char* option) {
    if (stored && given)
      throw InputError(
          fmt::format("{} has no effect on a lens data table; build another one with petzval optics build, "
                      "or give --lens",
                      option));
  };
  refuse(choice.f_number.has_value(), "--f-number");
  refuse(choice.focus != "auto", "--focus");
  refuse(!choice.lens.settings.empty(), "--set");
  refuse(!choice.lens.substitutions.empty(), "--substitute");
  refuse(!choice.lens.glasses.paths.empty(), "--glass-catalogue");
  refuse(choice.apertures.from_fields, "--apertures");
  refuse(choice.apertures.ignore_apertures, "--ignore-apertures");
  refuse(choice.depth.layers != 0, "--layers");
  refuse(!choice.scene.depth.empty() && choice.scene.depth != "none", "--scene-depth");
}

/// Options of one method with another would do nothing.
void check_method(const ImageChoice& choice) {
  const bool by_sections = choice.method == "sections" || choice.method == "blended";
  const SectionOptions sections;
  const ProductOptions product;
  const auto refuse = [&](bool given, const char* option, const char* methods) {
    if (given)
      throw InputError(
          fmt::format("{} has no effect on --method {}; it belongs to {}", option, choice.method, methods));
  };
  refuse(!by_sections && choice.sections.section != sections.section, "--section",
         "--method sections and blended");
  refuse(!by_sections && choice.sections.transform != sections.transform, "--transform",
         "--method sections and blended");
  const bool by_product = choice.method == "product";
  refuse(!by_product && choice.product.tolerance != product.tolerance, "--tolerance", "--method product");
  refuse(!by_product && choice.product.nodes != product.nodes, "--nodes", "--method product");
  refuse(!by_product && choice.product.tile != product.tile, "--tile", "--method product");
}

}  // namespace

void ImageChoice::check() const {
  check_outputs(outputs);
  check_sources(*this);
  if (sensor.empty() && !sensor_settings.empty())
    throw InputError("--sensor-set alters the --sensor, and there is none");
}

ImagingOptions ImageChoice::imaging_options() const {
  check_method(*this);
  ImagingOptions options;
  options.method = method == "none"       ? BlurMethod::none
                   : method == "exact"    ? BlurMethod::exact
                   : method == "sections" ? BlurMethod::sections
                   : method == "blended"  ? BlurMethod::blended
                                          : BlurMethod::product;
  options.product = product;
  options.sections = sections;
  options.interpolation = interpolate == "otf" ? PsfInterpolation::otf : PsfInterpolation::psf;
  options.fit = RadialFit::parse(fit);
  options.supersample = supersample;
  options.surround = surround == "zero"     ? Surround::zero
                     : surround == "extend" ? Surround::extend
                                            : Surround::error;
  options.validate();
  return options;
}

void ImageChoice::add_lens_options(CLI::App& command) {
  lens.add_to(command, false, false);
  command.add_option("--optics", optics, "A lens data table (petzval optics build) in place of a lens");
  command.add_option("--f-number", f_number, "Stop down to this paraxial f-number at infinity");
  command
      .add_option(
          "--focus", focus,
          "auto: the scene, by moving the sensor; design: the prescription's; infinity, or a distance from "
          "the sensor [mm]")
      ->capture_default_str();
  command
      .add_option_function<std::string>(
          "--apertures",
          [this](const std::string& choice) { apertures.from_fields = choice == "from-fields"; },
          "Clear apertures that the file leaves out: unbounded (file), or what the lens's fields need "
          "(from-fields)")
      ->check(CLI::IsMember({"file", "from-fields"}));
  command.add_flag("--ignore-apertures", apertures.ignore_apertures,
                   "Let nothing but the stop clip the rays");
}

void ImageChoice::add_method_options(CLI::App& command) {
  command
      .add_option(
          "--method", method,
          "Blur: as many PSFs as --tolerance needs (product); one PSF a section, which fades into the "
          "next (blended) or does not (sections, as in the 2005 paper); one PSF a cell (exact, slow); "
          "none")
      ->check(CLI::IsMember({"product", "blended", "sections", "exact", "none"}))
      ->capture_default_str();
  command
      .add_option("--tolerance", product.tolerance,
                  "Relative L2 error of product against exact, at most (of an image of points)")
      ->capture_default_str();
  command.add_option("--nodes", product.nodes,
                     "PSFs along a side of a tile of product; 0: as --tolerance needs");
  command.add_option("--tile", product.tile, "Cells along a side of a tile of product; 0: chosen");
  command.add_option("--section", sections.section, "Cells along a side of a section")->capture_default_str();
  command.add_option("--transform", sections.transform, "Size of the Fourier transforms; 0: the smallest")
      ->capture_default_str();
  command
      .add_option("--supersample", supersample,
                  "Source cells along a side of a pixel; 3 or more for scenes finer than a pixel")
      ->capture_default_str();
  command.add_option("--interpolate", interpolate, "What is interpolated between the table's fields")
      ->check(CLI::IsMember({"psf", "otf"}))
      ->capture_default_str();
  command.add_option("--fit", fit, "Distortion and illumination: monotone, or a polynomial's order 4 to 8")
      ->capture_default_str();
  command.add_option("--surround", surround, "What lies beyond a scene that is too small")
      ->check(CLI::IsMember({"error", "zero", "extend"}))
      ->capture_default_str();
}

void ImageChoice::add_to(CLI::App& command) {
  scene.add_to(command);
  command
      .add_option(
          "--scene-angle-least", scene_angle_least,
          "The least width of a chart or a photograph that fills the frame [degrees]: of one scale in "
          "several images")
      ->check(positive_number());
  add_lens_options(command);
  add_depth_options(command, depth);
  command.add_option("--sensor", sensor,
                     "768x576@6.25 (pitch in um), a file or a name; default: the scene's samples");
  add_sensor_settings(command, sensor_settings);
  add_method_options(command);
  command
      .add_option("-o,--output", outputs,
                  "Irradiance as .exr or .npy, what --sensor makes of it as .dng, a picture as .png or .tif; "
                  "may be given several times")
      ->check(output_file())
      ->required()
      ->allow_extra_args(false);
  shot.add_to(command);
  command.add_option("--bits", shot.bits, "Of the picture: 8 or 16")
      ->check(CLI::IsMember({8, 16}))
      ->capture_default_str();
}

}  // namespace petzval::app
