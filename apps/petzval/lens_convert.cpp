// SPDX-License-Identifier: BSD-3-Clause
// petzval lens convert.
#include <fmt/format.h>
#include <petzval/analysis/ray_fan.h>
#include <petzval/lens/lens_file.h>

#include <memory>

#include "camera_option.h"
#include "lens_commands.h"
#include "output_option.h"

namespace petzval::app {

namespace {

struct ConvertCommand {
  LensChoice lens;
  CameraChoice camera;
  bool from_fields = false;
  std::string output;
};

void convert(const ConvertCommand& options, const Shared& shared) {
  Lens lens = options.camera.used(options.lens.read(shared), {}, shared);
  if (options.from_fields) lens = with_apertures_from_fields(std::move(lens));
  for (const std::string& line : write_lens(lens, options.output)) note(shared, line);
  if (!shared.quiet) fmt::print("{}: {} surfaces\n", options.output, lens.surfaces.size());
}

}  // namespace

void add_lens_convert(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<ConvertCommand>();
  CLI::App* command =
      add_command(lens, shared, "convert",
                  "Write a lens in another format: .json (native), .zmx, .seq (CODE V), .dat (pbrt) "
                  "or .iset.json (ISET)",
                  "petzval lens convert dgauss-50mm dgauss.zmx", false,
                  [options, &shared] { convert(*options, shared); });
  options->lens.add_to(*command);
  options->camera.add_to(*command);
  command
      ->add_option_function<std::string>(
          "--apertures",
          [options](const std::string& choice) { options->from_fields = choice == "from-fields"; },
          "Clear apertures that the file does not give: none (file), or as wide as the fields need "
          "(from-fields)")
      ->check(CLI::IsMember({"file", "from-fields"}));
  command->add_option("output", options->output, "File to write; its extension tells the format")
      ->check(output_file())
      ->required();
}

}  // namespace petzval::app
