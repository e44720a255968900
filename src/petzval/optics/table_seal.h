// SPDX-License-Identifier: BSD-3-Clause
// Size and checksum in front of a lens data table: HDF5 must not be let loose on a damaged file.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace petzval {

/// Length of the user block that holds the seal.
inline constexpr std::size_t table_seal_bytes = 512;

/// The user block for the bytes that follow it: three lines of text (format, size, FNV-1a checksum) and
/// zeros.
std::string table_seal(std::string_view contents);

/// \throws InputError unless the file begins with a seal and size and checksum are those of the rest; a file
/// without one is told apart from what is no HDF5 file at all.
void check_table_seal(const std::string& path);

}  // namespace petzval
