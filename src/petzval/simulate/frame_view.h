// SPDX-License-Identifier: BSD-3-Clause
// What a sensor behind a lens sees.
#pragma once

#include <petzval/lens/lens.h>
#include <petzval/sensor/sensor.h>

namespace petzval {

/// Full width, height and diagonal of what is imaged onto a frame by real chief rays of the reference
/// wavelength: degrees for an object at infinity, else mm on the object plane. NaN where no chief ray
/// arrives.
struct FrameView {
  bool at_infinity = true;
  double width = 0, height = 0, diagonal = 0;
};
FrameView frame_view(const Lens& lens, const SensorGeometry& frame);

}  // namespace petzval
