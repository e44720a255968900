// SPDX-License-Identifier: BSD-3-Clause
// petzval optics export: lens data tables for other programs.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/staged_files.h>
#include <petzval/base/whole_file.h>
#include <petzval/optics/common_grid.h>
#include <petzval/optics/formats/iset_mat_table.h>
#include <petzval/optics/formats/zemax_table.h>
#include <petzval/optics/table_file.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "optics_commands.h"
#include "output_option.h"

namespace petzval::app {

namespace {

struct ExportCommand {
  std::string path, to, output;
  bool resample = false;
  std::optional<double> spacing_um;
  std::optional<int> size;
  std::optional<double> least_light;
};

constexpr int most_samples = 4096;
/// Of all PSFs on one grid, as floats and once more as doubles on their way into a file.
constexpr double most_memory = 4.0 * (1 << 30), bytes_a_sample = 12;

bool has_one_grid(const LensDataTable& table) {
  return std::all_of(table.psf.begin(), table.psf.end(),
                     [&](const Psf& psf) { return psf.spacing_um == table.psf.front().spacing_um; });
}

/// The grid that is asked for. \throws InputError if its PSFs would be larger than can be written.
PsfGridSize asked_grid(const ExportCommand& command, const LensDataTable& table) {
  PsfGridSize grid = common_grid(table);
  const double width_um = grid.size * grid.spacing_um,
               spacing_um = command.spacing_um.value_or(grid.spacing_um);
  const double size = command.size ? *command.size : std::max(2.0, std::floor(width_um / spacing_um));
  const double bytes = bytes_a_sample * static_cast<double>(table.psf.size()) * size * size;
  if (size > most_samples || bytes > most_memory) {
    const double fit = std::min<double>(
        most_samples, std::sqrt(most_memory / bytes_a_sample / static_cast<double>(table.psf.size())));
    throw InputError(
        command.path,
        fmt::format(
            "{} PSFs of {:.4g} x {:.4g} samples of {:g} um would take {:.3g} GiB; up to {:g} GiB and {} "
            "samples a side are written: --psf-size {:.0f} or less, or --psf-spacing {:.3g} or more, "
            "would be right",
            table.psf.size(), size, size, spacing_um, bytes / (1 << 30), most_memory / (1 << 30),
            most_samples, std::floor(fit), 1.01 * width_um / std::floor(fit)));
  }
  // A grid of the same samples stays as it is, where nothing is asked.
  if (command.spacing_um || command.size) grid = {static_cast<int>(size), spacing_um};
  return grid;
}

/// The least share of its light that a PSF keeps on the new grid. \throws InputError if it is less than is
/// wanted.
void check_light(const ExportCommand& command, const LensDataTable& before, const LensDataTable& after) {
  constexpr double usual_least = 0.99;
  double kept = 1;
  for (std::size_t i = 0; i < before.psf.size(); ++i)
    kept = std::min(kept, after.psf[i].captured / before.psf[i].captured);
  if (kept >= command.least_light.value_or(usual_least)) return;
  const Psf& psf = after.psf.front();
  throw InputError(
      command.path,
      fmt::format(
          "PSFs of {0} x {0} samples of {1:g} um keep {2:.3g} % of the light; --psf-size {3} keeps 99 %, "
          "and --psf-light {4:.2g} allows it",
          psf.size, psf.spacing_um, 100 * kept, size_for_light(before, psf.spacing_um, usual_least),
          0.9 * kept));
}

/// The table with its PSFs on one grid, if it is allowed to bring them there.
LensDataTable prepared(const ExportCommand& command, const Shared& shared) {
  LensDataTable table = read_table(command.path);
  require_by_height(table, "ISET's files hold centred lenses");
  const bool resample = command.resample || command.spacing_um || command.size;
  if (!resample || (has_one_grid(table) && !command.spacing_um && !command.size)) return table;
  const PsfGridSize grid = asked_grid(command, table);
  LensDataTable gridded = on_common_grid(table, grid);
  check_light(command, table, gridded);
  table = std::move(gridded);
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
  command->add_option("-o,--output", options->output, "The MAT file, or the folder")
      ->check(output_file_or_folder())
      ->required();
  command->add_flag("--resample", options->resample,
                    "Bring PSFs of several grids to one, which ISET needs; light and its centre stay");
  command
      ->add_option("--psf-spacing", options->spacing_um,
                   "Spacing of that grid [um], implies --resample; default: the finest of the table")
      ->check(positive_number());
  command
      ->add_option("--psf-size", options->size,
                   "Samples a side of that grid, implies --resample; default: the widest PSF's")
      ->check(CLI::Range(2, most_samples));
  command
      ->add_option("--psf-light", options->least_light,
                   "Least share of its light that every PSF must keep on that grid; default: 0.99")
      ->check(CLI::Range(0.0, 1.0));
}

}  // namespace petzval::app
