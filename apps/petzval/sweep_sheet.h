// SPDX-License-Identifier: BSD-3-Clause
// What a sweep shows: a contact sheet, a page, a table.
#pragma once

#include <petzval/report/table.h>

#include <string>
#include <vector>

namespace petzval::app {

/// A picture of the sheet.
struct SheetEntry {
  std::string picture;  ///< path of a PNG; empty: the point failed
  std::string label;    ///< "F-NUMBER 2.8"
};

/// Thumbnails in rows of `per_row`, each with its label beneath, as one PNG; small pictures are enlarged by a
/// whole factor. \throws InputError for a picture that cannot be read.
void write_contact_sheet(const std::string& path, const std::vector<SheetEntry>& entries, int per_row);

}  // namespace petzval::app
