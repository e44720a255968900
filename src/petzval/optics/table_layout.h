// SPDX-License-Identifier: BSD-3-Clause
// Names of the lens data table's file, shared by its writer and its reader (table_file.h).
#pragma once

#include <petzval/lens/first_order.h>

namespace petzval::table_layout {

inline constexpr char format[] = "petzval-optics/1";        ///< places by field height
inline constexpr char frame_format[] = "petzval-optics/2";  ///< places over the frame

inline constexpr char field[] = "object_field";
inline constexpr char place[] = "place";
inline constexpr char image_x[] = "image_x";
inline constexpr char image_y[] = "image_y";
inline constexpr char object_x[] = "object_x";
inline constexpr char object_y[] = "object_y";
inline constexpr char psf_azimuth[] = "psf_azimuth";
inline constexpr char wavelength[] = "wavelength";
inline constexpr char height[] = "real_image_height";
inline constexpr char g_source[] = "g_source";
inline constexpr char g_sensor[] = "g_sensor";
inline constexpr char psf[] = "psf";
inline constexpr char psf_size[] = "psf_size";
inline constexpr char psf_spacing[] = "psf_spacing";
inline constexpr char psf_captured[] = "psf_captured";
inline constexpr char first_order[] = "first_order";

/// Calls visit(name, number) for each paraxial number, with a reference to it.
template <typename FirstOrderOrConst, typename Visit>
void for_each_first_order(FirstOrderOrConst& data, const Visit& visit) {
  visit("wavelength_nm", data.wavelength_nm);
  visit("efl_mm", data.efl_mm);
  visit("bfl_mm", data.bfl_mm);
  visit("ffl_mm", data.ffl_mm);
  visit("f_number", data.f_number);
  visit("working_f_number", data.working_f_number);
  visit("image_space_na", data.image_space_na);
  visit("field_of_view_deg", data.field_of_view_deg);
  visit("magnification", data.magnification);
  visit("entrance_pupil_position_mm", data.entrance_pupil.position_mm);
  visit("entrance_pupil_diameter_mm", data.entrance_pupil.diameter_mm);
  visit("exit_pupil_position_mm", data.exit_pupil.position_mm);
  visit("exit_pupil_diameter_mm", data.exit_pupil.diameter_mm);
  visit("petzval_radius_mm", data.petzval_radius_mm);
  visit("total_track_mm", data.total_track_mm);
  visit("paraxial_image_mm", data.paraxial_image_mm);
  visit("paraxial_stop_semi_diameter_mm", data.stop_semi_diameter_mm);
  visit("lagrange_invariant_mm", data.lagrange_invariant_mm);
}

}  // namespace petzval::table_layout
