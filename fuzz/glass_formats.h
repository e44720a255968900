// SPDX-License-Identifier: BSD-3-Clause
// Entries of the formats that glass catalogues come in.
#pragma once

#include <string_view>

namespace petzval::fuzz {

// These are refused in one line, or make glasses with an index and a transmittance.

bool try_agf(std::string_view bytes);
bool try_glass_yaml(std::string_view bytes);
/// As it is, which the checksum nearly always refuses, and with the checksum made right.
bool try_packed(std::string_view bytes);

}  // namespace petzval::fuzz
