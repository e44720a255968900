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

/// Thumbnails in rows, each with its label beneath, as one PNG that is about as wide as tall; small pictures
/// are enlarged by a whole factor. If even the brightest of them is dark, all are made brighter alike. \param
/// unit rows hold whole multiples of so many where that makes no strip of the sheet. \returns how many times
/// as much light is shown. \throws InputError for a picture that cannot be read.
double write_contact_sheet(const std::string& path, const std::vector<SheetEntry>& entries, int unit);

}  // namespace petzval::app
