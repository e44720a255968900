// SPDX-License-Identifier: BSD-3-Clause
// petzval lens seidel: third-order aberrations by surface.
#include <fmt/format.h>
#include <petzval/analysis/seidel.h>
#include <petzval/base/units.h>
#include <petzval/base/whole_file.h>
#include <petzval/report/analysis_plots.h>

#include <memory>

#include "camera_option.h"
#include "field_option.h"
#include "lens_commands.h"
#include "output_option.h"
#include "plot_output.h"

namespace petzval::app {

namespace {

struct SeidelCommand {
  LensChoice lens;
  CameraChoice camera;
  std::string plot;
};

struct Term {
  const char *key, *label;
  double SeidelTerms::*value;
};

constexpr Term terms[] = {
    {"s1", "S1 spherical", &SeidelTerms::s1},     {"s2", "S2 coma", &SeidelTerms::s2},
    {"s3", "S3 astigmatism", &SeidelTerms::s3},   {"s4", "S4 Petzval", &SeidelTerms::s4},
    {"s5", "S5 distortion", &SeidelTerms::s5},    {"cl", "CL axial colour", &SeidelTerms::cl},
    {"ct", "CT lateral colour", &SeidelTerms::ct}};

nlohmann::ordered_json terms_json(const SeidelTerms& values) {
  nlohmann::ordered_json json;
  for (const Term& term : terms) json[term.key] = values.*term.value;
  return json;
}

void print_terms(const std::string& name, const SeidelTerms& values, double unit) {
  fmt::print("{:>9}", name);
  for (const Term& term : terms) fmt::print(" {:>17.9f}", values.*term.value / unit);
  fmt::print("\n");
}

void seidel(const SeidelCommand& options, const Shared& shared) {
  const Lens lens = options.camera.used(options.lens.read(shared), {}, shared);
  const SeidelSums sums = seidel_sums(lens);
  if (!options.plot.empty()) {
    const Plot plot = seidel_plot(sums);
    write_drawing(options.plot, plot_grid_svg({plot}, 1, lens.name));
  }
  if (shared.json) {
    nlohmann::ordered_json json = {
        {"lens", lens.name},
        {"unit", "mm of wavefront"},
        {"wavelength_nm", sums.wavelength_nm},
        {"colour_between_nm", {lens.wavelengths_nm.front(), lens.wavelengths_nm.back()}},
        {lens.object_distance_mm ? "object_height_mm" : "field_deg", sums.largest_field},
        {"lagrange_invariant_mm", sums.lagrange_invariant_mm},
        {"surfaces", nlohmann::ordered_json::array()}};
    for (const SeidelTerms& surface : sums.surfaces) json["surfaces"].push_back(terms_json(surface));
    json["sum"] = terms_json(sums.sum);
    return print_json(json);
  }
  fmt::print(
      "{}: Seidel coefficients [mm] at {:g} nm, largest field {:g} {}; colour between {:g} and {:g} nm\n",
      lens.name, sums.wavelength_nm, sums.largest_field, lens.object_distance_mm ? "mm" : "deg",
      lens.wavelengths_nm.front(), lens.wavelengths_nm.back());
  fmt::print("{:>9}", "surface");
  for (const Term& term : terms) fmt::print(" {:>17}", term.label);
  fmt::print("\n");
  for (std::size_t i = 0; i < sums.surfaces.size(); ++i)
    print_terms(fmt::format("{}", i), sums.surfaces[i], 1);
  print_terms("sum", sums.sum, 1);
  print_terms("in waves", sums.sum, sums.wavelength_nm * mm_per_nm);
}

}  // namespace

void add_lens_seidel(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<SeidelCommand>();
  CLI::App* command = add_command(lens, shared, "seidel", "Third-order aberrations, surface by surface",
                                  "petzval lens seidel cooke-triplet --plot seidel.svg", true, [=, &shared] {
                                    if (!options->plot.empty()) require_drawing(options->plot, "a plot");
                                    seidel(*options, shared);
                                  });
  options->lens.add_to(*command);
  options->camera.add_to(*command);
  command->add_option("--plot", options->plot, "Also draw the coefficients: .svg, .png or .pdf")
      ->check(output_file());
}

}  // namespace petzval::app
