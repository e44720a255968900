// SPDX-License-Identifier: BSD-3-Clause
// petzval lens new: a table to start from.
#include <fmt/format.h>
#include <petzval/base/whole_file.h>
#include <petzval/lens/formats/lens_table.h>

#include <memory>

#include "lens_commands.h"
#include "output_option.h"

namespace petzval::app {

void add_lens_new(CLI::App& lens, Shared& shared) {
  auto output = std::make_shared<std::string>();
  CLI::App* command = add_command(
      lens, shared, "new", "Write a table of a lens to start from: radius, thickness, glass, semi-diameter",
      "petzval lens new mine.csv", false, [output, &shared] {
        require_extension(*output, {".csv"}, "a table of a lens");
        write_whole_file(*output, lens_table_to_start_from());
        if (!shared.quiet) fmt::print("{0}: alter it, then petzval lens info {0}\n", *output);
      });
  command->add_option("output", *output, "File to write, .csv")->check(output_file())->required();
}

}  // namespace petzval::app
