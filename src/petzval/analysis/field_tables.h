// SPDX-License-Identifier: BSD-3-Clause
// Distortion and illumination, row by row of field and wavelength.
#pragma once

#include <petzval/lens/lens.h>
#include <petzval/trace/losses.h>
#include <petzval/trace/tracer.h>

#include <optional>
#include <vector>

namespace petzval {

/// Which fields and wavelengths to tabulate; empty lists mean the lens's own.
struct FieldTableRequest {
  Fields::Kind field_kind = Fields::Kind::angle_deg;
  std::vector<double> fields = {};
  std::vector<double> wavelengths_nm = {};
  Tracer::Clip clip = Tracer::Clip::apertures;
  Losses losses = {};  ///< that illumination counts
  /// Of the fields, anticlockwise from +y as seen from the film: says something of lenses with poses or
  /// blades. Tangential is along it, sagittal across.
  double azimuth_deg = 0;

  /// The lens's own field kind, fields and wavelengths.
  static FieldTableRequest of(const Lens& lens);
};

struct DistortionRow {
  double field = 0, wavelength_nm = 0;
  double object_field = 0;              ///< degrees or mm
  bool lit = true;                      ///< false: no ray passes; heights and percentages are NaN
  double image_height_mm = 0;           ///< real chief ray
  double paraxial_image_height_mm = 0;  ///< f tan θ or m h at this wavelength
  double image_x_mm = 0;                ///< of a lens with poses, across the field
  /// (real − ideal)/ideal about the centre of the picture: the ideal height is the paraxial one times the
  /// real magnification at the centre, on the sensor where it stands, over the paraxial one; 0 on the axis.
  double distortion_percent = 0;
  /// (real − paraxial)/paraxial; at zero field its limit, which is zero where the sensor is in paraxial
  /// focus.
  double paraxial_distortion_percent = 0;
  /// Of a lens with poses, whose centre is where field 0 lands: how far the image lies beside the field, per
  /// ideal height; 0 at field 0.
  double across_percent = 0;
  /// Against f θ; only for objects at infinity.
  std::optional<double> distortion_ftheta_percent;
};

struct IlluminationRow {
  double field = 0, wavelength_nm = 0;
  double object_field = 0;
  bool lit = true;                 ///< false: no ray passes; g is 0
  bool pupil_in_one_piece = true;  ///< else g_sensor counts only the piece around the chief ray, holes filled
  double real_image_height_mm = 0;  ///< of the chief ray, though an aperture may stop it; NaN without one
  double real_image_x_mm = 0;       ///< beside the field; 0 of a centred lens
  double g_sensor_sr = 0, g_source_sr = 0;
  double relative_illumination = 0;  ///< g_sensor / g_sensor on axis at the same wavelength
};

/// Rows in the order fields × wavelengths. \throws InputError when no light passes at any of the fields.
std::vector<DistortionRow> distortion_table(const Lens& lens, const FieldTableRequest& request);
std::vector<IlluminationRow> illumination_table(const Lens& lens, const FieldTableRequest& request);

}  // namespace petzval
