// SPDX-License-Identifier: BSD-3-Clause
// The lens files of ISET3d and isetlens: JSON, written as .iset.json, `ior` the index behind a surface, the
// stop has ior 0 and radius 0.
#pragma once

#include <petzval/lens/formats/json_document.h>
#include <petzval/lens/lens_file.h>

namespace petzval {

/// Whether a document is one of these: its surfaces have an `ior`.
bool is_iset(const JsonDocument& document);
LensFile read_iset(const JsonDocument& document);

/// \throws InputError for what its rows cannot say (rows_of_lens).
std::string iset_text(const Lens& lens);

}  // namespace petzval
