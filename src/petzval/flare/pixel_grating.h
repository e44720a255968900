// SPDX-License-Identifier: BSD-3-Clause
// What a sensor reflects: its microlenses are a grating.
#pragma once

#include <petzval/sensor/sensor.h>

#include <vector>

namespace petzval {

/// The surface of a sensor. Without microlenses it is a mirror.
struct SensorReflection {
  // NOLINTNEXTLINE(google-explicit-constructor): a number is the reflectance of a mirror.
  SensorReflection(double share = 0) : reflectance(share) {}
  SensorReflection(double share, double pitch, double sag)
      : reflectance(share), pitch_um(pitch), microlens_sag_um(sag) {}

  double reflectance;           ///< over all orders
  double pitch_um = 0;          ///< of the pixels
  double microlens_sag_um = 0;  ///< from the middle of a microlens to its corner

  /// \throws InputError saying what would be right.
  void validate() const;
};

/// A sensor that says nothing of it reflects nothing.
SensorReflection reflection_of(const Sensor& sensor);

/// An order of a grating in two directions. Light of the direction cosines (l, m) leaves with
/// (l + right·λ/pitch, m + up·λ/pitch).
struct GratingOrder {
  int right = 0, up = 0;
  double share = 1;  ///< of the reflected light
  /// The same direction, at any wavelength.
  bool operator==(const GratingOrder& other) const { return right == other.right && up == other.up; }
};

/// The orders of microlenses side by side, each a paraboloid over its square pixel, the strongest first, that
/// together have all of the light but `neglected_share`; those that no direction of light gives are not among
/// them. Shares are squares of the Fourier coefficients of the phase 4π sag(x, y)/λ that reflection gives: a
/// thin grating under light that meets it upright (J. W. Goodman, Introduction to Fourier Optics, 3rd ed.
/// 2005, 4.4).
std::vector<GratingOrder> pixel_grating_orders(const SensorReflection& sensor, double wavelength_nm,
                                               double neglected_share = 0.01);

}  // namespace petzval
