// SPDX-License-Identifier: BSD-3-Clause
// How far away each sample of a scene is.
#pragma once

#include <petzval/scene/scene.h>

#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// "sensor", "pupil" or "range". \throws InputError for another word.
DepthFrom parse_depth_from(const std::string& word);
const char* depth_from_word(DepthFrom from);

/// Reads a depth map [m]: .npy of shape (rows, columns) or (rows, columns, 1), or the channel Z of an .exr.
/// \throws InputError for another file, a damaged one, or one that is not as large as the scene.
std::vector<float> read_depth_file(const std::string& path, int columns, int rows);

/// The least and the greatest depth, and how many samples have nothing in them. \throws InputError for a
/// scene without depth.
struct DepthRange {
  double least_m = 0, greatest_m = 0;  ///< of the samples that have something; both infinite if none has
  std::size_t empty = 0;
};
DepthRange depth_range(const Scene& scene);

/// The median over the middle of the picture, a fifth of it wide and high; infinite where nothing is there.
/// In the unit and from the place that the map counts from.
double middle_depth_m(const Scene& scene);

}  // namespace petzval
