// SPDX-License-Identifier: BSD-3-Clause
// What is tried on bytes that nobody vouches for, one entry a file format.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace petzval::fuzz {

/// Reads the bytes as a file of one format. They are refused by an InputError of one line, or what comes out
/// is whole: polygons make regions, a lens is valid, and what is written from it reads back and is written
/// the same. Anything else throws or aborts. \return whether the bytes were accepted.
using Entry = bool (*)(std::string_view bytes);

struct Format {
  const char* name;
  Entry entry;
  std::vector<std::string> words;  ///< that mean something in the format
};

/// native, zmx, seq, pbrt, iset, agf, yaml, packed, sensor, dng, polygons, svg, isetmat, isetparms, listing,
/// measured, kept, scene, gltf, ply, envi, npy, scenemat, sceneexr, png, jpeg, tiff, live.
const std::vector<Format>& formats();
/// Null if there is none of that name.
const Format* find_format(std::string_view name);

}  // namespace petzval::fuzz
