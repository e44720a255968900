// SPDX-License-Identifier: BSD-3-Clause
// What a page may say to the live server.
#pragma once

#include <string_view>

namespace petzval::fuzz {

/// A message or an upload is refused in one line, or holds nothing but numbers in range and names that were
/// offered.
bool try_live(std::string_view bytes);

}  // namespace petzval::fuzz
