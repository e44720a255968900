// SPDX-License-Identifier: BSD-3-Clause
// The image of a point at a place of the sensor.
#pragma once

#include <petzval/base/context.h>
#include <petzval/live/bench.h>
#include <petzval/simulate/psf_stack.h>

#include <array>
#include <cstdint>
#include <vector>

namespace petzval {

/// A point of light in three colours, as the lens images it to a place: [row][column][red, green, blue] from
/// the top, with the place's chief ray of the reference wavelength in the middle. Rows run away from the axis
/// upwards.
struct BenchPsf {
  int size = 0;
  double spacing_um = 0, height_mm = 0, azimuth_deg = 0;
  double captured = 0;  ///< the least share of the light in the window
  std::vector<float> rgb = {};
};

/// The wavelengths of the lens stand for its colours: those above 590 nm are shown as red, those below 500 nm
/// as blue, those between as green; a lens of fewer shows what it has. \param place_mm  x, y of the upright
/// picture. \throws InputError where no ray arrives; Cancelled.
BenchPsf bench_psf(const CoatedLens& coated, const std::array<double, 2>& place_mm, const Context& context);

/// A place of the upright picture as a field of the lens, at the lens's wavelengths.
FieldTableRequest field_at(const CoatedLens& coated, const std::array<double, 2>& place_mm);

/// The floats as bytes, lowest first.
std::vector<std::uint8_t> float_bytes(const std::vector<float>& values);

}  // namespace petzval
