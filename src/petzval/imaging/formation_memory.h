// SPDX-License-Identifier: BSD-3-Clause
// What images of one scene leave to the next.
#pragma once

#include <petzval/imaging/scene_detail.h>

namespace petzval {

/// What the next image of a scene need not find again, whatever the lens. An image has the same bytes with it
/// and without. Not for several images at a time.
struct FormationMemory {
  KnownDetail detail;
};

}  // namespace petzval
