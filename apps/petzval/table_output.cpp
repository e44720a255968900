// SPDX-License-Identifier: BSD-3-Clause
#include "table_output.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace petzval::app {

void print_table(const Table& table) {
  fmt::print("{}", to_text(table));
}

nlohmann::ordered_json rows_json(const Table& table) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const auto& row : table.rows) {
    nlohmann::ordered_json object;
    for (std::size_t c = 0; c < row.size(); ++c) {
      nlohmann::ordered_json& value = object[table.columns[c].key];
      if (const auto* text = std::get_if<std::string>(&row[c]))
        value = *text;
      else if (const auto* yes = std::get_if<bool>(&row[c]))
        value = *yes;
      else if (std::isfinite(std::get<double>(row[c])))
        value = std::get<double>(row[c]);
      else
        value = nullptr;
    }
    rows.push_back(std::move(object));
  }
  return rows;
}

}  // namespace petzval::app
