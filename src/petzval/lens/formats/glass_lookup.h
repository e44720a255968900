// SPDX-License-Identifier: BSD-3-Clause
// From the glass name in a lens file to a material.
#pragma once

#include <petzval/lens/lens_file.h>

#include <string>
#include <vector>

namespace petzval {

/// The material that a file calls `name`, after the user's substitutions (case does not matter).
/// \param preferred  catalogues to search first, in this order.
/// \throws InputError naming the nearest known glasses and the way to substitute one.
Material find_glass(const std::string& name, const LensReadOptions& options,
                    const std::vector<std::string>& preferred = {});

}  // namespace petzval
