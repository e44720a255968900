// SPDX-License-Identifier: BSD-3-Clause
// What a sweep found, as rows and as a table.
#pragma once

#include <petzval/report/table.h>

#include "sweep_result.h"

namespace petzval::app {

/// Flat rows: one a point, or as many as the command has rows at each. Numbers that were varied are numbers.
nlohmann::ordered_json rows_of(const std::vector<PointResult>& results);

/// All keys of the rows, in the order in which they first come.
Table table_of(const nlohmann::ordered_json& rows);

}  // namespace petzval::app
