// SPDX-License-Identifier: BSD-3-Clause
// One page about a lens, or about several and how they compare: all analyses, their numbers and the data
// behind each plot.
#pragma once

#include <petzval/analysis/field_tables.h>
#include <petzval/lens/lens.h>
#include <petzval/report/table.h>
#include <petzval/wave/photosite.h>

#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// What a report says about the lens on a sensor.
struct ReportSensor {
  std::string name;
  double pitch_um = 0, half_diagonal_mm = 0;
  Photosite photosite;  ///< and optical low-pass
  /// The chief-ray angle that the microlenses are made for, against image height; empty: not known.
  std::vector<double> microlens_heights_mm, microlens_angles_deg;
};

struct ReportLens {
  Lens lens;
  FieldTableRequest request;
};

/// A section that the caller computed.
struct ReportChapter {
  std::string title, text;
  Table table;
};

struct LensReportOptions {
  std::vector<double> frequencies_cpmm{10, 20, 40};  ///< of MTF tables and of curves over field and focus
  double highest_frequency_cpmm = 100;               ///< of MTF curves
  std::optional<ReportSensor> sensor;
  std::vector<ReportChapter> chapters = {};  ///< before the sections about each lens
  std::string footer;
};

/// A page that needs nothing from outside: opens without a network, prints on paper, and holds the data of
/// each plot as CSV. Several lenses are compared in a table first. \throws InputError without a lens, or as
/// the analyses, naming the field at which no ray passes.
std::string lens_report_html(const std::vector<ReportLens>& lenses, const LensReportOptions& options);

}  // namespace petzval
