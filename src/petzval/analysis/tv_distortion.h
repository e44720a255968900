// SPDX-License-Identifier: BSD-3-Clause
// How much the edge of a picture bends, as makers of cameras count it.
#pragma once

#include <petzval/lens/lens.h>

#include <optional>
#include <span>
#include <vector>

namespace petzval {

/// A picture's width and height on the sensor.
struct FrameSize {
  double width_mm = 0, height_mm = 0;
  double half_diagonal_mm() const;
};

struct TvDistortion {
  double wavelength_nm = 0;
  double smia_percent = 0;            ///< 100 (A − B)/B
  double picture_height_percent = 0;  ///< half of that: the bend of the edge over the picture's height
};

/// Of a rectangle whose corners are imaged into those of the frame at the reference wavelength: A is its
/// height in the picture at the left and right edge, B in the middle (SMIA 1.0, part 2.0, "TV distortion").
/// Barrels are negative. Chief rays decide, whatever clips others. \throws InputError where none reaches the
/// corners of the frame.
std::vector<TvDistortion> tv_distortion(const Lens& lens, const FrameSize& frame,
                                        std::span<const double> wavelengths_nm);

/// The frame of 4:3 whose corners the largest field of the lens reaches; nothing for a lens of the axis
/// alone, or where its chief ray does not arrive.
std::optional<FrameSize> frame_of_fields(const Lens& lens);

}  // namespace petzval
