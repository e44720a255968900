// SPDX-License-Identifier: BSD-3-Clause
#include "sweep_tables.h"

#include <fmt/format.h>
#include <petzval/base/number_text.h>

#include <algorithm>

namespace petzval::app {

using Json = nlohmann::ordered_json;

namespace {

Json value_of(const std::string& text) {
  if (const auto whole = parse_integer(text)) return *whole;
  if (const auto number = parse_number(text)) return *number;
  return text;
}

/// Puts the plain values of an object into a row, those of objects within it by "outer.inner", those of the
/// sensor's channels by "levels.green.inner".
void flatten(const Json& object, const std::string& prefix, Json& row) {
  for (const auto& [key, value] : object.items()) {
    if (value.is_object()) flatten(value, prefix + key + ".", row);
    if (value.is_array())
      for (const Json& entry : value)
        if (entry.is_object() && entry.contains("channel") && entry["channel"].is_string())
          flatten(entry, fmt::format("{}{}.{}.", prefix, key, entry["channel"].get<std::string>()), row);
    if (value.is_number() || value.is_string() || value.is_boolean() || value.is_null())
      if (!row.contains(prefix + key)) row[prefix + key] = value;
  }
}

}  // namespace

Json rows_of(const std::vector<PointResult>& results) {
  Json rows = Json::array();
  for (const PointResult& result : results) {
    Json start = Json::object();
    for (const auto& [key, value] : result.point) start[key] = value_of(value);
    start["status"] = result.done ? "ok" : "failed";
    if (!result.done) start["error"] = result.error;
    const auto inner = result.numbers.find("rows");
    if (inner == result.numbers.end() || !inner->is_array()) {
      flatten(result.numbers, "", start);
      rows.push_back(start);
      continue;
    }
    for (const Json& values : *inner) {
      Json row = start;
      flatten(values, "", row);
      rows.push_back(row);
    }
  }
  return rows;
}

Table table_of(const Json& rows) {
  Table table;
  for (const Json& row : rows)
    for (const auto& [key, value] : row.items())
      if (std::none_of(table.columns.begin(), table.columns.end(),
                       [&key = key](const TableColumn& column) { return column.key == key; }))
        table.columns.push_back({key, "", 5, key});
  for (const Json& row : rows) {
    std::vector<TableCell> cells;
    for (const TableColumn& column : table.columns) {
      const auto found = row.find(column.key);
      if (found == row.end() || found->is_null())
        cells.emplace_back(std::string());
      else if (found->is_number())
        cells.emplace_back(found->get<double>());
      else
        cells.emplace_back(found->is_string() ? found->get<std::string>() : found->dump());
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace petzval::app
