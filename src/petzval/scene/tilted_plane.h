// SPDX-License-Identifier: BSD-3-Clause
// A flat scene that does not stand square to the camera.
#pragma once

#include <petzval/scene/scene.h>

namespace petzval {

/// The scene on a plane turned about its upright middle line, its right side farther away for angles above 0,
/// seen in perspective and with its depth, counted along the axis. The middle stays where it is. The plane is
/// so large that it fills the view: its far edge is all there, its near side goes beyond the frame.
/// \throws InputError for angles of 80° and more, so steep that the plane is seen edge-on in the frame, for a
/// scene at infinity, with depth, or a panorama.
Scene tilted(const Scene& scene, double tilt_deg);

}  // namespace petzval
