// SPDX-License-Identifier: BSD-3-Clause
// One ray over the plane that a ray transfer stands at.
#pragma once

#include <petzval/lens/transfer_data.h>
#include <petzval/trace/surface_step.h>

namespace petzval {

/// What a ray meets on its way between the planes of a transfer.
struct TransferCrossing {
  SurfaceRay front;       ///< on the front plane, on the side of the object
  double stop_x, stop_y;  ///< in the stop's coordinates [mm]
  double others_sq;       ///< (r/r_clear)² at the worst of the other apertures
};

/// Carries a ray, relative to the front plane, to the rear plane, or `backward` from there to the front
/// plane. False where polynomials say nothing: far outside of the domain, or no ray of it goes there.
bool carry(const TransferData<double>& transfer, bool backward, SurfaceRay& ray, TransferCrossing& crossing);

}  // namespace petzval
