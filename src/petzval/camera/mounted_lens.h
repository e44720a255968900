// SPDX-License-Identifier: BSD-3-Clause
// Lens + focus + stop + sensor geometry: what all three ways to the sensor are given.
#pragma once

#include <petzval/lens/lens.h>

#include <optional>

namespace petzval {

/// A lens as it is used: where the object is, where the sensor is, how far the stop is closed. Refocusing and
/// stopping down are written here and nowhere else.
///
///     MountedLens camera(read_lens("dgauss-50mm").lens);
///     camera.set_f_number(4);
///     camera.focus_at_m(1.5);
///     Tracer tracer(camera.lens(), 550);
///
/// A change of object distance leaves the rest of the lens as it was: an aperture that is stated at the
/// object (working f-number, numerical aperture) becomes the entrance pupil diameter that it stood for, and
/// field points stated as object heights keep their angle from the entrance pupil. An object whose waves are
/// flat over the entrance pupil to a thousandth of a wave, and ten million times as far away as the lens is
/// large, is at infinity.
class MountedLens {
 public:
  /// The lens as its prescription has it.
  explicit MountedLens(Lens lens);

  /// The lens with object distance, last thickness and aperture as this camera uses them; everything
  /// downstream traces this one.
  const Lens& lens() const { return lens_; }

  /// Focuses on an object at this distance from the sensor plane (absent: infinity) by moving the sensor. The
  /// designer's offset from the paraxial focus is kept: at the prescription's own object distance nothing
  /// moves. Of the two positions of the object that share one distance to the sensor, it takes the one on the
  /// prescription's side of unit magnification.
  /// \throws InputError if the object would stand inside the lens or has no real image behind it.
  void focus_at_m(std::optional<double> distance_from_sensor_m);
  /// Light of this wavelength [nm] is what focus_at_m() brings into focus from now on; absent: that of the
  /// reference wavelength. The designer's offset stays that of the reference wavelength.
  void set_focus_wavelength_nm(std::optional<double> wavelength_nm);
  std::optional<double> focus_wavelength_nm() const { return focus_wavelength_nm_; }
  /// How far the last focus_at_m() put the sensor behind the place for the reference wavelength [mm].
  double colour_shift_mm() const { return colour_shift_mm_; }
  /// Keeps the sensor where the prescription has it, and puts the object at this distance from the sensor.
  void place_object_at_m(std::optional<double> distance_from_sensor_m);
  /// Keeps the prescription's object and sensor.
  void focus_as_designed();
  /// Puts the sensor this far behind the last vertex; the object stays as far in front of the lens as it is.
  /// \throws InputError unless that is above 0 and up to 1 km: beyond, paths lack digits for waves.
  void set_image_distance_mm(double distance_mm);
  /// Moves the sensor away from the lens (negative: towards it), from where it is. \throws InputError if it
  /// would touch the lens.
  void move_sensor_mm(double shift_mm);
  /// Moves the whole lens towards the object (negative: towards the sensor), both of which stay where they
  /// are: how a lens in a helicoid is focused. \throws InputError if the lens would touch one of them.
  void move_lens_mm(double towards_object_mm);
  /// From the object to the sensor plane [m]; absent: infinity.
  std::optional<double> object_distance_from_sensor_m() const;

  /// Stops down to a paraxial f-number at infinity; below what the lens opens to by up to 0.005, as rounded
  /// numbers are: opens it. \throws InputError if it is lower still.
  void set_f_number(double f_number);
  /// Blades of the stop, or none. \throws InputError as StopBlades::validate().
  void set_blades(const StopBlades& blades);

 private:
  void use(std::optional<double> object_distance_mm, double image_distance_mm);

  Lens prescription_, lens_;
  std::optional<double> f_number_;  ///< absent: as the prescription has it
  std::optional<double> focus_wavelength_nm_;
  double colour_shift_mm_ = 0;
};

}  // namespace petzval
