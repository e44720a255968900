// SPDX-License-Identifier: BSD-3-Clause
// Lenses for testing: two that see 100 and 170 degrees, and one with odd aspheres. Nobody would build them;
// their pupils wander as those of real ones do.
#pragma once

#include <petzval/lens/lens.h>

#include <vector>

namespace petzval::sample {

struct Gap {
  double radius_mm, thickness_mm, index, semi_diameter_mm;
};

inline Lens lens_of(const char* name, const std::vector<Gap>& gaps, std::size_t stop, double stop_radius_mm) {
  Lens lens;
  lens.name = name;
  for (const Gap& gap : gaps) {
    Surface surface;
    surface.curvature_per_mm = gap.radius_mm == 0 ? 0 : 1 / gap.radius_mm;
    surface.thickness_mm = gap.thickness_mm;
    if (gap.index != 1) surface.material = petzval::Material(petzval::Material::Constant{gap.index});
    if (gap.semi_diameter_mm > 0) surface.semi_diameter_mm = gap.semi_diameter_mm;
    lens.surfaces.push_back(surface);
  }
  lens.surfaces[stop].stop = true;
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, stop_radius_mm};
  return lens;
}

/// Half field 50°; the front element and the rear one vignette.
inline Lens wide_100_degrees() {
  return lens_of("100 degree lens",
                 {{50, 2, 1.52, 20},
                  {16, 14, 1, 14.6},
                  {30, 5, 1.65, 11},
                  {-80, 6, 1, 10},
                  {0, 3, 1, 0},
                  {-25, 1.5, 1.75, 5},
                  {30, 4, 1.6, 6.5},
                  {-18, 0.5, 1, 8},
                  {90, 4, 1.65, 10},
                  {-30, 30, 1, 10.5}},
                 4, 2.0);
}

/// Half field 85°; the entrance pupil turns back: its v goes from 0 over −9.3 mm at 60° to −6.2 mm at 85°.
inline Lens fisheye_170_degrees() {
  return lens_of("170 degree lens",
                 {{55, 2, 1.62, 22},
                  {14, 9, 1, 13},
                  {60, 1.5, 1.62, 11},
                  {11, 12, 1, 8.3},
                  {25, 4, 1.75, 6},
                  {-60, 4, 1, 5},
                  {0, 2, 1, 0},
                  {40, 1, 1.8, 3},
                  {14, 4, 1.6, 3},
                  {-14, 22, 1, 4}},
                 6, 0.8);
}

/// A phone's camera as such lenses are: plastic, the stop behind the first element, odd aspheres up to r^11.
inline Lens phone_lens() {
  Lens lens = lens_of("phone lens",
                      {{1.9, 0.75, 1.535, 1.25},
                       {-9, 0.15, 1, 1.2},
                       {0, 0.2, 1, 0},
                       {-3.2, 0.35, 1.642, 1.25},
                       {9, 0.6, 1, 1.45},
                       {2.6, 0.9, 1.535, 2.2},
                       {3.1, 2.6, 1, 2.6}},
                      2, 0.9);
  const auto shape = [&](std::size_t i, double conic, std::map<int, double> asphere) {
    lens.surfaces[i].conic = conic;
    lens.surfaces[i].asphere = std::move(asphere);
  };
  shape(0, -0.5, {{3, 1e-3}, {4, -4e-3}, {5, 2e-3}, {6, -5e-3}, {7, -3e-3}});
  shape(1, 0, {{3, -4e-3}, {4, 1e-2}, {5, -1e-2}});
  shape(3, 0, {{3, 5e-3}, {4, -2e-2}, {6, 1e-2}, {9, -1e-3}});
  shape(4, 0, {{4, -1e-2}, {5, 4e-3}});
  shape(5, -3, {{3, -2e-2}, {4, -1e-2}, {5, 6e-3}, {7, -1e-4}});
  shape(6, -2, {{3, -1.5e-2}, {4, -8e-3}, {6, 8e-4}, {11, -1e-7}});
  return lens;
}

}  // namespace petzval::sample
