// SPDX-License-Identifier: BSD-3-Clause
// The subcommands of petzval measure.
#pragma once

#include <petzval/report/svg_plot.h>
#include <petzval/report/table.h>

#include <string>
#include <vector>

#include "command.h"

namespace petzval::app {

/// --csv and --plot.
struct MeasureOutputs {
  std::string csv, plot;

  void add_to(CLI::App& command, bool with_plot = true);
  /// \throws InputError for extensions that are not .csv and .svg.
  void check() const;
  /// Both files or none.
  void write(const Table& table, const Plot& plot_to_write) const;
};

/// By its name; without one green, or the first. \throws InputError for a name that there is not.
int channel_index(const std::vector<std::string>& names, const std::string& wanted);

void add_measure_sensor(CLI::App& measure, Shared& shared);
void add_measure_noise(CLI::App& measure, Shared& shared);
void add_measure_oecf(CLI::App& measure, Shared& shared);
void add_measure_matrix(CLI::App& measure, Shared& shared);
void add_measure_shading(CLI::App& measure, Shared& shared);
void add_measure_colour(CLI::App& measure, Shared& shared);
void add_measure_scielab(CLI::App& measure, Shared& shared);

}  // namespace petzval::app
