// SPDX-License-Identifier: BSD-3-Clause
// The numbers of an ENVI image, some rows at a time.
#pragma once

#include <petzval/scene/formats/envi_header.h>
#include <petzval/scene/spectral_cube.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace petzval {

/// Fills `out` with the bytes of a data file from a place on.
using EnviBytes = std::function<void(std::uint64_t from, std::span<char> out)>;

/// Plane i of the cube, which has its size, becomes band order[i] of the file, calibrated; numbers that mean
/// "no data" become 0. Some 16 MiB of the file are in memory at a time.
void read_envi_planes(const EnviHeader& header, std::span<const std::size_t> order, const EnviBytes& bytes,
                      SpectralCube& cube);

}  // namespace petzval
