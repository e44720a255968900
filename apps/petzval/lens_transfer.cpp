// SPDX-License-Identifier: BSD-3-Clause
// petzval lens transfer.
#include <fmt/format.h>
#include <petzval/analysis/transfer_fit.h>
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>
#include <petzval/base/whole_file.h>
#include <petzval/lens/lens_file.h>

#include <algorithm>
#include <memory>

#include "lens_commands.h"
#include "output_option.h"

namespace petzval::app {

namespace {

struct TransferCommand {
  LensChoice lens;
  TransferFitRequest request;
  std::vector<std::string> outputs;
};

void print_fit(const TransferFit& fit) {
  const TransferAccuracy& of = fit.accuracy;
  fmt::print("{}: {} terms in each of 4 polynomials, rays to the power {}\n", fit.lens.name, fit.terms,
             2 * fit.degree + 1);
  fmt::print("  {} rays held out        median {:.3g} mm, {:.3g} rad; worst {:.3g} mm, {:.3g} rad\n", of.rays,
             of.median_mm, of.median_rad, of.worst_mm, of.worst_rad);
  if (of.worst_light) fmt::print("  light on the film        within {:.3g}\n", *of.worst_light);
  fmt::print("  paraxial determinant     1 within {:.3g}\n", fit.determinant_error);
}

void print_json(const TransferFit& fit) {
  const TransferAccuracy& of = fit.accuracy;
  fmt::print(
      "{{\"terms\": {}, \"degree\": {}, \"rays\": {}, \"median_mm\": {}, \"worst_mm\": {}, \"median_rad\": "
      "{}, "
      "\"worst_rad\": {}, \"worst_light\": {}, \"determinant_error\": {}}}\n",
      fit.terms, fit.degree, of.rays, of.median_mm, of.worst_mm, of.median_rad, of.worst_rad,
      of.worst_light ? fmt::format("{}", *of.worst_light) : "null", fit.determinant_error);
}

bool is_table(const std::string& path) {
  return extension_of(path) == ".csv";
}

TransferFit fitted(const TransferCommand& options, Shared& shared) {
  const std::string& from = options.lens.path_or_name;
  if (!is_table(from)) {
    const Lens lens = options.lens.read(shared);
    TransferFit fit = fit_transfer(lens, options.request);
    for (const std::string& output : options.outputs)
      if (is_table(output)) write_whole_file(output, ray_table_text(ray_table(lens, options.request)));
    return fit;
  }
  if (!options.lens.settings.empty())
    throw InputError("--set alters lenses, and " + from + " is a table of rays");
  if (std::any_of(options.outputs.begin(), options.outputs.end(), is_table))
    throw InputError("rays are those of a lens, and " + from + " is a table of them");
  return fit_transfer(read_ray_table(from), options.request);
}

}  // namespace

void add_lens_transfer(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<TransferCommand>();
  CLI::App* command = add_command(lens, shared, "transfer",
                                  "Fit what a lens does to rays, and write that in place of its surfaces",
                                  "petzval lens transfer dgauss-50mm -o box.json", true, [options, &shared] {
                                    const TransferFit fit = fitted(*options, shared);
                                    for (const std::string& output : options->outputs)
                                      if (!is_table(output))
                                        for (const std::string& line : write_lens(fit.lens, output))
                                          note(shared, line);
                                    if (shared.json)
                                      print_json(fit);
                                    else if (!shared.quiet)
                                      print_fit(fit);
                                  });
  options->lens.add_to(*command);
  command
      ->add_option("--bands", options->request.wavelengths_nm,
                   "Wavelengths to fit at [nm], separated by commas; default: the lens's own")
      ->delimiter(',');
  command
      ->add_option(
          "--tolerance", options->request.tolerance_mm,
          "What rays held out may be off by in front of the lens [mm], and in direction by this over "
          "the focal length")
      ->check(positive_number())
      ->capture_default_str();
  command->add_option("--degree", options->request.degree,
                      "Of the polynomials in the three invariants of a ray, 1 to 7; default: the least that "
                      "meets the tolerance");
  command->add_option("--film-radius", options->request.film_radius_mm,
                      "Light that lands within it counts [mm]; default: to the largest field");
  command
      ->add_option(
          "-o,--output", options->outputs,
          "Lens file to write: .json (native) or .raytransfer.json (ISET); .csv: the rays; repeatable")
      ->check(output_file())
      ->required();
}

}  // namespace petzval::app
