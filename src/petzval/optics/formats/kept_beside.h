// SPDX-License-Identifier: BSD-3-Clause
// What a lens data table holds and the files of other programs have no place for, as one line of JSON.
#pragma once

#include <petzval/optics/lens_data_table.h>

#include <string>

namespace petzval {

/// Everything but the values of the PSFs and what the file holds for itself: names, prescription, distances,
/// first-order data, fields, g_source, g_sensor, and size, spacing and captured light of the PSFs. ASCII.
std::string kept_beside(const LensDataTable& table);

/// A table with PSFs that have no values. \throws InputError for text that is none of kept_beside().
LensDataTable table_of_kept(const std::string& text);

}  // namespace petzval
