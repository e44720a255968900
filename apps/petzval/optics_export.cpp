// SPDX-License-Identifier: BSD-3-Clause
// petzval optics export: lens data tables for other programs.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/optics/table_export.h>
#include <petzval/optics/table_file.h>

#include <filesystem>
#include <memory>

#include "optics_commands.h"
#include "output_option.h"

namespace petzval::app {

namespace {

struct ExportCommand {
  std::string path, to, output;
  TableExport how;
};

void check_output(const ExportCommand& command) {
  if (command.to == "zemax") {
    require_folder(command.output);
    const std::filesystem::path above =
        (std::filesystem::path(command.output) / "").parent_path().parent_path();
    if (!above.empty() && !std::filesystem::is_directory(above))
      throw InputError(command.output,
                       fmt::format("the folder {} does not exist; make it first", above.string()));
  } else {
    require_extension(command.output, {".mat"}, "ISETCam's optics structure");
    require_writable(command.output);
  }
}

void write_exported(const ExportCommand& command, const Shared& shared) {
  check_output(command);
  const LensDataTable table = read_table(command.path);
  try {
    for (const std::string& text :
         export_table(table, command.to == "zemax" ? TableTarget::zemax : TableTarget::iset, command.output,
                      command.how))
      note(shared, fmt::format("{}: {}", command.path, text));
  } catch (const InputError& error) {  // of the table, which does not know its file
    if (!error.parts().file.empty()) throw;
    throw InputError(command.path, error.what());
  }
}

}  // namespace

void add_optics_export(CLI::App& optics, Shared& shared) {
  auto options = std::make_shared<ExportCommand>();
  CLI::App* command = add_command(optics, shared, "export", "Write a lens data table for other programs",
                                  "petzval optics export edmund.h5 --to iset --resample -o edmund.mat", false,
                                  [options, &shared] { write_exported(*options, shared); });
  command->add_option("table", options->path, "A lens data table (.h5)")->required();
  command
      ->add_option("--to,--format", options->to,
                   "iset: a MAT file with ISETCam's optics structure; zemax: a folder of text files as ISET "
                   "imports them")
      ->check(CLI::IsMember({"iset", "iset-mat", "zemax"}))
      ->required();
  command->add_option("-o,--output", options->output, "The MAT file, or the folder")
      ->check(output_file_or_folder())
      ->required();
  command->add_flag("--resample", options->how.resample,
                    "Bring PSFs of several grids to one, which ISET needs; light and its centre stay");
  command
      ->add_option("--psf-spacing", options->how.psf_spacing_um,
                   "Spacing of that grid [um], implies --resample; default: the finest of the table")
      ->check(positive_number());
  command
      ->add_option("--psf-size", options->how.psf_size,
                   "Samples a side of that grid, implies --resample; default: the widest PSF's")
      ->check(CLI::Range(2, 4096));
  command
      ->add_option("--psf-light", options->how.psf_light,
                   "Least share of its light that every PSF must keep on that grid; default: 0.99")
      ->check(CLI::Range(0.0, 1.0));
}

}  // namespace petzval::app
