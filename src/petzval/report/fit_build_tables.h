// SPDX-License-Identifier: BSD-3-Clause
// How a lens was built, in tables and drawings.
#pragma once

#include <petzval/optimise/fit_build.h>
#include <petzval/report/table.h>

#include <string>

namespace petzval {

/// Every number with its deviation, in its unit.
Table fitted_numbers(const FitBuildResult& result);
/// The same for people: angles in arc minutes.
Table fitted_numbers_to_read(const FitBuildResult& result);
/// Every edge: place, direction, MTF50 as measured, of the lens as given, and of the lens as fitted.
Table fitted_edges(const FitBuildResult& result);
/// MTF50 of every edge as measured, as fitted, and the difference in per cent, as coloured dots in the frame;
/// below, the fitted against the measured. \param columns, rows  of the photographs [pixels].
std::string fit_build_map_svg(const FitBuildResult& result, int columns, int rows);

}  // namespace petzval
