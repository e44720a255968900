// SPDX-License-Identifier: BSD-3-Clause
// A table of numbers with units: the same one is printed, goes into JSON, into a page and into a CSV file.
#pragma once

#include <map>
#include <string>
#include <variant>
#include <vector>

namespace petzval {

/// How a terminal shows a column, where that differs from what the column says.
struct TextColumn {
  std::string heading{};  ///< empty: "name [unit]"
  std::string format{};   ///< of numbers, as fmt has it: ".4f", "g"; empty: the decimals of the column
  int width = 0;          ///< with the gap before it; 0: its widest cell and two spaces
  std::string gap = "-";  ///< a number that is not finite
  bool hidden = false;
};

/// A column without a name is for programs alone: JSON has it, people do not see it.
struct TableColumn {
  std::string name;
  std::string unit{};
  int decimals = 3;   ///< shown to people; CSV files get every digit
  std::string key{};  ///< for programs: "rms_radius_um"
  TextColumn text{};
};

/// A number, a piece of text, or yes or no. A number that is not finite is a gap.
using TableCell = std::variant<double, std::string, bool>;

///     Table table{{{"field", "deg", 1}, {"distortion", "%", 2}}, {{0.0, 0.0}, {14.0, -3.61}}};
struct Table {
  std::vector<TableColumn> columns;
  std::vector<std::vector<TableCell>> rows;
  /// By row: what text has from the third column on in place of numbers that mean nothing.
  std::map<std::size_t, std::string> remarks{};

  /// \throws InputError unless every row has as many cells as there are columns.
  void validate() const;
};

/// A cell as people read it: fixed decimals and a true minus sign; a dash for a gap.
std::string cell_text(const TableCell& cell, int decimals);

/// Lines for a terminal: headings with units, then the rows, all to the right, with a plain minus sign that
/// other programs can read. \throws InputError as Table::validate.
std::string to_text(const Table& table);

/// RFC 4180 with a header line "name [unit]" and line feeds; numbers with the fewest digits that give back
/// the same double, nothing for a gap. \throws InputError as Table::validate.
std::string to_csv(const Table& table);

}  // namespace petzval
