// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/lens/pose.h>
#include <petzval/optics/frame_symmetry.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace petzval {

namespace {

bool is_multiple(double angle_deg, double of_deg) {
  constexpr double rounding_deg = 1e-9;
  return std::abs(std::remainder(angle_deg, of_deg)) < rounding_deg;
}

}  // namespace

FrameSymmetry frame_symmetry(const Lens& lens) {
  if (!is_round(lens)) return {};
  const StopBlades blades = lens.stop_blades();
  if (blades.count == 0) return {true, true, true};
  // A corner at φ from +y goes to −φ across, to 180° − φ down and to 180° + φ by half a turn.
  const double apart_deg = 360.0 / blades.count;
  return {is_multiple(2 * blades.rotation_deg, apart_deg),
          is_multiple(2 * blades.rotation_deg - 180, apart_deg), is_multiple(180, apart_deg)};
}

double FrameTwin::azimuth_deg(double at_twin_deg) const {
  double azimuth = across ? -at_twin_deg : at_twin_deg;
  if (down) azimuth = 180 - azimuth;
  return azimuth > 180 ? azimuth - 360 : azimuth <= -180 ? azimuth + 360 : azimuth;
}

FrameTwin twin_of(const FrameSymmetry& symmetry, const FramePlaces& frame, std::size_t place) {
  const std::size_t columns = frame.x_mm.size(), rows = frame.y_mm.size();
  std::size_t column = place % columns, row = place / columns;
  const bool right = 2 * column > columns - 1, above = 2 * row > rows - 1, level = 2 * row == rows - 1;
  FrameTwin twin;
  twin.across = symmetry.across && right;
  twin.down = symmetry.down && above;
  if (symmetry.turned && !symmetry.mirrors()) twin.across = twin.down = above || (level && right);
  if (twin.across) column = columns - 1 - column;
  if (twin.down) row = rows - 1 - row;
  twin.place = frame.place(column, row);
  return twin;
}

Psf round_psf(const Psf& psf) {
  const int middle = psf.size / 2, reach = (psf.size - 1) / 2;
  const double radius_squared = 0.25 * psf.size * psf.size;
  Psf round;
  round.size = 2 * reach + 1;
  round.spacing_um = psf.spacing_um;
  double inside = 0, whole = 0;
  for (const float value : psf.values) whole += double(value);
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j) {
      round.values.push_back(i * i + j * j <= radius_squared ? psf.at(middle + i, middle + j) : 0.0F);
      inside += double(round.values.back());
    }
  round.captured = psf.captured * (inside / whole);
  for (float& value : round.values) value = static_cast<float>(double(value) * (whole / inside));
  return round;
}

Psf mirrored_psf(Psf psf) {
  for (int i = 0; i < psf.size; ++i) {
    const auto row = psf.values.begin() + static_cast<std::ptrdiff_t>(i) * psf.size;
    std::reverse(row, row + psf.size);
  }
  return psf;
}

}  // namespace petzval
