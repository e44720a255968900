// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/formats/row_lens.h>
#include <petzval/lens/surface_shape.h>

#include <cmath>

namespace petzval {

namespace {

Surface surface_of(const LensRow& row) {
  Surface surface;
  surface.stop = row.stop;
  surface.curvature_per_mm = row.curvature_per_mm;
  surface.thickness_mm = row.thickness_mm;
  const bool air = row.index_after == 1 || (surface.stop && row.index_after == 0);
  if (!air) surface.material = Material(Material::Constant{row.index_after});
  surface.semi_diameter_mm = row.semi_diameter_mm;
  return surface;
}

/// What a lens cannot be written as.
struct RowRefusal {
  const std::string& format;

  [[noreturn]] void operator()(std::size_t surface, const std::string& why) const {
    throw InputError(fmt::format("surfaces[{}]: {} cannot hold {}", surface, format, why));
  }
};

double single_index(const Lens& lens, std::size_t i, const RowRefusal& refuse) {
  const Material& material = lens.surfaces[i].material;
  if (material.is_air()) return 1;
  const auto* constant = std::get_if<Material::Constant>(&material.kind());
  if (!constant)
    refuse(i, fmt::format("the dispersion of {}; set surfaces[{}].glass.index first", material.description(),
                          i));
  return constant->index;
}

LensRow row_of(const Lens& lens, std::size_t i, const RowRefusal& refuse) {
  const Surface& surface = lens.surfaces[i];
  if (surface.mirror) refuse(i, "a mirror");
  if (!surface.apertures.empty()) refuse(i, "apertures that are not round");
  const double index = single_index(lens, i, refuse), before = i == 0 ? 1 : single_index(lens, i - 1, refuse);
  const bool flat = surface.curvature_per_mm == 0;
  if (!is_spherical(surface)) refuse(i, "conics and aspheres");
  if (surface.blades.count != 0)
    refuse(i, "a stop of blades; set surfaces[" + std::to_string(i) + "].blades=null first");
  if (!surface.semi_diameter_mm) refuse(i, "a surface without a clear aperture; set semi_diameter_mm first");
  if (surface.stop && !(flat && index == 1 && before == 1)) refuse(i, "a stop that is not flat and in air");
  if (!surface.stop && flat) refuse(i, "a flat surface: radius 0 is the stop");
  if (i + 1 == lens.surfaces.size() && surface.thickness_mm == 0)
    refuse(i, "an image surface on the last vertex: thickness 0 says that it is not given");
  return {surface.curvature_per_mm, surface.thickness_mm, surface.stop ? 0 : index, *surface.semi_diameter_mm,
          surface.stop};
}

}  // namespace

std::vector<LensRow> rows_of_lens(const Lens& lens, const std::string& format) {
  lens.validate();
  std::vector<LensRow> rows;
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i) rows.push_back(row_of(lens, i, RowRefusal{format}));
  const double stop_radius_mm = rows[lens.stop_index()].semi_diameter_mm;
  if (lens.aperture.kind != Aperture::Kind::stop_semi_diameter_mm || lens.aperture.value != stop_radius_mm)
    throw InputError(
        fmt::format("aperture: {} is open to the rim of its stop; set "
                    "aperture.stop_semi_diameter_mm={} first",
                    format, stop_radius_mm));
  if (lens.object_distance_mm)
    throw InputError(
        fmt::format("object_distance_mm: {} cannot hold one; set object_distance_mm=null first", format));
  return rows;
}

std::string row_radius_text(const LensRow& row) {
  return row.stop ? "0" : radius_text(row.curvature_per_mm);
}

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
