// SPDX-License-Identifier: BSD-3-Clause
// Tables on stdout, for people and as JSON.
#pragma once

#include <petzval/report/table.h>

#include <nlohmann/json.hpp>

namespace petzval::app {

/// Headings with units, then the rows, numbers to the right.
void print_table(const Table& table);

/// The rows as flat objects by the keys of the columns; gaps are null.
nlohmann::ordered_json rows_json(const Table& table);

}  // namespace petzval::app
