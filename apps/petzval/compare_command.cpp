// SPDX-License-Identifier: BSD-3-Clause
// petzval compare: how far one picture is from another.
#include <fmt/format.h>
#include <petzval/measure/picture_comparison.h>

#include <cmath>
#include <memory>

#include "field_option.h"

namespace petzval::app {

namespace {

struct CompareCommand {
  std::string picture, reference;
};

nlohmann::ordered_json numbers_of(const PictureDifference& difference) {
  return {{"relative_l2", number_or_null(difference.relative_l2)},
          {"max_error_over_peak", number_or_null(difference.max_error_over_peak)},
          {"psnr_db", number_or_null(difference.psnr_db)}};
}

void print_json_comparison(const ComparablePicture& picture, const ComparablePicture& reference,
                           const PictureComparison& comparison) {
  nlohmann::ordered_json json = {{"picture", picture.name}, {"reference", reference.name}};
  json.update(numbers_of(comparison.all));
  json["identical"] = comparison.all.max_error_over_peak == 0;
  json["peak"] = comparison.all.peak;
  json["units"] = reference.units.empty() ? picture.units : reference.units;
  json["columns"] = picture.columns;
  json["rows_of_pixels"] = picture.rows;
  json["bands"] = picture.bands;
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  const auto& wavelengths_nm =
      reference.wavelengths_nm.empty() ? picture.wavelengths_nm : reference.wavelengths_nm;
  for (std::size_t band = 0; band < picture.bands; ++band) {
    nlohmann::ordered_json row = {{"band", band}};
    if (!wavelengths_nm.empty()) row["wavelength_nm"] = wavelengths_nm[band];
    row.update(numbers_of(comparison.bands[band]));
    rows.push_back(row);
  }
  json["rows"] = rows;
  print_json(json);
}

void compare(const CompareCommand& options, const Shared& shared) {
  ComparablePicture picture = read_comparable_picture(options.picture);
  ComparablePicture reference = read_comparable_picture(options.reference);
  // Opacity that hides nothing is no reason why pictures should differ.
  if (picture.bands == reference.bands + 1) drop_full_opacity(picture);
  if (reference.bands == picture.bands + 1) drop_full_opacity(reference);
  const PictureComparison comparison = compare_pictures(picture, reference);
  if (shared.json) return print_json_comparison(picture, reference, comparison);
  const std::string& units = reference.units.empty() ? picture.units : reference.units;
  fmt::print("{} against {}: {} x {} pixels, {} band{}\n", picture.name, reference.name, picture.columns,
             picture.rows, picture.bands, picture.bands == 1 ? "" : "s");
  fmt::print("  relative L2 error   {:.4g}\n", comparison.all.relative_l2);
  fmt::print("  max error / peak    {:.4g}\n", comparison.all.max_error_over_peak);
  if (std::isinf(comparison.all.psnr_db) && comparison.all.psnr_db > 0)
    fmt::print("  PSNR                infinite: no value differs\n");
  else
    fmt::print("  PSNR                {:.2f} dB\n", comparison.all.psnr_db);
  fmt::print("  peak                {:.4g} {}\n", comparison.all.peak,
             picture.display ? "(full scale)" : units);
}

}  // namespace

void add_compare_command(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<CompareCommand>();
  CLI::App* command = add_command(
      app, shared, "compare", "How far a picture is from a reference: relative L2, max error, PSNR",
      "petzval compare picture.exr reference.exr", true, [=, &shared] { compare(*options, shared); });
  command->add_option("picture", options->picture, "A picture: spectral .exr, .npy, .png, .tif or .jpg")
      ->required();
  command
      ->add_option("reference", options->reference,
                   "What it is compared with, of the same size, bands and units")
      ->required();
}

}  // namespace petzval::app
