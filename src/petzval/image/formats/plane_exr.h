// SPDX-License-Identifier: BSD-3-Clause
// OpenEXR files of planes that are no spectra: raw values, linear RGB.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

namespace petzval {

/// One channel of a picture: "R", "G", "B", "Y"; `values` row by row from the top.
struct ExrPlane {
  std::string name;
  std::span<const float> values;
};

/// Writes 32-bit floats, scan lines, ZIP compression; the same bytes for the same planes.
/// \param strings, numbers  further attributes. \throws InputError unless every plane has columns × rows
/// values, and as WholeFile; Failure.
void write_plane_exr(const std::string& path, int columns, int rows, const std::vector<ExrPlane>& planes,
                     const std::map<std::string, std::string>& strings = {},
                     const std::map<std::string, double>& numbers = {});

}  // namespace petzval
