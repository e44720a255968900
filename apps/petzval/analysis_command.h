// SPDX-License-Identifier: BSD-3-Clause
// What the analyses by field and wavelength have in common on the command line.
#pragma once

#include <memory>
#include <string>

#include "camera_option.h"
#include "field_option.h"
#include "output_option.h"

namespace petzval::app {

struct AnalysisCommand {
  LensChoice lens;
  FieldChoice fields;
  CameraChoice camera;
  std::string plot;

  /// The lens as the analysis sees it: read, set, stopped down and focused, with apertures as asked.
  Lens prepare(const Shared& shared) const {
    const Lens read = fields.prepare(lens.read(shared), shared);
    return camera.used(read, fields.request(read), shared);
  }
};

/// Adds a subcommand with LENS, fields, wavelengths, apertures and --plot FILE.svg around `work`.
template <class Options, class Work>
CLI::App* add_analysis_command(CLI::App& parent, Shared& shared, const std::string& name,
                               const std::string& description, const std::string& example,
                               const std::shared_ptr<Options>& options, Work work) {
  CLI::App* command = add_command(parent, shared, name, description, example, true, [=, &shared] {
    if (!options->plot.empty()) require_extension(options->plot, {".svg"}, "a plot");
    work(*options, shared);
  });
  options->lens.add_to(*command);
  options->fields.add_to(*command);
  options->camera.add_to(*command);
  command->add_option("--plot", options->plot, "Also draw the result into this SVG file")
      ->check(output_file());
  return command;
}

/// The head of the JSON of an analysis, with an empty "rows".
inline nlohmann::ordered_json analysis_json(const Lens& lens, const FieldTableRequest& request) {
  return {{"lens", lens.name},
          {"field_definition", field_definition(request.field_kind)},
          {"reference_wavelength_nm", lens.reference_wavelength_nm},
          {"rows", nlohmann::ordered_json::array()}};
}

}  // namespace petzval::app
