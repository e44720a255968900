// SPDX-License-Identifier: BSD-3-Clause
// Pieces that the sections of a lens report share; used by lens_report.cpp, lens_light_spread.cpp and
// lens_on_sensor.cpp.
#pragma once

#include <petzval/report/html.h>
#include <petzval/report/lens_report.h>
#include <petzval/report/svg_plot.h>
#include <petzval/report/table.h>

#include <string>

namespace petzval {

/// A drawing with its caption and the data behind it.
html::Block figure_with_data(const std::string& svg, const std::string& caption, const std::string& file_name,
                             const Table& data);

/// Adds "Point spread and encircled energy": PSFs of the fields on one scale, and what circles hold.
void add_light_spread_section(html::Page& page, const ReportLens& lens, const std::string& title_end);

/// Adds "On the sensor": lens MTF × pixel MTF at the pixels' limit, and the chief-ray angle against the
/// microlenses.
void add_sensor_section(html::Page& page, const ReportLens& lens, const ReportSensor& sensor,
                        const std::string& title_end);

}  // namespace petzval
