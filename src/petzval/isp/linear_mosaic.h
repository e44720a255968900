// SPDX-License-Identifier: BSD-3-Clause
// A raw image made proportional to light, and put right where the sensor is not: the first steps of
// development.
#pragma once

#include <petzval/sensor/raw_image.h>

#include <span>
#include <string>
#include <vector>

namespace petzval {

/// Values of a mosaic, proportional to light: 0 is black, 1 is the white level. Noise goes below 0, white
/// balance above 1.
struct LinearMosaic {
  int columns = 0, rows = 0;
  Mosaic mosaic;
  std::vector<std::string> channels;
  std::vector<float> values;  ///< row by row

  std::span<float> row(int r) {
    return std::span(values).subspan(static_cast<std::size_t>(r) * static_cast<std::size_t>(columns),
                                     static_cast<std::size_t>(columns));
  }
  std::span<const float> row(int r) const {
    return std::span(values).subspan(static_cast<std::size_t>(r) * static_cast<std::size_t>(columns),
                                     static_cast<std::size_t>(columns));
  }
};

/// The index 0 … count − 1 that stands for one beyond: mirrored at the edges without repeating them, which
/// keeps the phase of mosaics with a period of two.
inline int mirrored(int index, int count) {
  if (count == 1) return 0;
  while (index < 0 || index >= count) index = index < 0 ? -index : 2 * count - 2 - index;
  return index;
}

/// Linearization table, black level, white level. \throws InputError as RawImage::validate.
LinearMosaic linearised(const RawImage& raw);

/// Replaces the pixels `known` to be bad, then each one that lies outside the range of its eight nearest
/// neighbours of the same channel by more than that range and than `threshold` times the noise there, by the
/// median of those neighbours. The noise is what is stated and 1 % of the level, for gains that differ. A
/// pixel is detail, and stays, if those of other channels beside it stand out a quarter as much. \param
/// noise_scale, noise_offset  variance of the noise at a value x: scale · x + offset. \returns how many were
/// replaced.
int correct_defects(LinearMosaic& mosaic, double noise_scale, double noise_offset,
                    std::span<const PixelPlace> known = {}, double threshold = 5);

/// Divides by a picture of a uniform surface with the same sensor and lens: each channel of it is smoothed
/// over (2·radius + 1)² pixels, where those end at the border by the plane that fits them best, and scaled to
/// 1 at its greatest. \throws InputError if the sizes or the mosaic differ, or the flat field is black
/// somewhere.
void correct_shading(LinearMosaic& mosaic, const LinearMosaic& flat, int radius = 8);

/// Divides each channel by the response of that channel to white, scaled so that no channel is made weaker;
/// what then lies above 1 was saturated in some channel and is cut to 1, so that highlights stay white.
/// \throws InputError unless there is a positive number for every channel.
void balance_white(LinearMosaic& mosaic, const std::vector<double>& neutral);

/// Mean response of the channels, the greatest 1: white, if the picture is grey on average. Saturated pixels
/// do not count.
std::vector<double> grey_world_neutral(const LinearMosaic& mosaic);

}  // namespace petzval
