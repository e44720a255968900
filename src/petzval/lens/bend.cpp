// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/bend_data.h>
#include <petzval/lens/first_order.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// Nearer to an object than a millionth of a millimetre is on it.
constexpr double nearest_vergence_per_mm = 1e6;

/// Index over distance of the object in front of a surface, by the paraxial ray from the axial object point.
double object_vergence_per_mm(const Lens& lens, std::size_t i) {
  const double lambda = lens.reference_wavelength_nm;
  const bool near = lens.object_distance_mm.has_value();
  const ParaxialRay ray = trace_paraxial(lens, near ? *lens.object_distance_mm : 1, near ? 1 : 0, lambda);
  const double slope = i > 0 ? ray.slope[i - 1] : (near ? 1 : 0);
  const double index = lens.medium_before(i).index(lambda);
  const double vergence = index * slope / ray.height_mm[i];
  return std::isnan(vergence) ? 0 : std::clamp(vergence, -nearest_vergence_per_mm, nearest_vergence_per_mm);
}

}  // namespace

std::shared_ptr<const BendData<double>> bend_data(const Lens& lens, std::size_t i, double wavelength_nm,
                                                  double index_before, double index_after) {
  const Surface& surface = lens.surfaces[i];
  if (!surface.grating && !surface.ideal_lens) return {};
  BendData<double> data;
  data.mirror = surface.mirror;
  data.index_before = index_before, data.index_after = index_after;
  if (surface.grating) {
    const Grating& grating = *surface.grating;
    const double strength = grating.order * wavelength_nm * mm_per_nm * grating.lines_per_mm;
    data.along_x = -strength * std::sin(radians(grating.rotation_deg));
    data.along_y = strength * std::cos(radians(grating.rotation_deg));
  } else {
    data.kind = BendData<double>::Kind::ideal_lens;
    data.power = 1 / surface.ideal_lens->focal_length_mm;
    data.vergence_before = object_vergence_per_mm(lens, i);
    data.vergence_after = data.power - data.vergence_before;
  }
  return std::make_shared<const BendData<double>>(data);
}

std::string bend_remark(const Surface& surface) {
  if (surface.grating)
    return fmt::format("{:g} lines/mm, order {:g}", surface.grating->lines_per_mm, surface.grating->order);
  if (surface.ideal_lens) return fmt::format("ideal lens, f {:g}", surface.ideal_lens->focal_length_mm);
  return "";
}

void require_no_bends(const Lens& lens, const char* what) {
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
    if (const std::string bend = bend_remark(lens.surfaces[i]); !bend.empty())
      throw InputError(fmt::format("{}: {} surfaces of glass, and surfaces[{}] is another ({})", lens.name,
                                   what, i, bend));
}

}  // namespace petzval
