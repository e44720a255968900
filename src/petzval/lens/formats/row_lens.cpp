// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/formats/row_lens.h>

#include <cmath>

namespace petzval {

namespace {

Surface surface_of(const LensRow& row) {
  Surface surface;
  surface.stop = row.radius_mm == 0;
  surface.curvature_per_mm = surface.stop ? 0 : 1 / row.radius_mm;
  surface.thickness_mm = row.thickness_mm;
  const bool air = row.index_after == 1 || (surface.stop && row.index_after == 0);
  if (!air) surface.material = Material(Material::Constant{row.index_after});
  surface.semi_diameter_mm = row.semi_diameter_mm;
  return surface;
}

}  // namespace

LensFile lens_from_rows(const std::vector<LensRow>& rows) {
  LensFile file;
  Lens& lens = file.lens;
  for (const LensRow& row : rows) lens.surfaces.push_back(surface_of(row));
  lens.wavelengths_nm = default_wavelengths_nm;
  lens.reference_wavelength_nm = default_reference_wavelength_nm;
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, rows[lens.stop_index()].semi_diameter_mm};
  lens.validate();
  double& image_distance_mm = lens.surfaces.back().thickness_mm;
  if (image_distance_mm != 0) return file;
  image_distance_mm = paraxial_image_distance_mm(lens, {}, lens.reference_wavelength_nm);
  if (!std::isfinite(image_distance_mm))
    throw InputError(
        "the file gives no image distance, and the lens has no focus to put the image at; give the last "
        "surface a thickness");
  file.notes.push_back(
      fmt::format("the file gives no image distance: the image surface is put at the paraxial focus for "
                  "infinity, {:.6g} mm behind "
                  "the last surface ({} nm)",
                  image_distance_mm, lens.reference_wavelength_nm));
  return file;
}

}  // namespace petzval
