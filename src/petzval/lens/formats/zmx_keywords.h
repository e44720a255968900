// SPDX-License-Identifier: BSD-3-Clause
// What each keyword of a .zmx file is to this reader.
#pragma once

#include <petzval/lens/formats/zmx_records.h>

#include <string>
#include <vector>

namespace petzval {

/// Goes through all records: what changes rays and is not modelled is an error, what is harmless is passed
/// over, and keywords that nobody here knows are named in one note. \throws InputError with file, line and
/// surface.
std::vector<std::string> check_zmx_keywords(const ZmxFile& file);

}  // namespace petzval
