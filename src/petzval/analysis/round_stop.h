// SPDX-License-Identifier: BSD-3-Clause
// What is known of round stops only.
#pragma once

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/lens/lens.h>

namespace petzval {

/// \throws InputError if the stop has blades, saying what is known of round stops only and what would be
/// right.
inline void require_round_stop(const Lens& lens, const char* what) {
  if (lens.stop_blades().count == 0) return;
  throw InputError(
      fmt::format("{}: its stop has {} blades, and {}; set surfaces[{}].blades=null for the round stop",
                  lens.name, lens.stop_blades().count, what, lens.stop_index()));
}

/// The lens without its blades.
inline Lens with_round_stop(Lens lens) {
  lens.surfaces[lens.stop_index()].blades = {};
  return lens;
}

}  // namespace petzval
