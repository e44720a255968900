// SPDX-License-Identifier: BSD-3-Clause
// NumPy arrays as scenes.
#pragma once

#include <petzval/scene/spectral_cube.h>

#include <string>
#include <string_view>

namespace petzval {

/// Reads a .npy file of shape (rows, columns, bands) or (rows, columns), and what a JSON file of the same
/// name says about it (cube.npy: cube.json), if there is one:
///
///     {"quantity": "radiance", "unit": "W.m^-2.sr^-1.nm^-1", "wavelengths_nm": [450, 550, 650],
///      "angle_deg": 20, "distance_m": 1.5, "scale": 1, "name": "bench"}
///
/// All keys are optional. \param check  is called before the numbers are read. \throws InputError as
/// read_npy, for another shape, and for a bad JSON file.
SpectralCube read_npy_scene(const std::string& path, const CubeCheck& check = {});

/// The JSON file that read_npy_scene() reads with a .npy file. Empty if there is none.
std::string npy_companion(const std::string& path);

/// Puts what a JSON text says into the cube. \param file  for messages. \throws InputError for an unknown key
/// or a value of another kind.
void describe_cube(std::string_view json, const std::string& file, SpectralCube& cube);

}  // namespace petzval
