// SPDX-License-Identifier: BSD-3-Clause
// What petzval sfr says about the edges that it has measured.
#pragma once

#include <petzval/measure/sfr/find_edges.h>
#include <petzval/measure/sfr/iso_esfr.h>
#include <petzval/measure/sfr/measure_edge.h>

#include <optional>
#include <string>
#include <vector>

#include "command.h"

namespace petzval::app {

struct MeasuredEdge {
  std::string channel;
  PixelBox roi;
  EdgeMeasurement exact;
  std::optional<IsoEsfr> iso;               ///< with --method iso
  std::optional<double> lateral_offset_px;  ///< from green, along the normal, with all channels

  const std::vector<double>& frequencies() const {
    return iso ? iso->frequencies_cpp : exact.frequencies_cpp;
  }
  const std::vector<double>& sfr() const { return iso ? iso->sfr : exact.sfr; }
  double mtf50() const { return iso ? iso->mtf50_cpp : exact.mtf50().frequency_cpp; }
  double angle_deg() const { return iso ? iso->angle_deg : exact.line.angle_deg(); }
};

struct SfrReport {
  std::string image;
  int columns = 0, rows = 0;
  std::optional<double> pitch_um;
  std::vector<MeasuredEdge> edges;
};

void print_sfr(const SfrReport& report, const Shared& shared);
/// edge, channel, frequency_cpp, frequency_lpmm (with a pitch), frequency_lwph, sfr, deviation.
void write_sfr_csv(const std::string& path, const SfrReport& report);
/// edge, channel, distance_px, esf, lsf.
void write_profile_csv(const std::string& path, const SfrReport& report);
/// A curve from elsewhere.
struct NamedCurve {
  std::string name;
  std::vector<double> frequencies_cpp, sfr;
};

/// Columns frequency_cpp and sfr of a .csv, whatever others it has, as long as the frequency rises: of
/// several edges the first. Named as the file. \throws InputError with file and line.
NamedCurve read_sfr_table(const std::string& path);

/// The measured edges, and beside them, broken, what others say.
void write_sfr_plot(const std::string& path, const SfrReport& report, const std::vector<NamedCurve>& others);
void write_profile_plot(const std::string& path, const SfrReport& report);
/// The picture with its edges and their MTF50.
void write_annotated(const std::string& path, const SfrReport& report, const Plane& plane);

}  // namespace petzval::app
