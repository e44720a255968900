// SPDX-License-Identifier: BSD-3-Clause
// petzval lens reverse.
#include <fmt/format.h>
#include <petzval/lens/lens_file.h>
#include <petzval/lens/reversed_lens.h>

#include <memory>

#include "lens_commands.h"
#include "output_option.h"

namespace petzval::app {

void add_lens_reverse(CLI::App& lens, Shared& shared) {
  struct Reverse {
    LensChoice lens;
    std::string output;
  };
  auto options = std::make_shared<Reverse>();
  CLI::App* command =
      add_command(lens, shared, "reverse", "Write a lens turned round, its sensor in the paraxial image",
                  "petzval lens reverse tessar -o turned.json", false, [options, &shared] {
                    const Lens turned = reversed_lens(options->lens.read(shared));
                    for (const std::string& line : write_lens(turned, options->output)) note(shared, line);
                    if (!shared.quiet)
                      fmt::print("{}: the sensor {:.6g} mm behind the last surface\n", options->output,
                                 turned.surfaces.back().thickness_mm);
                  });
  options->lens.add_to(*command);
  command->add_option("-o,--output", options->output, "Lens file to write; its extension tells the format")
      ->check(output_file())
      ->required();
}

}  // namespace petzval::app
