// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/frame_motion.h>
#include <petzval/lens/lens.h>
#include <petzval/lens/pose.h>
#include <petzval/lens/surface_kind.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace petzval {

namespace {

constexpr RowsOf<double> identity{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

Motion<double> motion_of(const Pose& pose) {
  return {{pose.decentre_x_mm, pose.decentre_y_mm, pose.shift_z_mm},
          {radians(pose.tilt_x_deg), radians(pose.tilt_y_deg), radians(pose.tilt_z_deg)}};
}

void move(const Pose& pose, double from_pivot_mm, Frame& frame) {
  FrameOf<double> moved{frame.offset_mm, frame.rows};
  move(motion_of(pose), from_pivot_mm, moved);
  frame = {moved.offset_mm, moved.rows};
}

}  // namespace

bool Pose::is_none() const {
  return decentre_x_mm == 0 && decentre_y_mm == 0 && shift_z_mm == 0 && tilt_x_deg == 0 && tilt_y_deg == 0 &&
         tilt_z_deg == 0;
}

bool Frame::is_none() const {
  return offset_mm == Vector{} && rows == identity;
}

bool Frame::is_centred() const {
  return offset_mm[0] == 0 && offset_mm[1] == 0 && rows[0][2] == 0 && rows[1][2] == 0;
}

Frame::Vector Frame::to_lens(const Vector& own) const {
  return product(rows, own);
}

Frame::Vector Frame::from_lens(const Vector& lens) const {
  return transposed_product(rows, lens);
}

Frame::Vector Frame::point_to_lens(const Vector& own, double vertex_z_mm) const {
  Vector point = to_lens({own[0], own[1], own[2] - vertex_z_mm});
  for (std::size_t i = 0; i < 3; ++i) point[i] += offset_mm[i];
  point[2] += vertex_z_mm;
  return point;
}

Frame::Vector Frame::point_from_lens(const Vector& lens, double vertex_z_mm) const {
  Vector point =
      from_lens({lens[0] - offset_mm[0], lens[1] - offset_mm[1], lens[2] - vertex_z_mm - offset_mm[2]});
  point[2] += vertex_z_mm;
  return point;
}

Frame Frame::turned(double angle) const {
  if (is_none()) return *this;
  return {product(about_z(angle), offset_mm), product(about_z(angle), product(rows, about_z(-angle)))};
}

Frame Frame::mirrored() const {
  Frame result = *this;
  result.offset_mm[0] = -offset_mm[0];
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      if ((i == 0) != (k == 0)) result.rows[i][k] = -rows[i][k];
  return result;
}

Frame Frame::turned_with_axes(double angle) const {
  return {product(about_z(angle), offset_mm), product(about_z(angle), rows)};
}

Frame Frame::mirrored_with_axes() const {
  Frame result = *this;
  result.offset_mm[0] = -offset_mm[0];
  for (double& entry : result.rows[0]) entry = -entry;
  return result;
}

std::vector<Frame> frames_of(const Lens& lens) {
  const std::size_t sensor = lens.surfaces.size();
  std::vector<double> vertex_mm(sensor + 1, 0.0);
  for (std::size_t i = 0; i < sensor; ++i) vertex_mm[i + 1] = vertex_mm[i] + lens.surfaces[i].thickness_mm;
  std::vector<Frame> frames(sensor + 1);
  for (std::size_t i = 0; i <= sensor; ++i) {
    const Pose& pose = i < sensor ? lens.surfaces[i].pose : lens.sensor_pose;
    if (!pose.is_none()) move(pose, 0, frames[i]);
  }
  for (const SurfaceGroup& group : lens.groups)
    for (std::size_t i = group.first; i <= std::min(group.last, sensor) && !group.pose.is_none(); ++i)
      move(group.pose, vertex_mm[i] - (vertex_mm[group.first] + group.pivot_mm), frames[i]);
  return frames;
}

bool has_poses(const Lens& lens) {
  const auto surface_has = [](const Surface& surface) { return !surface.pose.is_none(); };
  const auto group_has = [](const SurfaceGroup& group) { return !group.pose.is_none(); };
  return !lens.sensor_pose.is_none() || std::ranges::any_of(lens.surfaces, surface_has) ||
         std::ranges::any_of(lens.groups, group_has);
}

namespace {

bool has_round_shape(const Surface& surface) {
  return !surface.grating && (!surface.shape || surface_kind(surface.shape->kind).is_round);
}

bool has_round_apertures(const Surface& surface) {
  return std::ranges::all_of(surface.apertures, &ApertureFigure::is_round);
}

}  // namespace

bool is_round(const Lens& lens) {
  return !has_poses(lens) && std::ranges::all_of(lens.surfaces, [](const Surface& surface) {
    return has_round_shape(surface) && has_round_apertures(surface);
  });
}

Lens as_designed(Lens lens) {
  for (Surface& surface : lens.surfaces) surface.pose = {}, surface.grating.reset();
  lens.groups.clear();
  lens.sensor_pose = {};
  return lens;
}

namespace {

/// The first pose that is set, as `set` names it.
std::string first_pose(const Lens& lens) {
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
    if (!lens.surfaces[i].pose.is_none()) return fmt::format("surfaces[{}].pose", i);
  for (std::size_t i = 0; i < lens.groups.size(); ++i)
    if (!lens.groups[i].pose.is_none()) return fmt::format("groups[{}].pose", i);
  return "sensor_pose";
}

}  // namespace

void require_centred(const Lens& lens, const char* what) {
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
    if (lens.surfaces[i].grating)
      throw InputError(
          fmt::format("{0}: surfaces[{1}] is a grating, and {2}; set surfaces[{1}].grating=null for the "
                      "surface without lines",
                      lens.name, i, what));
    if (!has_round_shape(lens.surfaces[i]))
      throw InputError(
          fmt::format("{}: surfaces[{}].shape is not round about the axis, and {}", lens.name, i, what));
    if (!has_round_apertures(lens.surfaces[i]))
      throw InputError(
          fmt::format("{0}: surfaces[{1}].apertures are not round, and {2}; set surfaces[{1}].apertures=null "
                      "for round ones",
                      lens.name, i, what));
  }
  if (!has_poses(lens)) return;
  throw InputError(fmt::format("{}: {} is set, and {}; set {}=null for the lens as designed", lens.name,
                               first_pose(lens), what, first_pose(lens)));
}

}  // namespace petzval
