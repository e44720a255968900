// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/report/table.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace petzval {

namespace {

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string csv_field(const TableCell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return csv_field(std::string_view(*text));
  const double value = std::get<double>(cell);
  return std::isfinite(value) ? fmt::format("{}", value) : std::string();
}

}  // namespace

void Table::validate() const {
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].size() != columns.size())
      throw InputError(fmt::format("row {} of a table has {} cells; it has {} columns", i + 1, rows[i].size(),
                                   columns.size()));
}

std::string cell_text(const TableCell& cell, int decimals) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  const double value = std::get<double>(cell);
  if (!std::isfinite(value)) return "–";
  std::string text = fmt::format("{:.{}f}", value, std::clamp(decimals, 0, 17));
  if (text[0] != '-') return text;
  text.erase(0, 1);
  const bool zero = text.find_first_not_of("0.") == std::string::npos;
  return zero ? text : "\xE2\x88\x92" + text;
}

std::string to_csv(const Table& table) {
  table.validate();
  std::string out;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const TableColumn& column = table.columns[i];
    const std::string header =
        column.unit.empty() ? column.name : fmt::format("{} [{}]", column.name, column.unit);
    if (i > 0) out += ',';
    out += csv_field(std::string_view(header));
  }
  out += '\n';
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) out += ',';
      out += csv_field(row[i]);
    }
    out += '\n';
  }
  return out;
}

}  // namespace petzval
