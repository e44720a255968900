// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/lens/paraxial_system.h>
#include <petzval/lens/surface_shape.h>

namespace petzval {

void ParaxialMatrix::refract(double power_per_mm) {
  c -= power_per_mm * a;
  d -= power_per_mm * b;
}

void ParaxialMatrix::transfer(double reduced_distance_mm) {
  a += reduced_distance_mm * c;
  b += reduced_distance_mm * d;
}

ParaxialSystem paraxial_system(const Lens& lens, double wavelength_nm) {
  ParaxialSystem system;
  const std::size_t stop = lens.stop_index(), last = lens.surfaces.size() - 1;
  double index_before = 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const Surface& surface = lens.surfaces[i];
    const double index_after = surface.material.index(wavelength_nm);
    const double power = (index_after - index_before) * vertex_curvature_per_mm(surface);
    const double gap = i == last ? 0 : surface.thickness_mm / index_after;
    for (ParaxialMatrix* part : {&system.whole, i < stop ? &system.to_stop : &system.from_stop}) {
      part->refract(power);
      part->transfer(gap);
    }
    system.petzval_sum_per_mm += power / (index_before * index_after);
    index_before = index_after;
  }
  system.image_index = index_before;
  return system;
}

}  // namespace petzval
