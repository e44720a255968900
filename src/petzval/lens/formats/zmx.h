// SPDX-License-Identifier: BSD-3-Clause
// Zemax sequential lens files (.zmx), a line a record: a keyword of four letters and its values.
#pragma once

#include <petzval/lens/lens_file.h>

#include <string>

namespace petzval {

/// \param text  decoded. \param file  for error messages.
/// \throws InputError naming line and surface for everything that changes rays and is not modelled.
LensFile read_zmx(const std::string& text, const std::string& file, const LensReadOptions& options);

/// \throws InputError for what such a file cannot hold: index tables, powers of r that no surface type has,
/// glasses that a reader would confuse.
std::string zmx_text(const Lens& lens);

}  // namespace petzval
