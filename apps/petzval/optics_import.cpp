// SPDX-License-Identifier: BSD-3-Clause
// petzval optics import: lens data tables that other programs and laboratories made.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>
#include <petzval/base/number_text.h>
#include <petzval/base/units.h>
#include <petzval/base/whole_file.h>
#include <petzval/optics/formats/iset_mat_table.h>
#include <petzval/optics/formats/measured.h>
#include <petzval/optics/formats/zemax_table.h>
#include <petzval/optics/table_file.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "optics_commands.h"
#include "output_option.h"

namespace petzval::app {

namespace {

struct ImportCommand {
  std::string path, from = "auto", output, away, centre, curves;
  std::string relative_illumination = "sensor";
  RayTraceReading reading;
  MeasuredOptions measured;
};

/// The kind of a file that --from auto finds.
std::string kind_of(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return "zemax";
  const std::string extension = extension_of(path);
  if (extension == ".mat") return "iset";
  if (extension == ".txt") return "zemax";
  if (extension == ".csv") return "measured";
  return "hdf5";
}

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

/// Complaints of the conversion do not know the file.
template <typename File>
ImportedTable converted(const File& file, const ImportCommand& command) {
  try {
    ImportedTable imported = table_of(file.data, command.reading);
    imported.notes.insert(imported.notes.begin(), file.notes.begin(), file.notes.end());
    return imported;
  } catch (const InputError& error) {
    throw InputError(command.path, error.what());
  }
}

MeasuredFile read_measurement(const ImportCommand& command) {
  constexpr std::size_t most_bytes = std::size_t{1} << 30;
  const std::string text = read_whole_file(command.path, most_bytes);
  const std::string curves = command.curves.empty() ? "" : read_whole_file(command.curves, most_bytes);
  if (!command.curves.empty() && curves.empty())
    throw InputError(
        command.curves,
        "is empty; columns field_mm and paraxial_height_mm or relative_illumination would be right");
  return read_measured(text, command.path, curves, command.curves, command.measured);
}

/// Refuses options that say nothing of this kind of file, and numbers that no lens has.
void check(const ImportCommand& command, const std::string& kind) {
  const auto refuse = [&](bool given, const char* options, const char* of) {
    if (given)
      throw InputError(command.path, fmt::format("{} have no meaning for it; they are for {}", options, of));
  };
  refuse(kind != "measured" && (!command.curves.empty() || command.measured.clip_negative),
         "--curves and --clip-negative", "measurements (.csv)");
  refuse((kind == "measured" || kind == "hdf5") && (!command.away.empty() || !command.centre.empty()),
         "--psf-away and --psf-centre", "PSFs of ISET, Zemax and CODE V");
  refuse(kind == "hdf5" && command.reading.says_something(),
         "--g-axis, --relative-illumination and --vertex-to-sensor", "files that do not say it themselves");
  if (command.reading.g_axis_sr.value_or(0) > pi)
    throw InputError(fmt::format(
        "--g-axis {:g}: up to π = {:.4f} sr would be right; a whole hemisphere of light gives no more",
        *command.reading.g_axis_sr, pi));
}

ImportedTable read(const ImportCommand& command) {
  const std::string kind = command.from == "auto" ? kind_of(command.path) : command.from;
  check(command, kind);
  if (kind == "hdf5") return {read_table(command.path, TableOrigin::elsewhere), {}};
  if (kind == "iset") return converted(read_iset_mat_table(command.path, lie_of(command)), command);
  if (kind == "measured") return converted(read_measurement(command), command);
  const ListingProgram program = kind == "codev" ? ListingProgram::codev : ListingProgram::zemax;
  return converted(read_zemax_table(command.path, program, lie_of(command)), command);
}

void import(ImportCommand command, const Shared& shared) {
  require_extension(command.output, table_extensions(), "a lens data table");
  if (command.relative_illumination == "source")
    command.reading.illumination = RayTraceReading::Illumination::source;
  const ImportedTable imported = read(command);
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
      .add_option("--g-axis", options.reading.g_axis_sr,
                  "Irradiance of a uniform wall per radiance on the axis [sr]; default: by the f-number")
      ->check(positive_number());
  command
      .add_option("--relative-illumination", options.relative_illumination,
                  "What it is of: a uniform wall (sensor), or an object point before the blur (source)")
      ->check(CLI::IsMember({"sensor", "source"}))
      ->capture_default_str();
  command
      .add_option("--vertex-to-sensor", options.reading.vertex_to_sensor_mm,
                  "Length of the lens, from its first vertex to the sensor [mm]")
      ->check(positive_number());
}

void add_measured_options(CLI::App& command, ImportCommand& options) {
  command.add_option("--curves", options.curves,
                     "Of measurements: CSV of field_mm, paraxial_height_mm, relative_illumination");
  command.add_flag("--clip-negative", options.measured.clip_negative,
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
          "beside it; measured: a CSV file of PSFs or MTFs; hdf5: Petzval's own layout without its checksum "
          "(HDF5 may not survive a "
          "damaged file). auto goes by the name")
      ->check(CLI::IsMember({"auto", "iset", "zemax", "codev", "measured", "hdf5"}))
      ->capture_default_str();
  command->add_option("-o,--output", options->output, "The table, an HDF5 file with checksum")
      ->check(output_file())
      ->required();
  add_ray_trace_options(*command, *options);
  add_measured_options(*command, *options);
}

}  // namespace petzval::app
