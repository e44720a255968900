// SPDX-License-Identifier: BSD-3-Clause
// Two lenses for testing that see 100 and 170 degrees. Nobody would build them; their pupils wander as those
// of real ones do.
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
    if (gap.index != 1) surface.material = Material(Material::Constant{gap.index});
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

}  // namespace petzval::sample
