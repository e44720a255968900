// SPDX-License-Identifier: BSD-3-Clause
// From the glass name in a lens file to a material.
#pragma once

#include <petzval/lens/lens_file.h>

#include <string>
#include <vector>

namespace petzval {

/// Whether the user asked for another glass in place of this one; case does not matter.
bool is_substituted(const std::string& name, const LensReadOptions& options);

/// The material that a file calls `name`, after the user's substitutions.
/// \param preferred  catalogues to search first, in this order.
/// \throws InputError naming the nearest known glasses and the way to substitute one.
Material find_glass(const std::string& name, const LensReadOptions& options,
                    const std::vector<std::string>& preferred = {});

}  // namespace petzval
