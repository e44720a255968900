// SPDX-License-Identifier: BSD-3-Clause
// petzval measure sensor | noise | oecf | matrix | shading | colour | scielab
#include "measure_command.h"
#include "output_option.h"
#include "plot_output.h"

#include <petzval/base/staged_files.h>
#include <petzval/base/whole_file.h>

namespace petzval::app {

void MeasureOutputs::add_to(CLI::App& command, bool with_plot) {
  command.add_option("--csv", csv, "Write the table as .csv")->check(output_file());
  if (with_plot) command.add_option("--plot", plot, "Draw it as .svg, .png or .pdf")->check(output_file());
}

void MeasureOutputs::check() const {
  if (!csv.empty()) require_extension(csv, {".csv"}, "the table");
  if (!plot.empty()) require_drawing(plot, "the plot");
}

void MeasureOutputs::write(const Table& table, const Plot& plot_to_write) const {
  StagedFiles files;
  if (!csv.empty()) write_whole_file(files.stage(csv), to_csv(table));
  if (!plot.empty()) write_drawing(files.stage(plot), plot_to_write.svg(), plot);
  files.commit();
}

void add_measure_command(CLI::App& app, Shared& shared) {
  CLI::App* measure =
      app.add_subcommand("measure", "Measure noise, speed, shading and colours of sensors and pictures");
  measure->require_subcommand(1);
  add_measure_sensor(*measure, shared);
  add_measure_noise(*measure, shared);
  add_measure_oecf(*measure, shared);
  add_measure_matrix(*measure, shared);
  add_measure_shading(*measure, shared);
  add_measure_colour(*measure, shared);
  add_measure_scielab(*measure, shared);
}

}  // namespace petzval::app
