// SPDX-License-Identifier: BSD-3-Clause
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
  double track = 0;
  for (const Surface& surface : surfaces) track += surface.thickness_mm;
  return track;
}

void Lens::validate() const {
  if (const auto fault = find_fault(*this)) throw InputError(fault->path + " " + fault->message);
}

}  // namespace petzval
