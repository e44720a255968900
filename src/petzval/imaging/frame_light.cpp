// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/frame_light.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// Of a number that each entry of a table has.
template <typename OfEntry>
std::vector<double> mixed_over_wavelengths(const LensDataTable& table, double wavelength_nm,
                                           const OfEntry& of_entry) {
  const auto wavelengths = bracketing_wavelengths(table, wavelength_nm);
  std::vector<double> mixed(table.places(), 0.0);
  for (std::size_t place = 0; place < mixed.size(); ++place)
    for (const auto& [w, weight] : wavelengths) mixed[place] += weight * of_entry(table.index(place, w));
  return mixed;
}

}  // namespace

std::vector<double> frame_values(const LensDataTable& table, const std::vector<double>& values,
                                 double wavelength_nm) {
  return mixed_over_wavelengths(table, wavelength_nm, [&](std::size_t entry) { return values[entry]; });
}

FrameCentres::FrameCentres(const LensDataTable& table, const LightCentres& centres, double wavelength_nm)
    : none_(centres.none()) {
  if (none_) return;
  const auto part = [&](std::size_t axis) {
    return LatticeSpline(table.frame->x_mm, table.frame->y_mm,
                         mixed_over_wavelengths(table, wavelength_nm, [&](std::size_t entry) {
                           return centres.frame_offset_mm(entry)[axis];
                         }));
  };
  x_ = part(0);
  y_ = part(1);
}

std::array<double, 2> FrameCentres::chief_mm(double x_mm, double y_mm) const {
  std::array<double, 2> chief{x_mm, y_mm};
  if (none_) return chief;
  constexpr int most_rounds = 60;  // each halves what is left, at least
  constexpr double close_mm = 1e-12;
  for (int i = 0; i < most_rounds; ++i) {
    const std::array<double, 2> next{x_mm - x_(chief[0], chief[1]), y_mm - y_(chief[0], chief[1])};
    const double moved = std::hypot(next[0] - chief[0], next[1] - chief[1]);
    chief = next;
    if (moved < close_mm) break;
  }
  return chief;
}

double FrameCentres::stretch(double x_mm, double y_mm) const {
  if (none_) return 1;
  const LatticeSpline::Tangent x = x_.at(x_mm, y_mm), y = y_.at(x_mm, y_mm);
  return (1 + x.along_x) * (1 + y.along_y) - x.along_y * y.along_x;
}

FrameLight::FrameLight(const LensDataTable& table, const LightCentres& centres, double wavelength_nm) {
  const FramePlaces& frame = *table.frame;
  const FrameCentres moved(table, centres, wavelength_nm);
  const std::vector<double> g = frame_values(table, table.g_source_sr, wavelength_nm);
  for (const double value : g) dark.push_back(value > 0 ? 0 : 1);
  const auto spline = [&](std::vector<double> values) {
    return LatticeSpline(frame.x_mm, frame.y_mm, std::move(values));
  };
  const LatticeSpline x = spline(frame_values(table, frame.object_x, wavelength_nm)),
                      y = spline(frame_values(table, frame.object_y, wavelength_nm));
  LatticeSpline light = spline(g);
  flatten_about_darkness(dark, light);
  for (const double y_mm : frame.y_mm)
    for (const double x_mm : frame.x_mm) {
      const auto [chief_x, chief_y] = moved.chief_mm(x_mm, y_mm);
      object_x.push_back(x(chief_x, chief_y));
      object_y.push_back(y(chief_x, chief_y));
      g_source_sr.push_back(std::max(0.0, light(chief_x, chief_y) / moved.stretch(chief_x, chief_y)));
    }
}

void flatten_about_darkness(const std::vector<char>& dark, LatticeSpline& spline) {
  const std::size_t across = spline.x().size(), down = spline.y().size();
  for (std::size_t j = 0; j + 1 < down; ++j)
    for (std::size_t i = 0; i + 1 < across; ++i) {
      const std::size_t a = j * across + i;
      if (dark[a] != 0 || dark[a + 1] != 0 || dark[a + across] != 0 || dark[a + across + 1] != 0)
        spline.flatten(i, j);
    }
}

}  // namespace petzval
