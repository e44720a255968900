// SPDX-License-Identifier: BSD-3-Clause
// petzval develop: from a raw file to a picture.
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/staged_files.h>
#include <petzval/isp/display_picture.h>
#include <petzval/sensor/formats/camera_raw.h>
#include <petzval/simulate/outputs.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "command.h"
#include "develop_option.h"
#include "inset_option.h"
#include "output_option.h"

namespace petzval::app {

namespace {

struct DevelopCommand {
  std::string raw;
  DevelopChoice choice;
  std::vector<std::string> outputs, insets;
  int bits = 8;
};

void run_develop(const DevelopCommand& command, const Shared& shared) {
  for (const std::string& path : command.outputs)
    require_extension(path, display_picture_extensions(), "a picture");
  const std::vector<PictureInset> insets = parsed_insets(command.insets);
  if (!insets.empty() && std::ranges::none_of(command.outputs, is_picture_name))
    throw InputError("--inset has no effect: no picture to look at (.png, .tif) is asked for");
  StagedFiles files;
  std::vector<std::string> staged;
  for (const std::string& path : command.outputs) staged.push_back(files.stage(path));
  const RawImage raw = read_raw(command.raw);
  const std::vector<std::pair<std::string, std::string>> steps = command.choice.step_files();
  const DevelopStep write_step = [&](const std::string& name, const Planes& planes) {
    for (const auto& [wanted, path] : steps)
      if (wanted == name)
        write_display_picture(files.stage(path), planes, display_space(command.choice.space), 16,
                              fmt::format("step {} of development", name));
  };
  const Picture picture = develop(raw, command.choice.development(), context_of(shared),
                                  steps.empty() ? DevelopStep() : write_step);
  const DevelopReport& report = picture.report;
  for (std::size_t i = 0; i < staged.size(); ++i)
    write_picture(
        staged[i],
        !insets.empty() && is_picture_name(command.outputs[i]) ? with_insets(picture, insets) : picture,
        command.bits);
  files.commit();

  if (shared.json) {
    const nlohmann::ordered_json json = {{"columns", picture.planes.columns},
                                         {"rows_of_pixels", picture.planes.rows},
                                         {"mosaic", mosaic_text(raw.mosaic, raw.channels)},
                                         {"demosaic", report.demosaic},
                                         {"neutral", report.neutral},
                                         {"temperature_k", report.temperature_k},
                                         {"brightness_ev", report.exposure_ev},
                                         {"defects_corrected", report.defects},
                                         {"outputs", command.outputs}};
    return fmt::print("{}\n", json.dump(2));
  }
  if (shared.quiet) return;
  fmt::print("{} x {} pixels, {}, demosaic {}\n", picture.planes.columns, picture.planes.rows,
             mosaic_text(raw.mosaic, raw.channels), report.demosaic);
  fmt::print("  white {:.4f}{}, {} defects corrected\n", fmt::join(report.neutral, " "),
             report.temperature_k > 0 ? fmt::format(", light of {:.0f} K", report.temperature_k) : "",
             report.defects);
  if (report.exposure_ev != 0) fmt::print("  brighter by {:.2f} stops\n", report.exposure_ev);
}

}  // namespace

void add_develop_command(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<DevelopCommand>();
  CLI::App* command = add_command(app, shared, "develop", "Develop a raw file: a picture",
                                  "petzval develop raw.dng -o picture.png", true,
                                  [options, &shared] { run_develop(*options, shared); });
  command->add_option("raw", options->raw, "RAW.dng, or a camera's raw file (.nef, .cr2, .arw, ...)")
      ->required();
  options->choice.add_to(*command);
  command
      ->add_option("-o,--output", options->outputs,
                   "PICTURE.png, .jpg, .tif, .exr (linear), .npy (linear) or .dng (linear raw, for other "
                   "programs); may be given several times")
      ->check(output_file())
      ->required()
      ->allow_extra_args(false);
  add_inset_option(*command, options->insets);
  command->add_option("--bits", options->bits, "Of .png and .tif: 8 or 16")
      ->check(CLI::IsMember({8, 16}))
      ->capture_default_str();
}

}  // namespace petzval::app
