// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/report/table.h>
#include <petzval/report/xml.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

namespace petzval {

namespace {

/// A cell that is no number.
std::optional<std::string> in_words(const TableCell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* yes = std::get_if<bool>(&cell)) return *yes ? "yes" : "no";
  return std::nullopt;
}

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string csv_field(const TableCell& cell) {
  if (const std::optional<std::string> words = in_words(cell)) return csv_field(std::string_view(*words));
  const double value = std::get<double>(cell);
  return std::isfinite(value) ? fmt::format("{}", value) : std::string();
}

std::string heading(const TableColumn& column) {
  return column.unit.empty() ? column.name : fmt::format("{} [{}]", column.name, column.unit);
}

std::string plain_text(const TableCell& cell, const TableColumn& column) {
  if (std::optional<std::string> words = in_words(cell)) return *std::move(words);
  const double value = std::get<double>(cell);
  if (!std::isfinite(value)) return column.text.gap;
  const std::string text = column.text.format.empty()
                               ? fmt::format("{:.{}f}", value, column.decimals)
                               : fmt::format(fmt::runtime("{:" + column.text.format + "}"), value);
  return text.find_first_not_of("-0.") == std::string::npos && text[0] == '-' ? text.substr(1) : text;
}

}  // namespace

void Table::validate() const {
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].size() != columns.size())
      throw InputError(fmt::format("row {} of a table has {} cells; it has {} columns", i + 1, rows[i].size(),
                                   columns.size()));
}

std::string cell_text(const TableCell& cell, int decimals) {
  if (std::optional<std::string> words = in_words(cell)) return *std::move(words);
  const double value = std::get<double>(cell);
  if (!std::isfinite(value)) return "–";
  std::string text = fmt::format("{:.{}f}", value, std::clamp(decimals, 0, 17));
  if (text[0] != '-') return text;
  text.erase(0, 1);
  const bool zero = text.find_first_not_of("0.") == std::string::npos;
  return zero ? text : "\xE2\x88\x92" + text;
}

std::string to_text(const Table& table) {
  table.validate();
  const std::size_t count = table.columns.size();
  std::vector<std::vector<std::string>> lines(1 + table.rows.size(), std::vector<std::string>(count));
  std::vector<std::size_t> widths(count, 0);
  for (std::size_t c = 0; c < count; ++c) {
    const TableColumn& column = table.columns[c];
    if (column.name.empty() || column.text.hidden) continue;
    lines[0][c] = column.text.heading.empty() ? heading(column) : column.text.heading;
    for (std::size_t r = 0; r < table.rows.size(); ++r)
      lines[r + 1][c] = plain_text(table.rows[r][c], column);
    std::size_t widest = 0;
    for (const auto& line : lines) widest = std::max(widest, character_count(line[c]));
    widths[c] = column.text.width > 0 ? static_cast<std::size_t>(column.text.width) : widest + 2;
  }
  for (const auto& [row, remark] : table.remarks) {
    std::vector<std::string>& line = lines.at(row + 1);
    for (std::size_t c = 2; c < count; ++c) line[c] = c == 2 ? remark : "";
  }
  std::string text;
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const std::size_t end = l > 0 && table.remarks.contains(l - 1) ? std::min<std::size_t>(count, 3) : count;
    for (std::size_t c = 0; c < end; ++c) {
      const std::size_t used = character_count(lines[l][c]);
      text += std::string(widths[c] > used ? widths[c] - used : 0, ' ') + lines[l][c];
    }
    text += '\n';
  }
  return text;
}

std::string to_csv(const Table& table) {
  table.validate();
  std::string out;
  const auto add_line = [&](const auto& field) {
    bool first = true;
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      if (table.columns[c].name.empty()) continue;
      if (!first) out += ',';
      out += field(c);
      first = false;
    }
    out += '\n';
  };
  add_line([&](std::size_t c) { return csv_field(std::string_view(heading(table.columns[c]))); });
  for (const auto& row : table.rows) add_line([&](std::size_t c) { return csv_field(row[c]); });
  return out;
}

}  // namespace petzval
