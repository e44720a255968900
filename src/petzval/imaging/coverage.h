// SPDX-License-Identifier: BSD-3-Clause
// Whether a scene and a lens data table reach as far as a frame sees, and how finely the frame must look.
#pragma once

#include <petzval/imaging/band_plan.h>
#include <petzval/imaging/scene_aim.h>

#include <string>
#include <vector>

namespace petzval {

/// Adds a note of how far the scene falls short of what a frame sees of it (seen_extent(),
/// margin_of(surround) included). A panorama never does. \throws InputError if it does and nothing was said
/// about its surroundings.
void check_coverage(const Scene& scene, const SeenExtent& wanted, Surround surround,
                    std::vector<std::string>& notes, const SceneAim& aim = {});

/// Adds a note if the lens data table ends before the corners of the frame, or before what lights them.
void note_dark_corners(const std::vector<BandPlan>& plans, const SensorGeometry& frame,
                       std::vector<std::string>& notes);

/// How many points of a cell to take in each direction, so that no sample of the scene is skipped in any
/// band.
int points_per_cell(const std::vector<BandPlan>& plans, const SensorGeometry& frame);

}  // namespace petzval
