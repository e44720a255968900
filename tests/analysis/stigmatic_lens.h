// SPDX-License-Identifier: BSD-3-Clause
// A lens without aberration on its axis.
#pragma once

#include <petzval/lens/lens.h>

namespace petzval {

/// A plano-hyperbolic lens: free of aberration on the axis (k = −n²), f = 40 mm, stop on its flat front.
inline Lens stigmatic_lens(double semi_aperture_mm) {
  Lens lens;
  lens.name = "plano-hyperbolic lens";
  Surface front, back;
  front.thickness_mm = 2;
  front.material = Material(Material::Constant{1.5});
  front.stop = true;
  back.curvature_per_mm = -1.0 / 20;
  back.conic = -2.25;
  back.thickness_mm = 40;
  lens.surfaces = {front, back};
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, semi_aperture_mm};
  lens.wavelengths_nm = {550};
  lens.reference_wavelength_nm = 550;
  return lens;
}

}  // namespace petzval
