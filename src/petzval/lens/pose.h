// SPDX-License-Identifier: BSD-3-Clause
// Lenses as they are built: surfaces, groups of surfaces and the sensor off their places.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace petzval {

struct Lens;

/// How far something stands from the place that the prescription gives it: moved first, then turned about
/// its new x axis, then about its new y axis, then about its new z axis. Turns are right-handed: a positive
/// tilt about x turns +y towards +z. All else in the lens stays where it is.
struct Pose {
  double decentre_x_mm = 0, decentre_y_mm = 0, shift_z_mm = 0;
  double tilt_x_deg = 0, tilt_y_deg = 0, tilt_z_deg = 0;

  /// Whether it is no pose at all.
  bool is_none() const;
};

/// The numbers of a pose by their names in files.
struct PoseNumber {
  const char* name;
  double Pose::*value;
  bool is_length;  ///< [mm], else [degrees]
};
inline constexpr std::array<PoseNumber, 6> pose_numbers{{{"decentre_x_mm", &Pose::decentre_x_mm, true},
                                                         {"decentre_y_mm", &Pose::decentre_y_mm, true},
                                                         {"shift_z_mm", &Pose::shift_z_mm, true},
                                                         {"tilt_x_deg", &Pose::tilt_x_deg, false},
                                                         {"tilt_y_deg", &Pose::tilt_y_deg, false},
                                                         {"tilt_z_deg", &Pose::tilt_z_deg, false}}};

/// Neighbouring surfaces that move as one, such as an element or a barrel.
struct SurfaceGroup {
  std::size_t first = 0;
  std::size_t last = 0;  ///< the number of surfaces stands for the sensor
  Pose pose = {};
  double pivot_mm = 0;  ///< what it turns about: on the axis, so far behind the vertex of `first`
};

/// A place in lens space against the one that the prescription gives.
struct Frame {
  using Vector = std::array<double, 3>;

  Vector offset_mm{};                                             ///< of the vertex
  std::array<Vector, 3> rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< own axes → lens space

  bool is_none() const;
  /// Whether it is turned into itself about the axis of the lens, but for a turn about its own.
  bool is_centred() const;
  Vector to_lens(const Vector& own) const;     ///< turns a direction
  Vector from_lens(const Vector& lens) const;  ///< and back
  /// A place in own axes, its z counted as in lens space: the vertex stands at `vertex_z_mm`. And back.
  Vector point_to_lens(const Vector& own, double vertex_z_mm) const;
  Vector point_from_lens(const Vector& lens, double vertex_z_mm) const;
  /// The same place seen after the whole lens has been turned by `angle` [rad] about its axis, from +x
  /// towards +y; own axes are turned back, so that what is round stays as it was.
  Frame turned(double angle) const;
  /// Of the mirror image x → −x of the lens.
  Frame mirrored() const;
  /// As turned() and mirrored(), the own axes taken along: for what is not round itself.
  Frame turned_with_axes(double angle) const;
  Frame mirrored_with_axes() const;
};

/// Of every surface, and of the sensor last: its own pose, then those of its groups, in the order in which
/// the lens lists them.
std::vector<Frame> frames_of(const Lens& lens);

/// Whether a pose of any surface, group or of the sensor is set.
bool has_poses(const Lens& lens);

/// Whether nothing but the blades of its stop keeps the lens from being round about its axis: no poses, no
/// surface and no aperture that is not round itself.
bool is_round(const Lens& lens);

/// The lens without any pose.
Lens as_designed(Lens lens);

/// \throws InputError if the lens is not round, naming the pose, surface or aperture, and saying what knows
/// centred lenses only and what would be right.
void require_centred(const Lens& lens, const char* what);

}  // namespace petzval
