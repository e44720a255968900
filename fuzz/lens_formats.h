// SPDX-License-Identifier: BSD-3-Clause
// Entries of the formats that lenses come in.
#pragma once

#include <string_view>

namespace petzval::fuzz {

// These are refused in one line, or make a valid lens; if it can be written, it is written, read and written
// the same.

bool try_native(std::string_view bytes);
bool try_zmx(std::string_view bytes);
bool try_seq(std::string_view bytes);
bool try_pbrt(std::string_view bytes);
bool try_optical_bench(std::string_view bytes);
bool try_flaresim(std::string_view bytes);
bool try_iset(std::string_view bytes);
bool try_iset_transfer(std::string_view bytes);

/// Refused in one line, or written and read the same, and fitted or refused.
bool try_ray_table(std::string_view bytes);

}  // namespace petzval::fuzz
