// SPDX-License-Identifier: BSD-3-Clause
#include "image_option.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/optics/table_file.h>

#include <algorithm>

#include "output_option.h"

namespace petzval::app {

namespace {

/// A stored table is what it is: options that would make another one are refused.
void check_sources(const ImageChoice& choice) {
  const bool stored = !choice.optics.empty();
  if (stored == !choice.camera.lens.path_or_name.empty())
    throw InputError("the light needs a lens: give either --lens LENS or --optics TABLE.h5");
  if (!stored) return;
  std::vector<std::string> given = choice.camera.given_lens_options();
  if (choice.image.depth.layers != 0) given.emplace_back("--layers");
  if (!choice.scene.depth.empty() && choice.scene.depth != "none") given.emplace_back("--scene-depth");
  if (!given.empty())
    throw InputError(
        fmt::format("{} has no effect on a lens data table; build another one with petzval optics build, "
                    "or give --lens",
                    given.front()));
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
  refuse(!by_sections && choice.image.imaging.sections.section != sections.section, "--section",
         "--method sections and blended");
  refuse(!by_sections && choice.image.imaging.sections.transform != sections.transform, "--transform",
         "--method sections and blended");
  const bool by_product = choice.method == "product";
  refuse(!by_product && choice.image.imaging.product.tolerance != product.tolerance, "--tolerance",
         "--method product");
  refuse(!by_product && choice.image.imaging.product.nodes != product.nodes, "--nodes", "--method product");
  refuse(!by_product && choice.image.imaging.product.tile != product.tile, "--tile", "--method product");
}

}  // namespace

void ImageChoice::check() const {
  check_sources(*this);
  if (camera.sensor.empty() && !camera.sensor_settings.empty())
    throw InputError("--sensor-set alters the --sensor, and there is none");
}

Optics ImageChoice::read_optics(const Shared& shared) const {
  check();
  if (optics.empty()) return camera.camera(shared);
  TableCamera stored{read_table(optics)};
  if (!camera.sensor.empty()) stored.sensor = read_sensor(camera.sensor, camera.sensor_settings);
  return stored;
}

ImageOptions ImageChoice::image_options() const {
  check_method(*this);
  ImageOptions options = image;
  ImagingOptions& imaging = options.imaging;
  imaging.method = method == "none"       ? BlurMethod::none
                   : method == "exact"    ? BlurMethod::exact
                   : method == "sections" ? BlurMethod::sections
                   : method == "blended"  ? BlurMethod::blended
                                          : BlurMethod::product;
  imaging.interpolation = interpolate == "otf" ? PsfInterpolation::otf : PsfInterpolation::psf;
  imaging.fit = RadialFit::parse(fit);
  imaging.surround = surround == "zero"     ? Surround::zero
                     : surround == "extend" ? Surround::extend
                                            : Surround::error;
  options.flare = flare.options();
  return options;
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
      .add_option("--tolerance", image.imaging.product.tolerance,
                  "Relative L2 error of product against exact, at most (of an image of points)")
      ->capture_default_str();
  command.add_option("--nodes", image.imaging.product.nodes,
                     "PSFs along a side of a tile of product; 0: as --tolerance needs");
  command.add_option("--tile", image.imaging.product.tile,
                     "Cells along a side of a tile of product; 0: chosen");
  command.add_option("--section", image.imaging.sections.section, "Cells along a side of a section")
      ->capture_default_str();
  command
      .add_option("--transform", image.imaging.sections.transform,
                  "Size of the Fourier transforms; 0: the smallest")
      ->capture_default_str();
  command
      .add_option("--supersample", image.imaging.supersample,
                  "Cells along a side of a pixel, 1 to 16; 0: as many as --tolerance needs")
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

void ImageChoice::add_light_to(CLI::App& command) {
  scene.add_to(command);
  command
      .add_option(
          "--scene-angle-least", image.least_scene_angle_deg,
          "The least width of a chart or a photograph that fills the frame [degrees]: of one scale in "
          "several images")
      ->check(positive_number());
  camera.add_lens(command, false, false);
  command.add_option("--optics", optics, "A lens data table (petzval optics build) in place of a lens");
  camera.add_stop_and_focus(command, Focus::automatic());
  camera.add_positions(command);
  camera.add_apertures(command);
  camera.losses.add_to(command);
  command.add_option("--layers", image.depth.layers,
                     "Layers that a scene with depth is cut into; 0: as many as its defocus needs");
  camera.add_sensor(command,
                    "768x576@6.25 (pitch in um), a file or a name; default: the lens's fields, 640 x 480");
  add_method_options(command);
}

void ImageChoice::add_to(CLI::App& command) {
  add_light_to(command);
  flare.add_to(command, true);
  command
      .add_option_function<std::vector<int>>(
          "--bands",
          [this](const std::vector<int>& at) {
            image.bands = {at[0], at[1]};
          },
          "Only bands from FIRST up to LAST, counted from 0: a piece, which goes into --checkpoint alone; "
          "petzval merge puts pieces together")
      ->delimiter(':')
      ->expected(2)
      ->check(CLI::Range(0, 1 << 24))
      ->type_name("FIRST:LAST");
  command
      .add_option(
          "--checkpoint", image.checkpoint,
          "With --bands the file that these go into; without, the merged file: no band is formed again")
      ->check(output_file());
  command
      .add_option(
          "-o,--output", outputs,
          "Irradiance as .exr or .npy, what --sensor makes of it as .dng, a picture as .png, .jpg or .tif; "
          "may be given several times")
      ->check(output_file())
      ->required()
      ->allow_extra_args(false);
  shot.add_to(command);
  shot.add_display_to(command);
}

}  // namespace petzval::app
