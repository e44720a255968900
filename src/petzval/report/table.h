// SPDX-License-Identifier: BSD-3-Clause
// A table of numbers with units: the same one goes into a page and into a CSV file.
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace petzval {

struct TableColumn {
  std::string name;
  std::string unit{};  ///< empty: none
  int decimals = 3;    ///< shown to people; CSV files get every digit
  std::string key{};   ///< for programs: "rms_radius_um"
};

/// A number or a piece of text. A number that is not finite is a gap.
using TableCell = std::variant<double, std::string>;

///     Table table{{{"field", "deg", 1}, {"distortion", "%", 2}}, {{0.0, 0.0}, {14.0, -3.61}}};
struct Table {
  std::vector<TableColumn> columns;
  std::vector<std::vector<TableCell>> rows;

  /// \throws InputError unless every row has as many cells as there are columns.
  void validate() const;
};

/// A cell as people read it: fixed decimals and a true minus sign; a dash for a gap.
std::string cell_text(const TableCell& cell, int decimals);

/// RFC 4180 with a header line "name [unit]" and line feeds; numbers with the fewest digits that give back
/// the same double, nothing for a gap. \throws InputError as Table::validate.
std::string to_csv(const Table& table);

}  // namespace petzval
