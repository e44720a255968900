// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/lens/lens.h>
#include <petzval/lens/lens_fault.h>

#include <algorithm>

namespace petzval {

Surface Surface::sphere(double radius_mm, double thickness_mm, const Material& behind,
                        std::optional<double> semi_diameter_mm) {
  Surface surface;
  surface.curvature_per_mm = 1 / radius_mm;
  surface.thickness_mm = thickness_mm;
  surface.material = behind;
  surface.semi_diameter_mm = semi_diameter_mm;
  return surface;
}

std::size_t Lens::stop_index() const {
  const auto stop = std::find_if(surfaces.begin(), surfaces.end(), [](const Surface& s) { return s.stop; });
  if (stop == surfaces.end()) throw InputError("the lens has no stop; mark one surface with \"stop\": true");
  return static_cast<std::size_t>(stop - surfaces.begin());
}

double Lens::total_track_mm() const {
  double track = 0, sense = 1;
  for (const Surface& surface : surfaces) {
    if (surface.mirror) sense = -sense;
    track += sense * surface.thickness_mm;
  }
  return track;
}

const Material& Lens::medium_behind(std::size_t surface) const {
  while (surfaces[surface].mirror)
    if (surface-- == 0) return object_material;
  return surfaces[surface].material;
}

double Lens::sense_behind(std::size_t surface) const {
  double sense = 1;
  for (std::size_t i = 0; i <= surface; ++i)
    if (surfaces[i].mirror) sense = -sense;
  return sense;
}

bool Lens::has_mirrors() const {
  return std::any_of(surfaces.begin(), surfaces.end(), [](const Surface& s) { return s.mirror; });
}

void require_no_mirrors(const Lens& lens, const char* what) {
  const auto mirror =
      std::find_if(lens.surfaces.begin(), lens.surfaces.end(), [](const Surface& s) { return s.mirror; });
  if (mirror == lens.surfaces.end()) return;
  throw InputError(
      fmt::format("{}: surfaces[{}] is a mirror, and {}", lens.name, mirror - lens.surfaces.begin(), what));
}

void Lens::validate() const {
  if (const auto fault = find_fault(*this)) throw InputError(fault->path + " " + fault->message);
}

}  // namespace petzval
