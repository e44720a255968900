// SPDX-License-Identifier: BSD-3-Clause
// All rays of one object point, one direction at infinity, or one image point.
#pragma once

#include <petzval/trace/tracer.h>

#include <array>
#include <optional>

namespace petzval {

/// The rays of one point, labelled by two numbers (u, v) chosen so that du dv is the measure that radiometry
/// wants:
///
/// | pencil | rays | (u, v) | du dv is |
/// |---|---|---|---|
/// | object at infinity, field angle θ | direction (0, sin θ, cos θ) | position on the plane through vertex 1
/// perpendicular to the ray [mm] | cross-section of the beam dA⊥ [mm²] | | object point (0, h, −distance) |
/// through the point | direction cosines (L, M) | dα_o dβ_o [sr] | | image point (x', y', image plane) |
/// through the point, traced backwards | direction cosines (L, M) of the light, in the sensor frame | dα dβ
/// [sr] |
///
/// The field lies in the y-z plane, so the pencil of a lens without poses is mirror symmetric in u. A field
/// at another azimuth is that of the lens turned (Tracer::turned).
class Pencil {
 public:
  /// `field` in degrees for a lens whose object is at infinity, else the object height in mm.
  /// \throws InputError for an angle of 180° or more, or a non-finite field.
  static Pencil from_object(const Lens& lens, double field);
  static Pencil from_image(const Tracer& tracer, double image_height_mm, double image_x_mm = 0);

  /// The ray (u, v), at its object point, on its launch plane, or at its image point; nothing where u² + v² ≥
  /// 1 for direction cosines. From an object point more than 100 m away it starts where it is nearest to
  /// vertex 1, its path counted from the sphere about the object point through vertex 1: differences of paths
  /// keep their digits.
  std::optional<Ray> ray(double u, double v) const;
  /// The object or image point; infinitely far in front of the lens for parallel rays.
  std::array<double, 3> point_mm() const;
  bool backward() const { return kind_ == Kind::image_point; }
  bool object_at_infinity() const { return kind_ == Kind::parallel; }

  /// Where on the plane through vertex 1 the ray (0, v) of an object point goes [mm], and back: as the object
  /// goes away, rays through the same part of the lens keep their place there, while their v draw together.
  /// Of other pencils v itself.
  double entrance_mm(double v) const;
  double v_through(double entrance_mm) const;
  /// What heights at the stop may be off by [mm], of object points that are far away: the digits of v are
  /// steps where the lens stands.
  double rounding_mm() const;

  /// The ray traced through the whole lens, and by how much it clears the apertures; a ray that does not
  /// exist is +infinity outside.
  Tracer::Clearance clearance(const Tracer& tracer, double u, double v, Tracer::Clip clip) const;

 private:
  enum class Kind { parallel, object_point, image_point };
  Pencil(Kind kind, double y, double z, double x = 0) : kind_(kind), x_(x), y_(y), z_(z) {}

  Kind kind_;
  double x_, y_, z_;  ///< the point [mm], or 0, the sine and the cosine of the field angle
};

/// Where the labels u and v of a pencil can lie at all: direction cosines, or a launch plane far wider than
/// any glass.
struct LabelRange {
  double low, high;
};
LabelRange label_range(const Tracer& tracer, const Pencil& pencil);
/// A difference of labels for slopes at the stop: far smaller than the pupil, far larger than rounding.
double label_nudge(const Tracer& tracer, const Pencil& pencil);

/// Finds the v of the chief ray of a pencil: the meridional ray through the centre of the real stop surface.
/// Newton from `guess`, with a scan of the whole pencil when that fails; among several solutions the one
/// nearest to the guess. Nothing when no ray of the pencil crosses the stop centre.
std::optional<double> aim_chief_ray(const Tracer& tracer, const Pencil& pencil, double guess);

/// Marches from the axis outwards to a field, chief ray after chief ray; for wide-angle lenses, whose pupil
/// wanders too far for the paraxial guess. Every step predicts the next chief ray from the last two, and is
/// halved until the predicted ray crosses the stop inside its rim (predictions are places on the plane
/// through vertex 1, which an object's distance hardly changes): so the branch that begins on the axis is
/// never left for another, and where it ends there is no chief ray. Fields may be asked in any order; near
/// the last one is cheapest.
class ChiefRayMarch {
 public:
  enum class From { object, image };
  ChiefRayMarch(const Lens& lens, const Tracer& tracer, From from = From::object);

  /// Nothing when the chief rays end before that field: they miss a surface or are totally reflected.
  std::optional<double> v_at(double field);

 private:
  Pencil pencil_at(double field) const;
  /// The chief ray of a pencil near a prediction; nothing if that misses the stop.
  std::optional<double> follow(const Pencil& pencil, double predicted) const;

  const Lens& lens_;
  const Tracer& tracer_;
  From from_;
  double step_, last_field_ = 0, last_v_ = 0, last_entrance_ = 0, slope_ = 0;
};

}  // namespace petzval
