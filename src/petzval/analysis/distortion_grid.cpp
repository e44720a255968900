// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/distortion_grid.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// Chief rays by the place of a plane object: tangents of its angles, or mm.
class PlaneObject {
 public:
  PlaneObject(const Lens& lens, double wavelength_nm)
      : tracer_(lens, wavelength_nm, Tracer::Clip::none), far_(!lens.object_distance_mm) {}

  std::optional<Eigen::Vector2d> landing_mm(const Eigen::Vector2d& at) {
    Eigen::Vector2d field = at;
    if (const double tangent = at.norm(); far_ && tangent > 0) field *= degrees(std::atan(tangent)) / tangent;
    const auto landed = tracer_.landing_mm(field.x(), field.y());
    if (!landed) return {};
    return Eigen::Vector2d((*landed)[0], (*landed)[1]);
  }

 private:
  FieldTracer tracer_;
  bool far_;
};

}  // namespace

double DistortionGrid::largest_share() const {
  double farthest = 0, reach = 0;
  for (std::size_t i = 0; i < x_mm.size(); ++i) {
    reach = std::max(reach, std::hypot(ideal_x_mm[i] - ideal_x_mm[x_mm.size() / 2],
                                       ideal_y_mm[i] - ideal_y_mm[x_mm.size() / 2]));
    const double distance = std::hypot(x_mm[i] - ideal_x_mm[i], y_mm[i] - ideal_y_mm[i]);
    if (distance > farthest) farthest = distance;  // not of NaN
  }
  return farthest / reach;
}

DistortionGrid distortion_grid(const Lens& lens, const FrameSize& frame, double wavelength_nm, int lines) {
  if (lines < 3 || lines % 2 == 0 || lines > 1001)
    throw InputError(fmt::format("a grid of {} lines; an odd number from 3 to 1001 would be right", lines));
  if (!(frame.width_mm > 0 && frame.height_mm > 0 && std::isfinite(frame.half_diagonal_mm())))
    throw InputError(fmt::format("a frame of {:g} x {:g} mm; positive sides would be right", frame.width_mm,
                                 frame.height_mm));
  PlaneObject object(lens, wavelength_nm);
  // The derivative in the middle, by differences so small that distortion of third order leaves 1e-8 of it.
  const double step = 1e-4 * (lens.object_distance_mm ? *lens.object_distance_mm : 1);
  const auto middle = object.landing_mm(Eigen::Vector2d::Zero());
  Eigen::Matrix2d per_object;
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d beside = step * Eigen::Vector2d::Unit(axis);
    const auto one = object.landing_mm(beside), other = object.landing_mm(-beside);
    if (!middle || !one || !other)
      throw InputError(lens.name + ": no chief ray reaches the middle of the image");
    per_object.col(axis) = (*one - *other) / (2 * step);
  }
  const Eigen::Matrix2d per_image = per_object.inverse();
  DistortionGrid grid;
  grid.lines = lines, grid.wavelength_nm = wavelength_nm;
  for (int row = 0; row < lines; ++row)
    for (int column = 0; column < lines; ++column) {
      const Eigen::Vector2d from_middle(frame.width_mm * (column / (lines - 1.0) - 0.5),
                                        frame.height_mm * (0.5 - row / (lines - 1.0)));
      const auto landed = object.landing_mm(per_image * from_middle);
      grid.ideal_x_mm.push_back(middle->x() + from_middle.x());
      grid.ideal_y_mm.push_back(middle->y() + from_middle.y());
      grid.x_mm.push_back(landed ? landed->x() : NAN);
      grid.y_mm.push_back(landed ? landed->y() : NAN);
    }
  return grid;
}

}  // namespace petzval
