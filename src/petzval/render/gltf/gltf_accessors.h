// SPDX-License-Identifier: BSD-3-Clause
// Numbers out of the buffers of a glTF file.
#pragma once

#include <petzval/render/gltf/gltf_file.h>

#include <array>
#include <cstdint>
#include <vector>

namespace petzval::render {

/// What an accessor holds, row by row.
struct GltfNumbers {
  std::size_t count = 0, components = 0;
  std::vector<double> values;  ///< [count][components]; normalised integers are in [0, 1] or [−1, 1]

  template <std::size_t Size>
  std::vector<std::array<float, Size>> tuples() const {
    std::vector<std::array<float, Size>> result(count);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t c = 0; c < Size; ++c) result[i][c] = static_cast<float>(values[i * components + c]);
    return result;
  }
};

/// The numbers of an accessor, sparse ones too. \param path  of the entry that names it. \throws InputError
/// unless it has so many components, and lies within its buffer, which is checked before room is made.
GltfNumbers read_accessor(const GltfFile& file, int index, std::size_t components, const std::string& path);

}  // namespace petzval::render
