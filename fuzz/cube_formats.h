// SPDX-License-Identifier: BSD-3-Clause
// Entries of the formats that planar scenes come in.
#pragma once

#include <string_view>

namespace petzval::fuzz {

// These are refused in one line, or make a scene whose radiance is finite and not negative.

/// A header, a line "DATA", and what is in the file beside it.
bool try_envi(std::string_view bytes);
/// A JSON text, a line "DATA", and a .npy file.
bool try_npy(std::string_view bytes);
bool try_scene_mat(std::string_view bytes);
bool try_scene_mat_hdf5(std::string_view bytes);
bool try_scene_exr(std::string_view bytes);

/// Is refused in one line, or becomes finite linear light.
bool try_photograph(std::string_view bytes);

}  // namespace petzval::fuzz
