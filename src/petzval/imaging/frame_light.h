// SPDX-License-Identifier: BSD-3-Clause
// What a lens data table over the frame says at one wavelength, between its places.
#pragma once

#include <petzval/imaging/light_centre.h>
#include <petzval/numeric/lattice_spline.h>
#include <petzval/optics/lens_data_table.h>

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace petzval {

/// Values of a table over the frame at one wavelength, [place]: linear between its wavelengths.
std::vector<double> frame_values(const LensDataTable& table, const std::vector<double>& values,
                                 double wavelength_nm);

/// The way from where light has its centre to the chief ray that it belongs to, over the frame: the place x
/// for which x + c(x) is the place asked for, c the offsets of LightCentres as splines.
class FrameCentres {
 public:
  FrameCentres(const LensDataTable& table, const LightCentres& centres, double wavelength_nm);

  std::array<double, 2> chief_mm(double x_mm, double y_mm) const;
  /// Area about the centres per area about the chief rays, at a chief ray's place.
  double stretch(double x_mm, double y_mm) const;

 private:
  bool none_ = true;
  LatticeSpline x_, y_;  ///< the parts of c [mm]
};

/// Where light whose centre lies at a knot of the lattice comes from, and how much of it: a spline's values.
struct FrameLight {
  std::vector<double> object_x, object_y;  ///< as FramePlaces has them
  std::vector<double> g_source_sr;         ///< flux per area about the centres of light
  std::vector<char> dark;                  ///< no light arrives at that place of the table

  FrameLight(const LensDataTable& table, const LightCentres& centres, double wavelength_nm);
};

/// Makes the meshes of a spline about dark knots bilinear.
void flatten_about_darkness(const std::vector<char>& dark, LatticeSpline& spline);

}  // namespace petzval
