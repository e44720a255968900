// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/lens/paraxial_system.h>
#include <petzval/lens/ray_transfer.h>
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

namespace {

/// A after B.
ParaxialMatrix product(const ParaxialMatrix& a, const ParaxialMatrix& b) {
  return {a.a * b.a + a.b * b.c, a.a * b.b + a.b * b.d, a.c * b.a + a.d * b.c, a.c * b.b + a.d * b.d};
}

/// A ray transfer stands in front of everything else, and is the stop. Its Petzval sum is not known.
void include_transfer(const RayTransfer::Paraxial& transfer, ParaxialSystem& system) {
  const ParaxialMatrix whole{transfer.a, transfer.b, transfer.c, transfer.d};
  // From the rear plane to the stop; what the slope becomes there is free, but for the determinant.
  const double h1 = transfer.h1, h2 = transfer.h2, norm = h1 * h1 + h2 * h2;
  const ParaxialMatrix to_stop{h1, h2, -h2 / norm, h1 / norm};
  system.whole = product(whole, system.whole);
  system.to_stop = product(to_stop, product(whole, system.to_stop));
  system.from_stop = product({to_stop.d, -to_stop.b, -to_stop.c, to_stop.a}, system.from_stop);
}

}  // namespace

ParaxialSystem paraxial_system(const Lens& lens, double wavelength_nm) {
  ParaxialSystem system;
  const std::size_t stop = lens.stop_index(), last = lens.surfaces.size() - 1;
  system.object_index = lens.object_material.index(wavelength_nm);
  double index_before = system.object_index, sense = 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const Surface& surface = lens.surfaces[i];
    const double index_after = surface.mirror ? index_before : surface.material.index(wavelength_nm);
    if (surface.transfer) {
      include_transfer(surface.transfer->paraxial(wavelength_nm), system);
      continue;
    }
    // Along the light: curvatures and gaps are those of the lens unfolded.
    const double curvature = sense * vertex_curvature_per_mm(surface);
    const double power = surface.ideal_lens
                             ? 1 / surface.ideal_lens->focal_length_mm
                             : (surface.mirror ? -2 * index_before : index_after - index_before) * curvature;
    if (surface.mirror) sense = -sense;
    const double gap = i == last ? 0 : sense * surface.thickness_mm / index_after;
    for (ParaxialMatrix* part : {&system.whole, i < stop ? &system.to_stop : &system.from_stop}) {
      part->refract(power);
      part->transfer(gap);
    }
    system.petzval_sum_per_mm += (surface.mirror ? -power : power) / (index_before * index_after);
    index_before = index_after;
  }
  system.image_index = index_before;
  return system;
}

}  // namespace petzval
