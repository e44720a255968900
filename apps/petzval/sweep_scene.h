// SPDX-License-Identifier: BSD-3-Clause
// How wide the scene of a sweep is: a chart or a photograph that fills each point's frame and the margin of
// its PSF would be of another scale wherever the PSF is of another size.
#pragma once

#include <string>
#include <vector>

#include "sweep_arguments.h"
#include "sweep_folder.h"
#include "sweep_result.h"

namespace petzval::app {

/// The --scene-angle-least of each point; "" where none is right: a per cent more than any point's frame
/// needs, for all points whose scene fills the frame. Found once, kept in the folder, and said in a note.
std::vector<std::string> scene_angles(const CLI::App& app, const SweepCommand& options,
                                      const std::vector<SweepPoint>& points, SweepFolder& folder,
                                      const Shared& shared);

/// Says so if a point's scene had to be wider than that.
void check_scene_angle(const PointResult& result, const std::string& angle, const Shared& shared);

}  // namespace petzval::app
