// SPDX-License-Identifier: BSD-3-Clause
// Whether light meets the surfaces of a lens with poses in their order.
#pragma once

#include <petzval/lens/lens.h>

namespace petzval {

/// Traces the chief ray of the middle of the field and eight rays around it, at 0.9 of the stop. Lenses
/// without poses pass, and so do those whose chief ray does not arrive. Gaps that are negative as designed,
/// and surfaces between equal media, may lie anywhere. \throws InputError naming two surfaces that cross, and
/// by how much, if a ray would have to run backwards from one to the next.
void require_surfaces_in_order(const Lens& lens);

}  // namespace petzval
