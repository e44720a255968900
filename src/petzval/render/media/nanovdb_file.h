// SPDX-License-Identifier: BSD-3-Clause
// Grids of .nvdb files, as media have them.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace petzval::render {

/// All voxels of a sparse grid from the first to the last active one along each axis, and one more around
/// them, which have the value of the background.
struct VoxelGrid {
  std::array<int, 3> first{}, size{};        ///< along x, y and z
  std::vector<float> values;                 ///< x fastest
  std::array<double, 9> world_from_index{};  ///< row by row
  std::array<double, 3> origin{};            ///< of the index (0, 0, 0), in world space
};

/// Whether a file has a grid of that name. \throws InputError.
bool has_nanovdb_grid(std::string_view bytes, const std::string& file, const std::string& grid);

/// A grid of floats of a file of NanoVDB, version 32, plain or compressed with ZIP. The layout is that of the
/// comments of NanoVDB.h 32.4 (Museth, SIGGRAPH Talks 2021). \param file  for messages. \throws InputError
/// for anything else, and for more than 2^28 voxels.
VoxelGrid read_nanovdb(std::string_view bytes, const std::string& file, const std::string& grid);

}  // namespace petzval::render
