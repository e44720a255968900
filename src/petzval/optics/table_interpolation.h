// SPDX-License-Identifier: BSD-3-Clause
// Distortion and illumination of a lens data table as curves: between its fields and between its wavelengths.
#pragma once

#include <petzval/numeric/interpolation.h>
#include <petzval/optics/lens_data_table.h>

#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// What leads through the fields of a table: a monotone cubic (order 0), which meets every entry and never
/// overshoots, or a least-squares polynomial of 4th to 8th order as in the 2005 paper.
struct RadialFit {
  int polynomial_order = 0;

  /// "monotone" or "4" … "8". \throws InputError for anything else.
  static RadialFit parse(const std::string& text);
};

/// The radial curves of a lens at one wavelength; made for one call a pixel. Heights are those of the real
/// chief ray on the sensor [mm], fields are in the unit of the table. Beyond the table's last field, heights
/// and fields go on with the last slope and g is held: nothing is known there.
class RadialProfile {
 public:
  /// Object field whose chief ray arrives at this height, and back: one is the exact inverse of the other.
  double object_field(double image_height_mm) const { return field_(image_height_mm); }
  double image_height_mm(double object_field) const { return field_.inverse(object_field); }
  double g_source_sr(double image_height_mm) const { return g_source_(image_height_mm); }
  double g_sensor_sr(double image_height_mm) const { return g_sensor_(image_height_mm); }
  /// The height that the table's last field reaches.
  double max_height_mm() const { return field_.back(); }

 private:
  friend class RadialProfiles;
  MonotoneCubic field_, g_source_, g_sensor_;  ///< over image height; odd, even, even
};

/// How far the curves of a fit stay from the entries of a table at one wavelength; all zero for monotone
/// cubics.
struct FitResiduals {
  double height_rms_um = 0, height_max_um = 0;
  double g_source_rms = 0, g_source_max = 0;  ///< relative to the axis
  double g_sensor_rms = 0, g_sensor_max = 0;  ///< relative to the axis
  bool monotone = true;  ///< false: the height turns back between fields, the fit is of no use
};

/// The curves of a table at any wavelength that it covers: linear between its wavelengths, at a field.
///
///     RadialProfiles profiles(table);
///     const RadialProfile at = profiles.at_wavelength(555);
///     double field = at.object_field(2.4), g = at.g_source_sr(2.4);
class RadialProfiles {
 public:
  /// Takes what it needs of the table. \throws InputError unless the table has two fields and more than
  /// `fit.polynomial_order` of them.
  explicit RadialProfiles(const LensDataTable& table, RadialFit fit = {});

  /// \throws InputError if the table does not cover the wavelength (a table with one wavelength serves 0.5 nm
  /// around it), or if a polynomial through the image heights turns back, as high orders do.
  RadialProfile at_wavelength(double wavelength_nm) const;
  /// \throws InputError if the table does not cover the wavelength.
  FitResiduals residuals_at(double wavelength_nm) const;

 private:
  struct Columns;
  Columns columns_at(double wavelength_nm) const;

  RadialFit fit_;
  std::vector<double> fields_, wavelengths_nm_, real_image_height_mm_, g_source_sr_, g_sensor_sr_;
};

}  // namespace petzval
