// SPDX-License-Identifier: BSD-3-Clause
// What is known for certain of a picture of a three-dimensional scene: where its pixels look, and where what
// they see moves.
#pragma once

#include <petzval/simulate/render.h>

#include <vector>

namespace petzval {

/// Tangents of the direction in which each pixel's middle sees through the middle of the stop: to the right
/// and down from the camera's axis. NaN where no light arrives. [row][column][right, down].
/// \throws Cancelled.
std::vector<float> rays_seen(const PreparedScene& scene, const Context& context = {});

/// Optical flow of a camera that moves (RenderRequest::camera_move): how far what a pixel's middle sees, when
/// the exposure of its row begins, is from there when the exposure ends of the row in which it then is
/// [pixels]. The scene stands still, and what hides something later is not asked. NaN where nothing is seen,
/// and where what is seen leaves the lens's field. [row][column][right, down].
/// \throws InputError for a camera that does not move; Cancelled.
std::vector<float> flow_seen(const PreparedScene& scene, const Context& context = {});

/// The same scene through the middle of its stop, a fiftieth as wide, when its exposure begins, and its light
/// as strong as through all of it: all in focus, and nothing moves. What the stop's edge and lens mounts cut
/// off at the border of the picture, they do not cut off here. \throws InputError; Failure; Cancelled.
Rendering render_sharp(const PreparedScene& scene, const Context& context = {});

/// World from camera, a matrix of rows that acts on (x right, y up, z forward, 1) [scene units], at a time of
/// the exposure from 0 to 1.
std::array<std::array<double, 4>, 4> camera_pose(const PreparedScene& scene, double time = 0);

}  // namespace petzval
