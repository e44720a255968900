// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/base/wavelength.h>
#include <petzval/camera/mounted_lens.h>
#include <petzval/lens/first_order.h>

#include <cmath>
#include <utility>

namespace petzval {

namespace {

/// f-numbers are printed with two decimals: one that is below what the lens opens to by no more is that.
constexpr double f_number_rounding = 0.005;
/// An object this near (relative) to the prescription's own is the prescription's own: nothing moves.
constexpr double same_object = 1e-12;
/// A path as long is known to 1e-10 mm: 1e-6 waves, and the phases of waves stay known after many surfaces.
constexpr double farthest_sensor_mm = 1e6;

void refuse_distant_sensor(double distance_mm, const Lens& lens) {
  if (distance_mm > farthest_sensor_mm)
    throw InputError(
        fmt::format("the sensor would stand {:g} mm behind lens {}; up to {:g} mm would be right",
                    distance_mm, lens.name, farthest_sensor_mm));
}

/// Paraxial transfer from vertex 1 to the last vertex: y' = a·y + b·u, u' = c·y + d·u. An object s in front
/// of vertex 1 has its image i = −(a·s + b)/(c·s + d) behind the last vertex.
struct LensMatrix {
  double a, b, c, d;

  LensMatrix(const Lens& lens, double wavelength_nm) {
    const std::size_t last = lens.surfaces.size() - 1;
    const ParaxialRay parallel = trace_paraxial(lens, 1, 0, wavelength_nm);
    const ParaxialRay central = trace_paraxial(lens, 0, 1, wavelength_nm);
    a = parallel.height_mm[last], c = parallel.slope[last];
    b = central.height_mm[last], d = central.slope[last];
  }
  double determinant() const { return a * d - b * c; }
  double image_mm(std::optional<double> object_mm) const {
    return object_mm ? -(a * *object_mm + b) / (c * *object_mm + d) : -a / c;
  }
  /// Beyond unit magnification the distance from object to image grows with that of the object.
  bool beyond_unit_magnification(std::optional<double> object_mm) const {
    if (!object_mm) return true;
    const double slope = c * *object_mm + d;
    return slope * slope >= determinant();
  }
};

/// Waves of an object so far away are flat over the entrance pupil to this [mm], a thousandth of a wave, and
/// chief rays at its edge are parallel to this share of the lens: it is at infinity. (Labels of rays from an
/// object point would run out of digits a hundred times farther.)
constexpr double flat_mm = 5e-7, parallel_share = 1e-7;

bool as_good_as_infinite(const Lens& lens, double object_distance_mm) {
  if (!(object_distance_mm > lens.total_track_mm() / parallel_share)) return false;
  const FirstOrder facts = first_order(lens);
  const double pupil_mm = facts.entrance_pupil.diameter_mm;
  return object_distance_mm > std::abs(facts.efl_mm) / parallel_share &&
         object_distance_mm > pupil_mm * pupil_mm / (8 * flat_mm);
}

/// "infinity", or the distance in m.
std::string named_distance(std::optional<double> distance_m) {
  return distance_m ? fmt::format("{} m", *distance_m) : "infinity";
}

/// An infinite number means no number; anything else must be a distance.
std::optional<double> checked_distance(std::optional<double> distance_m) {
  if (!distance_m || (std::isinf(*distance_m) && *distance_m > 0)) return {};
  if (!(std::isfinite(*distance_m) && *distance_m > 0))
    throw InputError(fmt::format(
        "the object distance is {} m; it is measured from the sensor and must be positive", *distance_m));
  return distance_m;
}

[[noreturn]] void throw_too_near(const Lens& lens, double distance_m, double nearest_mm) {
  throw InputError(
      fmt::format("lens {} cannot be focused on {} m: its sharp image of any object is at least {:.6g} m "
                  "from the object",
                  lens.name, distance_m, nearest_mm / mm_per_m));
}

/// The object distance s with s + fixed + image_mm(s) = 0, i.e. the root of
/// c·s² + (d + fixed·c − a)·s + (fixed·d − b) on the wanted side of unit magnification.
double conjugate_object_mm(const Lens& lens, const LensMatrix& m, double fixed_mm, bool far_side,
                           double distance_m) {
  const double half_linear = 0.5 * (m.d + fixed_mm * m.c - m.a), constant = fixed_mm * m.d - m.b;
  const double discriminant = half_linear * half_linear - m.c * constant;
  if (discriminant < 0) {
    const double unit_object_mm = (std::copysign(std::sqrt(m.determinant()), m.c) - m.d) / m.c;
    const double offset_mm = fixed_mm + distance_m * mm_per_m;
    throw_too_near(lens, distance_m, unit_object_mm + m.image_mm(unit_object_mm) + offset_mm);
  }
  // Both roots without cancellation: one from the larger sum, the other from the product.
  const double sum = -(half_linear + std::copysign(std::sqrt(discriminant), half_linear));
  const double one = sum / m.c, other = constant / sum;
  // They differ in their side of unit magnification. Of a lens that is telecentric on both sides, whose power
  // is next to nothing and of either sign, the farther one may be the wrong one.
  if (m.beyond_unit_magnification(one) != m.beyond_unit_magnification(other))
    return m.beyond_unit_magnification(one) == far_side ? one : other;
  return far_side ? std::max(one, other) : std::min(one, other);
}

/// Restates what `moved`, a copy of `lens` with another object distance, says in terms of the object.
void keep_aperture_and_angles(const Lens& lens, Lens& moved) {
  const Aperture::Kind kind = moved.aperture.kind;
  const bool aperture = kind == Aperture::Kind::working_f_number || kind == Aperture::Kind::image_na ||
                        kind == Aperture::Kind::object_na;
  const bool heights = moved.fields.kind == Fields::Kind::object_height_mm && lens.object_distance_mm;
  if (!aperture && !heights) return;
  const PupilData pupil = first_order(lens).entrance_pupil;
  if (aperture) moved.aperture = {Aperture::Kind::entrance_pupil_diameter_mm, pupil.diameter_mm};
  if (!heights || !std::isfinite(pupil.position_mm)) return;
  for (double& field : moved.fields.values) {
    const double tangent = field / (*lens.object_distance_mm + pupil.position_mm);
    field = moved.object_distance_mm ? tangent * (*moved.object_distance_mm + pupil.position_mm)
                                     : degrees(std::atan(tangent));
  }
  if (!moved.object_distance_mm) moved.fields.kind = Fields::Kind::angle_deg;
}

}  // namespace

MountedLens::MountedLens(Lens lens) : prescription_(std::move(lens)) {
  prescription_.validate();
  focus_as_designed();
}

/// Rebuilds the lens in use from the prescription.
void MountedLens::use(std::optional<double> object_distance_mm, double image_distance_mm) {
  Lens lens = prescription_;
  if (object_distance_mm && as_good_as_infinite(prescription_, *object_distance_mm))
    object_distance_mm.reset();
  lens.object_distance_mm = object_distance_mm;
  lens.set_image_distance_mm(image_distance_mm);
  if (f_number_) lens.aperture = {Aperture::Kind::f_number, *f_number_};
  if (object_distance_mm != prescription_.object_distance_mm) keep_aperture_and_angles(prescription_, lens);
  lens_ = std::move(lens);
}

void MountedLens::focus_at_m(std::optional<double> distance_from_sensor_m) {
  const std::optional<double> distance_m = checked_distance(distance_from_sensor_m);
  const double reference_nm = prescription_.reference_wavelength_nm;
  const LensMatrix reference(prescription_, reference_nm);
  const LensMatrix matrix(prescription_, focus_wavelength_nm_.value_or(reference_nm));
  const double design_mm = prescription_.image_distance_mm();
  const double offset_mm = design_mm - reference.image_mm(prescription_.object_distance_mm);
  if (matrix.c == 0 || !std::isfinite(offset_mm))
    throw InputError(
        fmt::format("lens {} is afocal or has its object in its focus, and cannot be focused by moving "
                    "the sensor; keep the focus of the design",
                    prescription_.name));
  std::optional<double> object_mm;
  if (distance_m) {
    const double glass_mm = prescription_.total_track_mm() - design_mm;
    object_mm =
        conjugate_object_mm(prescription_, matrix, glass_mm + offset_mm - *distance_m * mm_per_m,
                            matrix.beyond_unit_magnification(prescription_.object_distance_mm), *distance_m);
    if (!(*object_mm > 0))
      throw InputError(
          fmt::format("an object {} m from the sensor would stand inside lens {}, which ends {:.6g} m from "
                      "the sensor",
                      *distance_m, prescription_.name, prescription_.total_track_mm() / mm_per_m));
  }
  const double image_mm = matrix.image_mm(object_mm);
  if (!(image_mm > 0 && image_mm + offset_mm > 0))
    throw InputError(fmt::format("lens {} forms no real image behind its last surface of an object at {}",
                                 prescription_.name, named_distance(distance_m)));
  colour_shift_mm_ = image_mm - reference.image_mm(object_mm);
  const std::optional<double> design_object_mm = prescription_.object_distance_mm;
  if (colour_shift_mm_ == 0 && object_mm.has_value() == design_object_mm.has_value() &&
      (!object_mm || std::abs(*object_mm - *design_object_mm) <= same_object * *object_mm))
    return focus_as_designed();
  use(object_mm, image_mm + offset_mm);
}

void MountedLens::set_focus_wavelength_nm(std::optional<double> wavelength_nm) {
  if (wavelength_nm) require_wavelength(*wavelength_nm, "`focus_wavelength_nm`");
  focus_wavelength_nm_ = wavelength_nm;
}

void MountedLens::place_object_at_m(std::optional<double> distance_from_sensor_m) {
  const std::optional<double> distance_m = checked_distance(distance_from_sensor_m);
  const double track_mm = prescription_.total_track_mm();
  if (distance_m && *distance_m * mm_per_m <= track_mm)
    throw InputError(
        fmt::format("an object {} m from the sensor would stand inside lens {}, which ends {:.6g} m from "
                    "the sensor",
                    *distance_m, prescription_.name, track_mm / mm_per_m));
  std::optional<double> object_mm;
  if (distance_m) object_mm = *distance_m * mm_per_m - track_mm;
  use(object_mm, prescription_.image_distance_mm());
}

void MountedLens::focus_as_designed() {
  use(prescription_.object_distance_mm, prescription_.image_distance_mm());
}

void MountedLens::set_image_distance_mm(double distance_mm) {
  if (!(std::isfinite(distance_mm) && distance_mm > 0))
    throw InputError(
        fmt::format("the sensor would stand {:g} mm behind the last surface of lens {}; it must be behind it",
                    distance_mm, prescription_.name));
  refuse_distant_sensor(distance_mm, prescription_);
  use(lens_.object_distance_mm, distance_mm);
}

void MountedLens::move_sensor_mm(double shift_mm) {
  set_image_distance_mm(lens_.image_distance_mm() + shift_mm);
}

void MountedLens::move_lens_mm(double towards_object_mm) {
  std::optional<double> object_mm = lens_.object_distance_mm;
  if (object_mm) *object_mm -= towards_object_mm;
  if (object_mm && !(*object_mm > 0))
    throw InputError(fmt::format("moved by {:g} mm, lens {} would touch its object, {:g} mm in front of it",
                                 towards_object_mm, prescription_.name, *lens_.object_distance_mm));
  const double image_mm = lens_.image_distance_mm() + towards_object_mm;
  if (!(std::isfinite(image_mm) && image_mm > 0))
    throw InputError(fmt::format("moved by {:g} mm, lens {} would touch its sensor", towards_object_mm,
                                 prescription_.name));
  refuse_distant_sensor(image_mm, prescription_);
  use(object_mm, image_mm);
}

std::optional<double> MountedLens::object_distance_from_sensor_m() const {
  if (!lens_.object_distance_mm) return {};
  return (*lens_.object_distance_mm + lens_.total_track_mm()) / mm_per_m;
}

void MountedLens::set_f_number(double f_number) {
  if (!(std::isfinite(f_number) && f_number > 0))
    throw InputError(fmt::format("f/{} is no f-number; give a positive one", f_number));
  const double open = first_order(prescription_).f_number;
  if (!std::isfinite(open))
    throw InputError(fmt::format("lens {} is afocal and has no f-number", prescription_.name));
  if (f_number < open - f_number_rounding)
    throw InputError(fmt::format("lens {} opens to f/{:.4g} only; f/{} asks for more", prescription_.name,
                                 open, f_number));
  f_number_ = std::max(f_number, open);
  use(lens_.object_distance_mm, lens_.image_distance_mm());
}

void MountedLens::set_blades(const StopBlades& blades) {
  blades.validate();
  for (Lens* lens : {&prescription_, &lens_}) lens->surfaces[lens->stop_index()].blades = blades;
}

}  // namespace petzval
