// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/lens/formats/number_text.h>
#include <petzval/lens/formats/pbrt.h>

#include <algorithm>

namespace petzval {

namespace {

[[noreturn]] void refuse(std::size_t surface, const std::string& why) {
  throw InputError(fmt::format("surfaces[{}]: a .dat file cannot hold {}", surface, why));
}

double single_index(const Lens& lens, std::size_t i) {
  const Material& material = lens.surfaces[i].material;
  if (material.is_air()) return 1;
  const auto* constant = std::get_if<Material::Constant>(&material.kind());
  if (!constant)
    refuse(i, fmt::format("the dispersion of {}; set surfaces[{}].glass.index first", material.description(),
                          i));
  return constant->index;
}

std::string row_text(const Lens& lens, std::size_t i) {
  const Surface& surface = lens.surfaces[i];
  const double index = single_index(lens, i), index_before = i == 0 ? 1 : single_index(lens, i - 1);
  const bool flat = surface.curvature_per_mm == 0;
  if (surface.conic != 0 || !surface.asphere.empty()) refuse(i, "conics and aspheres");
  if (!surface.semi_diameter_mm) refuse(i, "a surface without a clear aperture; set semi_diameter_mm first");
  if (surface.stop && !(flat && index == 1 && index_before == 1))
    refuse(i, "a stop that is not flat and in air");
  if (!surface.stop && flat) refuse(i, "a flat surface: radius 0 is the stop");
  if (i + 1 == lens.surfaces.size() && surface.thickness_mm == 0)
    refuse(i, "an image surface on the last vertex: thickness 0 says that it is not given");
  return fmt::format("{}\t{}\t{}\t{}\n", flat ? "0" : radius_text(surface.curvature_per_mm),
                     number_text(surface.thickness_mm), surface.stop ? "0" : fmt::format("{}", index),
                     number_text(2 * *surface.semi_diameter_mm));
}

}  // namespace

std::string pbrt_text(const Lens& lens) {
  lens.validate();
  const std::size_t stop = lens.stop_index();
  std::string rows;
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i) rows += row_text(lens, i);
  const double stop_radius_mm = *lens.surfaces[stop].semi_diameter_mm;
  if (lens.aperture.kind != Aperture::Kind::stop_semi_diameter_mm || lens.aperture.value != stop_radius_mm)
    throw InputError(
        fmt::format("aperture: a .dat file is open to the rim of its stop; set "
                    "aperture.stop_semi_diameter_mm={} first",
                    stop_radius_mm));
  if (lens.object_distance_mm)
    throw InputError("object_distance_mm: a .dat file cannot hold one; set object_distance_mm=null first");
  std::string comment = lens.name;
  std::replace_if(
      comment.begin(), comment.end(), [](unsigned char c) { return c < ' '; }, ' ');
  return fmt::format("# {}\n# radius\tthickness\tindex behind\taperture diameter [mm]\n{}", comment, rows);
}

}  // namespace petzval
