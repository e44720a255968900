// SPDX-License-Identifier: BSD-3-Clause
// Depth in OpenEXR files.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// The channel Z of a file: distance along the direction of looking.
struct DepthPlane {
  int columns = 0, rows = 0;
  std::vector<float> values;  ///< rows from the top
};

/// Reads it from a file of any channels, in half, float or whole numbers. \returns nothing if the file has no
/// channel Z. \throws InputError if the file is missing, damaged or truncated, or Z is subsampled.
std::optional<DepthPlane> read_depth_exr(const std::string& path);

}  // namespace petzval
