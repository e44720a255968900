// SPDX-License-Identifier: BSD-3-Clause
// Whether a MAT file is what it claims to be, before matio reads it.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace petzval {

/// Walks all of a MAT file of version 5 (also called 6 and 7): compressed variables are unpacked and their
/// checksums compared, every tag, size and dimension must fit into what holds it, and the file must end where
/// its last variable does. matio does not look: of a truncated file it returns zeros, and a wrong dimension
/// keeps it busy for hours. Written from the published description of the format (MathWorks, MAT-File Format,
/// level 5). \param file  for the messages. \throws InputError saying where the file goes wrong; for other
/// versions, how to save it as version 7.
void check_mat_structure(std::span<const std::byte> bytes, const std::string& file);

}  // namespace petzval
