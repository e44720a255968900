// SPDX-License-Identifier: BSD-3-Clause
// Light is never negative.
#pragma once

#include <petzval/imaging/cell_plane.h>

namespace petzval {

/// The plane with no value below zero and the same sum.
///
/// Weights of either sign, which give pixels their aperture and tiles their mixtures of kernels, leave small
/// negative values beside points of light in darkness. Each square of 2 × 2 values makes up for those in it,
/// as far as it has light; what remains goes to squares of 4 × 4, and so on. The light about a negative value
/// becomes less by the same share everywhere in its square. A plane whose sum is negative comes out dark.
CellPlane without_negative_light(CellPlane plane);

}  // namespace petzval
