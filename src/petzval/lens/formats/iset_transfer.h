// SPDX-License-Identifier: BSD-3-Clause
// The ray-transfer files of ISET3d (isetrtf): JSON, written as .raytransfer.json.
#pragma once

#include <petzval/lens/formats/json_document.h>
#include <petzval/lens/lens_file.h>

namespace petzval {

/// Whether a document is one of these: it has `polynomials`.
bool is_iset_transfer(const JsonDocument& document);
/// The lens with its sensor in the paraxial image of an object at infinity, and fields up to the edge of what
/// passes.
LensFile read_iset_transfer(const JsonDocument& document);

/// \throws InputError for a lens that is no ray transfer in turned variables.
std::string iset_transfer_text(const Lens& lens);

}  // namespace petzval
