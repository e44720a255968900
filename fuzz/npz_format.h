// SPDX-License-Identifier: BSD-3-Clause
// Entry of NumPy's archives, which hold maps of PSFs or irradiance.
#pragma once

#include <string_view>

namespace petzval::fuzz {

/// An archive is refused in one line, or makes a valid lens data table or finite light. Arrays that follow
/// lines "ARRAY name" are put into one first: in an archive, checksums would guard them from changes.
bool try_npz(std::string_view bytes);

}  // namespace petzval::fuzz
