// SPDX-License-Identifier: BSD-3-Clause
// petzval optics import: lens data tables that other programs and laboratories made.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/optics/table_file.h>
#include <petzval/optics/table_import.h>

#include <algorithm>
#include <map>
#include <memory>

#include "optics_commands.h"
#include "output_option.h"

namespace petzval::app {

namespace {

struct ImportCommand {
  std::string path, from = "auto", output, away, centre;
  std::string relative_illumination = "sensor";
  TableImport how;
};

std::pair<int, int> parse_centre(const std::string& text) {
  const std::size_t comma = std::min(text.find(','), text.size());
  const int row = parse_integer(text.substr(0, comma)).value_or(0);
  const int column = parse_integer(text.substr(std::min(comma + 1, text.size()))).value_or(0);
  if (row < 1 || column < 1)
    throw InputError(fmt::format("--psf-centre {}: ROW,COLUMN, counted from 1, would be right", text));
  return {row, column};
}

PsfLie lie_of(const ImportCommand& command) {
  PsfLie lie;
  if (!command.away.empty()) try {
      lie.away = parse_away(command.away);
    } catch (const InputError& error) {
      throw InputError(fmt::format("--psf-away: {}", error.what()));
    }
  if (!command.centre.empty()) lie.centre = parse_centre(command.centre);
  return lie;
}

void import(ImportCommand command, const Shared& shared) {
  require_extension(command.output, table_extensions(), "a lens data table");
  static const std::map<std::string, TableSource> sources{
      {"auto", TableSource::automatic}, {"iset", TableSource::iset},         {"zemax", TableSource::zemax},
      {"codev", TableSource::codev},    {"measured", TableSource::measured}, {"map", TableSource::map},
      {"hdf5", TableSource::hdf5}};
  command.how.source = sources.at(command.from);
  command.how.lie = lie_of(command);
  if (command.relative_illumination == "source")
    command.how.reading.illumination = RayTraceReading::Illumination::source;
  const ImportedTable imported = import_table(command.path, command.how);
  for (const std::string& text : imported.notes) note(shared, fmt::format("{}: {}", command.path, text));
  write_table(imported.table, command.output);
}

void add_ray_trace_options(CLI::App& command, ImportCommand& options) {
  command.add_option(
      "--psf-away", options.away,
      "Direction in the PSFs that is away from the axis: up, down, left or right; default: what "
      "the file says or its program does");
  command.add_option("--psf-centre", options.centre,
                     "Sample of the chief ray, ROW,COLUMN counted from 1; default likewise");
  command
      .add_option("--g-axis", options.how.reading.g_axis_sr,
                  "Irradiance of a uniform wall per radiance on the axis [sr]; default: by the f-number")
      ->check(positive_number());
  command
      .add_option("--relative-illumination", options.relative_illumination,
                  "What it is of: a uniform wall (sensor), or an object point before the blur (source)")
      ->check(CLI::IsMember({"sensor", "source"}))
      ->capture_default_str();
  command
      .add_option("--vertex-to-sensor", options.how.reading.vertex_to_sensor_mm,
                  "Length of the lens, from its first vertex to the sensor [mm]")
      ->check(positive_number());
}

void add_measured_options(CLI::App& command, ImportCommand& options) {
  command.add_option("--curves", options.how.curves,
                     "Of measurements: CSV of field_mm, paraxial_height_mm, relative_illumination");
  command.add_flag("--clip-negative", options.how.measured.clip_negative,
                   "Of measured PSFs: take values below zero for noise about none");
}

}  // namespace

void add_optics_import(CLI::App& optics, Shared& shared) {
  auto options = std::make_shared<ImportCommand>();
  CLI::App* command = add_command(
      optics, shared, "import", "Take a lens data table that another program made",
      "petzval optics import rtLens.mat -o lens.h5", false, [options, &shared] { import(*options, shared); });
  command->add_option("table", options->path, "The file, or the folder of ISETPARMS.TXT")->required();
  command
      ->add_option(
          "--from", options->from,
          "iset: a MAT file with ISET's rayTrace structure; zemax, codev: ISETPARMS.TXT and the files "
          "beside it; measured: a CSV file of PSFs or MTFs; map: an .npz file of PSFs over the frame; hdf5: "
          "Petzval's own layout without its checksum "
          "(HDF5 may not survive a "
          "damaged file). auto goes by the name")
      ->check(CLI::IsMember({"auto", "iset", "zemax", "codev", "measured", "map", "hdf5"}))
      ->capture_default_str();
  command->add_option("-o,--output", options->output, "The table, an HDF5 file with checksum")
      ->check(output_file())
      ->required();
  add_ray_trace_options(*command, *options);
  add_measured_options(*command, *options);
}

}  // namespace petzval::app
