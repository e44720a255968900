// SPDX-License-Identifier: BSD-3-Clause
// Media that were measured.
#pragma once

#include <array>
#include <span>
#include <string_view>

namespace petzval::render {

/// Red, green and blue [1/mm]; scattering is reduced: as if it were even.
struct NamedMedium {
  std::string_view name;
  std::array<double, 3> scattering, absorption;
};

/// The twelve of H. W. Jensen, S. R. Marschner, M. Levoy & P. Hanrahan, "A practical model for subsurface
/// light transport", SIGGRAPH 2001, by the names that pbrt-v4 gives them.
std::span<const NamedMedium> named_media();

/// Null: there is none of this name.
const NamedMedium* named_medium(std::string_view name);

}  // namespace petzval::render
