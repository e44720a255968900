// SPDX-License-Identifier: BSD-3-Clause
// What petzval sfr says about the edges that it has measured.
#pragma once

#include <petzval/measure/sfr/measure_picture.h>

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command.h"

namespace petzval::app {

/// One picture.
struct SfrReport {
  std::string image, light;  ///< the file; how its numbers became light, empty where they are light
  int columns = 0, rows = 0;
  std::optional<double> pitch_um;
  std::vector<MeasuredEdge> edges;
  std::optional<std::array<double, 2>> chart_mm = {};  ///< of the chart that it shows
};

/// What is asked of a tilted chart.
struct FocusQuestion {
  char along = 'x';
  std::optional<double> tilt_deg;
};

/// What a command line has named.
struct SfrReports {
  bool single = true;  ///< one file by its own name: tables have no column for it
  std::vector<SfrReport> pictures;
  std::vector<std::pair<std::string, std::string>> failed;  ///< files, and why they could not be measured
  std::optional<FocusQuestion> focus;
};

void print_sfr(const SfrReports& reports, const Shared& shared);
/// (file), edge, channel, frequency_cpp, frequency_lpmm (with a pitch), frequency_lwph, sfr, deviation.
void write_sfr_csv(const std::string& path, const SfrReports& reports);
/// (file), edge, channel, distance_px, esf, lsf.
void write_profile_csv(const std::string& path, const SfrReports& reports);
/// A curve from elsewhere.
struct NamedCurve {
  std::string name;
  std::vector<double> frequencies_cpp, sfr;
};

/// Columns frequency_cpp and sfr of a .csv, whatever others it has, as long as the frequency rises: of
/// several edges the first. Named as the file. \throws InputError with file and line.
NamedCurve read_sfr_table(const std::string& path);

/// The measured edges, and beside them, broken, what others say.
std::string sfr_plot_svg(const SfrReports& reports, const std::vector<NamedCurve>& others);
std::string profile_plot_svg(const SfrReports& reports);

}  // namespace petzval::app
