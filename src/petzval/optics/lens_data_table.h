// SPDX-License-Identifier: BSD-3-Clause
// The lens data table of Maeda, Catrysse & Wandell 2005: all that image formation needs to know of a lens.
#pragma once

#include <petzval/lens/first_order.h>
#include <petzval/wave/psf.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// Real chief-ray height, g_source, g_sensor and PSF by object field and wavelength, for one lens at one
/// focus and stop. Arrays are [field][wavelength], field-major.
struct LensDataTable {
  std::string lens_name;
  std::string provenance;  ///< program, version, options: one line
  std::string lens_json;   ///< the prescription it was built from, native JSON; may be empty
  std::optional<double> object_distance_mm;  ///< object to vertex 1; absent = infinity
  double vertex_to_sensor_mm = 0;            ///< vertex 1 to the image surface, along the axis
  /// Real height at the stop of the rays that its rim lets through; absent where it is not known, as in
  /// tables of other programs.
  std::optional<double> stop_semi_diameter_mm;
  FirstOrder first_order;  ///< NaN: not known, as in tables of other programs

  /// Object field, from 0, increasing: degrees when the object is at infinity, mm when it is finite.
  std::vector<double> fields;
  std::vector<double> wavelengths_nm;        ///< increasing
  std::vector<double> real_image_height_mm;  ///< |height| of the real chief ray on the image surface
  std::vector<double> g_source_sr;           ///< flux per area of chief-ray image, per radiance
  std::vector<double> g_sensor_sr;           ///< irradiance of a uniform wall, per radiance
  std::vector<Psf> psf;

  bool finite_object() const { return object_distance_mm.has_value(); }
  std::size_t index(std::size_t field, std::size_t wavelength) const {
    return field * wavelengths_nm.size() + wavelength;
  }
  /// "deg" or "mm".
  const char* field_unit() const { return finite_object() ? "mm" : "deg"; }
  /// Tangent of the object angle, seen from vertex 1's plane at the object distance (finite: h / distance),
  /// of a field value.
  double field_tangent(double field) const;
  /// \throws InputError unless sizes agree, axes increase, heights increase with field, nothing is NaN or
  /// negative and no more light arrives than a hemisphere holds (π sr).
  void validate() const;
};

}  // namespace petzval
