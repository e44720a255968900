// SPDX-License-Identifier: BSD-3-Clause
#include "target_output.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>
#include <petzval/colour/display.h>
#include <petzval/image/formats/npy.h>
#include <petzval/image/formats/png.h>
#include <petzval/image/formats/tiff.h>
#include <petzval/target/exact_sfr.h>

#include <algorithm>
#include <iterator>

#include "field_option.h"
#include "output_option.h"

namespace petzval::app {

namespace {

/// Code values; values outside 0 … 1 are clipped.
std::vector<std::uint16_t> code_values(const TargetImage& image, int bits, bool linear) {
  std::vector<std::uint16_t> codes;
  codes.reserve(image.size());
  for (const double value : image.values()) {
    const double encoded = linear ? value : srgb_encoded(value);
    codes.push_back(bits == 8 ? quantised_8(encoded) : quantised_16(encoded));
  }
  return codes;
}

void write_picture_png(const std::string& path, const TargetImage& image, int bits, bool linear) {
  PngImage png;
  png.columns = image.columns(), png.rows = image.rows(), png.channels = 1, png.bits = bits;
  png.transfer = linear ? PngTransfer::linear : PngTransfer::srgb;
  png.samples = code_values(image, bits, linear);
  write_png(path, png);
}

void write_picture_tiff(const std::string& path, const TargetImage& image, int bits, bool linear) {
  TiffImage tiff;
  tiff.columns = image.columns(), tiff.rows = image.rows(), tiff.channels = 1;
  tiff.description = linear ? "petzval target, linear" : "petzval target, sRGB";
  const std::vector<std::uint16_t> codes = code_values(image, bits, linear);
  if (bits == 8)
    tiff.samples = std::vector<std::uint8_t>(codes.begin(), codes.end());
  else
    tiff.samples = codes;
  write_tiff(path, tiff);
}

}  // namespace

void TargetOutput::add_to(CLI::App& command) {
  command
      .add_option("-o,--output", paths,
                  "File to write, repeatable: levels as .png, .tif or .npy (float64), irradiance as .exr "
                  "(float), with --sensor a raw .dng")
      ->check(output_file())
      ->required()
      ->take_all()
      ->allow_extra_args(false);
  command
      .add_option("--black", black,
                  "Linear level of dark areas, 1 being full scale; with --sensor: saturation")
      ->capture_default_str();
  command.add_option("--white", white, "Linear level of the light ground")->capture_default_str();
  command.add_flag("--linear", linear, "Code values of .png and .tif are linear in light; default: sRGB");
  shot.add_to(command);
  command.get_option("--picture")
      ->description(
          "What a .png or .tif shows: developed, what the --sensor makes of the light, as `image` "
          "does; irradiance, the levels; auto: developed beside a .dng");
}

void TargetOutput::validate(const CLI::App& command) const {
  for (const std::string& path : paths)
    require_extension(path, {".png", ".tif", ".tiff", ".npy", ".exr", ".dng"}, "a target");
  const bool developed = std::ranges::any_of(
      paths, [&](const auto& path) { return is_picture_name(path) && holds_light(path); });
  shot.refuse_unused(command, developed, developed);
}

bool TargetOutput::holds_light(const std::string& path) const {
  const bool developed =
      shot.picture == "developed" || (shot.picture == "auto" && std::ranges::any_of(paths, is_raw_name));
  return is_picture_name(path) ? developed : extension_of(path) != ".npy";
}

void TargetOutput::write_levels(const std::string& path, const TargetImage& image) const {
  const std::string extension = extension_of(path);
  if (extension == ".png") return write_picture_png(path, image, shot.bits, linear);
  if (extension != ".npy") return write_picture_tiff(path, image, shot.bits, linear);
  const std::size_t shape[] = {static_cast<std::size_t>(image.rows()),
                               static_cast<std::size_t>(image.columns()), 1};
  write_npy(path, shape, std::span<const double>(image.values()));
}

void TargetOutput::write_light(const TargetRequest& request, StagedFiles& files,
                               const Context& context) const {
  std::vector<std::string> of_light;
  std::ranges::copy_if(paths, std::back_inserter(of_light),
                       [&](const auto& path) { return holds_light(path); });
  if (of_light.empty()) return;
  OutputOptions options = shot.options();
  options.picture = std::ranges::any_of(of_light, is_picture_name) ? OutputOptions::Shows::developed
                                                                   : OutputOptions::Shows::automatic;
  check_outputs(of_light, request.sensor, options);
  write_outputs(target(request, context), of_light, request.sensor, options, files, context);
}

void print_target_summary(const TargetRequest& request, const std::string& psf, const Otf& otf,
                          const TargetImage& image, const Shared& shared) {
  const TargetOptions options = target_options(request);
  const std::size_t polygons = request.scene.polygons.size();
  const auto [low, high] = std::ranges::minmax(image.values());
  const double mtf50 = mtf50_cpp(otf, options);
  const double cutoff = otf.cutoff_cpmm() * options.pitch_um * 1e-3;
  const double blur = geometric_blur_um(request);
  if (shared.json) {
    nlohmann::ordered_json json = {
        {"columns", image.columns()}, {"rows", image.rows()}, {"polygons", polygons}};
    json["rows_unit"] = "pixels";
    json["cutoff_cpp"] = cutoff;
    json["cutoff_cpmm"] = otf.cutoff_cpmm();
    json["mtf50_cpp"] = mtf50;
    json["geometric_blur_diameter_um"] = blur;
    json["least_value"] = low;
    json["greatest_value"] = high;
    return print_json(json);
  }
  fmt::print("{} x {} pixels of {:g} um, {} polygon{}\n", image.columns(), image.rows(), options.pitch_um,
             polygons, polygons == 1 ? "" : "s");
  fmt::print("  cut-off of the optics        {:10.4f} cycles/pixel, {:.2f} cycles/mm\n", cutoff,
             otf.cutoff_cpmm());
  fmt::print("  MTF50, edges along the grid  {:10.4f} cycles/pixel\n", mtf50);
  if (psf == "wavefront") fmt::print("  geometric blur diameter      {:10.4f} um\n", blur);
  fmt::print("  values                       {:10.6f} to {:.6f}\n", low, high);
}

}  // namespace petzval::app
