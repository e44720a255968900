// SPDX-License-Identifier: BSD-3-Clause
// petzval optics build: the lens data table of a lens.
#include <fmt/format.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/base/error.h>
#include <petzval/optics/table_file.h>
#include <petzval/scene/wavelength_list.h>
#include <petzval/sensor/sensor.h>
#include <petzval/simulate/camera_table.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "camera_option.h"
#include "optics_commands.h"
#include "output_option.h"

namespace petzval::app {

namespace {

struct BuildCommand {
  CameraChoice camera;
  CameraTableOptions table;
  std::string output, wavelengths, sensor;
  bool over_frame = false;
};

void note_dark_places(const LensDataTable& table, const Shared& shared) {
  const auto dark = std::count(table.g_source_sr.begin(), table.g_source_sr.end(), 0.0);
  if (dark > 0)
    note(shared, fmt::format("{}: no ray reaches {} of {} places", table.lens_name, dark, table.psf.size()));
}

/// A table that ends before the height asked for is useful, but the user should know.
void note_short_table(const LensDataTable& table, double wanted_mm, const Shared& shared) {
  if (table.frame) return note_dark_places(table, shared);
  const std::size_t last = table.fields.size() - 1;
  double reached_mm = INFINITY;
  for (std::size_t w = 0; w < table.wavelengths_nm.size(); ++w)
    reached_mm = std::min(reached_mm, table.real_image_height_mm[table.index(last, w)]);
  if (reached_mm < wanted_mm)
    note(
        shared,
        fmt::format("{}: no ray passes beyond an image height of {:.4g} mm, short of the {:.4g} mm asked for",
                    table.lens_name, reached_mm, wanted_mm));
}

/// Windows that lose light are said: they were widened as far as they go.
void note_cut_psfs(const LensDataTable& table, const Shared& shared) {
  std::size_t cut = 0;
  double least = 1;
  for (const Psf& psf : table.psf) {
    if (psf.captured < PsfOptions{}.wanted_share) ++cut;
    least = std::min(least, psf.captured);
  }
  if (cut > 0)
    note(shared,
         fmt::format("{}: {} of {} PSFs hold less than {:g} % of their light, the least {:.3g} %",
                     table.lens_name, cut, table.psf.size(), 100 * PsfOptions{}.wanted_share, 100 * least));
}

void build(const BuildCommand& command, const Shared& shared) {
  require_extension(command.output, table_extensions(), "a lens data table");
  CameraTableOptions options = command.table;
  if (!command.wavelengths.empty()) options.wavelengths_nm = parse_wavelengths_nm(command.wavelengths);
  if (command.over_frame) options.places = TableOptions::Places::over_frame;
  Camera camera = command.camera.camera(shared);
  if (!command.sensor.empty()) camera.sensor = read_sensor(command.sensor);
  const LensDataTable table = camera_table(camera, options, context_of(shared));
  const double corner_mm = camera.sensor ? camera.sensor->geometry.half_diagonal_mm() : 0;
  note_short_table(table, options.image_height_mm.value_or(corner_mm), shared);
  note_cut_psfs(table, shared);
  write_table(table, command.output);
}

}  // namespace

void add_optics_build(CLI::App& optics, Shared& shared) {
  auto options = std::make_shared<BuildCommand>();
  CLI::App* command =
      add_command(optics, shared, "build", "Compute the lens data table of a lens",
                  "petzval optics build edmund-54852 --sensor 768x576@6.25 --wavelengths 400:50:700 "
                  "-o edmund.h5",
                  false, [options, &shared] { build(*options, shared); });
  options->camera.add_lens(*command, true, true);
  command->add_option("-o,--output", options->output, "The table, an HDF5 file")
      ->check(output_file())
      ->required();
  command->add_option("--wavelengths", options->wavelengths,
                      "In nm: 400:10:700, or a list 450,550,650; default: the lens's own");
  CLI::Option* sensor =
      command->add_option("--sensor", options->sensor,
                          "Reach the corner of this sensor: 768x576@6.25 (pitch in um), file or name");
  command->add_option("--image-height", options->table.image_height_mm, "Reach this real image height [mm]")
      ->excludes(sensor);
  CLI::Option* fields = command->add_option(
      "--fields", options->table.field_count,
      "Evenly spaced fields, the axis included; default: 31, and with --sensor those between them that "
      "pictures need");
  command
      ->add_option("--tolerance", options->table.tolerance,
                   "With --sensor: error of pictures that fields are close enough for")
      ->needs(sensor)
      ->excludes(fields)
      ->capture_default_str();
  command
      ->add_option("--places", options->table.frame_places,
                   "Places along the longer side, of a table over the frame: for lenses with poses or blades")
      ->capture_default_str();
  command->add_flag("--over-frame", options->over_frame, "Places over the frame for a centred lens too");
  options->camera.add_stop_and_focus(*command, Focus::design());
  options->camera.add_positions(*command);
  options->camera.add_apertures(*command);
  options->camera.losses.add_to(*command);
}

}  // namespace petzval::app
