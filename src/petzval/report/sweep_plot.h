// SPDX-License-Identifier: BSD-3-Clause
// Plots of a sweep: what was measured over what was varied.
#pragma once

#include <petzval/report/svg_plot.h>
#include <petzval/report/table.h>

#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// A parameter of a sweep as an axis.
struct SweptAxis {
  std::vector<double> values;
  std::string unit;  ///< "m" of "1m", "1.5m"; may be empty
};

/// The axis of values as they were written; nothing unless all are numbers in one unit and two of them
/// differ.
std::optional<SweptAxis> swept_axis(const std::vector<std::string>& values);

/// The columns with such a key that can be drawn: numbers that the command measured. What it measured at
/// (fields, wavelengths, frequencies) tells curves apart.
std::vector<std::string> measured_columns(const Table& rows, const std::vector<std::string>& varied);

/// A plot for each quantity: over the first varied parameter that is an axis, one curve for each combination
/// of the others and of fields, wavelengths, frequencies and the like. Tangential and sagittal values share a
/// plot, the latter dashed. \param rows    a row a point, or several; columns are known by their keys. Values
/// in the columns that were
///                varied are numbers, or text as it was written.
/// \param varied  keys of the parameters, in their order
/// \param of      keys of the quantities; empty: what such a table is looked at for
/// Of more than 24 curves, some wavelengths, frequencies and fields are left out.
/// \param left_out  if not null, gains a line for each column of which only some values are drawn
/// \throws InputError if no parameter is an axis, for a key that is no measured column, and for more than 60
/// curves all the same, saying what would be right.
std::vector<Plot> sweep_plots(const Table& rows, const std::vector<std::string>& varied,
                              const std::vector<std::string>& of = {},
                              std::vector<std::string>* left_out = nullptr);

}  // namespace petzval
