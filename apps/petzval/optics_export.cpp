// SPDX-License-Identifier: BSD-3-Clause
// petzval optics export: lens data tables for other programs.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/staged_files.h>
#include <petzval/optics/common_grid.h>
#include <petzval/optics/formats/iset_mat_table.h>
#include <petzval/optics/formats/zemax_table.h>
#include <petzval/optics/table_file.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "optics_commands.h"

namespace petzval::app {

namespace {

struct ExportCommand {
  std::string path, to, output;
  bool resample = false;
  std::optional<double> spacing_um;
  std::optional<int> size;
};

bool has_one_grid(const LensDataTable& table) {
  return std::all_of(table.psf.begin(), table.psf.end(),
                     [&](const Psf& psf) { return psf.spacing_um == table.psf.front().spacing_um; });
}

/// The table with its PSFs on one grid, if it is allowed to bring them there.
LensDataTable prepared(const ExportCommand& command, const Shared& shared) {
  LensDataTable table = read_table(command.path);
  const bool resample = command.resample || command.spacing_um || command.size;
  if (!resample || (has_one_grid(table) && !command.spacing_um && !command.size)) return table;
  PsfGridSize grid = common_grid(table);
  if (command.spacing_um) {
    grid.size = std::max(2, static_cast<int>(grid.size * grid.spacing_um / *command.spacing_um));
    grid.spacing_um = *command.spacing_um;
  }
  if (command.size) grid.size = *command.size;
  table = on_common_grid(table, grid);
  double least = 1;
  for (const Psf& psf : table.psf) least = std::min(least, psf.captured);
  note(shared,
       fmt::format("{}: the PSFs are resampled to {} x {} samples of {:g} um, which hold at least {:.3g} % "
                   "of the light",
                   command.path, grid.size, grid.size, grid.spacing_um, 100 * least));
  return table;
}

/// A name for files, from that of the lens.
std::string base_name_of(const std::string& lens) {
  std::string name;
  for (const char c : lens)
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' ? c : '_';
  return name.empty() ? "lens" : name;
}

void write_texts(const RayTraceData& data, const ExportCommand& command, const Shared& shared) {
  std::error_code error;
  const bool made = std::filesystem::create_directory(command.output, error);
  if (error) throw InputError(command.output, "cannot be made a folder: " + error.message());
  try {
    StagedFiles files;
    for (const std::string& text :
         write_zemax_table(data, command.output, base_name_of(data.lens_file), files))
      note(shared, fmt::format("{}: {}", command.output, text));
    files.commit();
  } catch (...) {
    if (made) std::filesystem::remove(command.output, error);
    throw;
  }
}

void export_table(const ExportCommand& command, const Shared& shared) {
  const LensDataTable table = prepared(command, shared);
  RayTraceData data;
  try {
    data = ray_trace_data(table);
  } catch (const InputError& error) {
    throw InputError(command.path, error.what());
  }
  if (command.to == "zemax") return write_texts(data, command, shared);
  write_iset_mat_table(data, command.output);
}

}  // namespace

void add_optics_export(CLI::App& optics, Shared& shared) {
  auto options = std::make_shared<ExportCommand>();
  CLI::App* command = add_command(optics, shared, "export", "Write a lens data table for other programs",
                                  "petzval optics export edmund.h5 --to iset --resample -o edmund.mat", false,
                                  [options, &shared] { export_table(*options, shared); });
  command->add_option("table", options->path, "A lens data table (.h5)")->required();
  command
      ->add_option("--to,--format", options->to,
                   "iset: a MAT file with ISETCam's optics structure; zemax: a folder of text files as ISET "
                   "imports them")
      ->check(CLI::IsMember({"iset", "iset-mat", "zemax"}))
      ->required();
  command->add_option("-o,--output", options->output, "The MAT file, or the folder")->required();
  command->add_flag("--resample", options->resample,
                    "Bring PSFs of several grids to one, which ISET needs; light and its centre stay");
  command
      ->add_option("--psf-spacing", options->spacing_um,
                   "Spacing of that grid [um]; default: the finest of the table")
      ->check(positive_number());
  command->add_option("--psf-size", options->size, "Samples a side of that grid; default: the widest PSF's")
      ->check(CLI::Range(2, 4096));
}

}  // namespace petzval::app
