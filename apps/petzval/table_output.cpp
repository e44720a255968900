// SPDX-License-Identifier: BSD-3-Clause
#include "table_output.h"

#include <fmt/format.h>
#include <petzval/report/xml.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace petzval::app {

namespace {

std::string heading(const TableColumn& column) {
  return column.unit.empty() ? column.name : fmt::format("{} [{}]", column.name, column.unit);
}

/// As cell_text, with a plain minus sign that other programs can read.
std::string plain_text(const TableCell& cell, int decimals) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  const double value = std::get<double>(cell);
  if (!std::isfinite(value)) return "-";
  const std::string text = fmt::format("{:.{}f}", value, decimals);
  return text.find_first_not_of("-0.") == std::string::npos && text[0] == '-' ? text.substr(1) : text;
}

}  // namespace

void print_table(const Table& table) {
  std::vector<std::vector<std::string>> lines(1);
  for (const TableColumn& column : table.columns) lines[0].push_back(heading(column));
  for (const auto& row : table.rows) {
    lines.emplace_back();
    for (std::size_t c = 0; c < row.size(); ++c)
      lines.back().push_back(plain_text(row[c], table.columns[c].decimals));
  }
  std::vector<std::size_t> widths(table.columns.size(), 0);
  for (const auto& line : lines)
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], character_count(line[c]));
  for (const auto& line : lines) {
    std::string text;
    for (std::size_t c = 0; c < line.size(); ++c)
      text += std::string(2 + widths[c] - character_count(line[c]), ' ') + line[c];
    fmt::print("{}\n", text);
  }
}

nlohmann::ordered_json rows_json(const Table& table) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const auto& row : table.rows) {
    nlohmann::ordered_json object;
    for (std::size_t c = 0; c < row.size(); ++c) {
      nlohmann::ordered_json& value = object[table.columns[c].key];
      if (const auto* text = std::get_if<std::string>(&row[c]))
        value = *text;
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
