// SPDX-License-Identifier: BSD-3-Clause
// Opcode lists of DNG 1.4 (chapter 7): what a reader is to do to the picture, and when.
#pragma once

#include <petzval/sensor/raw_image.h>

#include <cstdint>
#include <span>
#include <string>

namespace petzval::dng {

/// On the stored numbers (OpcodeList1): FixBadPixelsList, for mosaics of 2 × 2 with two greens, which are all
/// that it knows. Empty if there is nothing to do.
std::string opcodes_of_samples(const RawImage& raw);
/// On linear values (OpcodeList2): GainMap, of each of the four kinds of pixels for a mosaic of 2 × 2, which
/// is how some readers want it.
std::string opcodes_of_values(const RawImage& raw);
/// After demosaicing (OpcodeList3): FixVignetteRadial, then WarpRectilinear or WarpFisheye.
std::string opcodes_of_picture(const LensFacts& lens);

/// Take what they know of a list and pass over the rest. \throws InputError for a list that contradicts
/// itself.
void take_sample_opcodes(std::span<const std::uint8_t> list, RawImage& raw);
void take_value_opcodes(std::span<const std::uint8_t> list, RawImage& raw);
void take_picture_opcodes(std::span<const std::uint8_t> list, RawImage& raw);

}  // namespace petzval::dng
