// SPDX-License-Identifier: BSD-3-Clause
// Which directions at a point of the film can possibly come from the scene.
#pragma once

#include <petzval/lens/lens.h>
#include <petzval/trace/tracer.h>

#include <optional>
#include <vector>

namespace petzval::render {

/// The directions of light at film points, by their distance from the axis. Directions are cosines (s, t) of travelling
/// light, t away from the axis and s at right angles to it, as at the point (0, +radius): s along x, t along y. Each
/// region is a fan of sectors around a middle that holds the outline of the vignetted pupil at every radius of its
/// interval, found on its boundary and not by counting rays.
class PupilRegions {
 public:
  /// \param tracers  the wavelengths whose pupils must fit in (the ends of the spectrum and one between do).
  /// \throws InputError if no light at all reaches the film, naming the lens.
  PupilRegions(const Lens& lens, const std::vector<const Tracer*>& tracers, double largest_radius_mm);

  struct Direction {
    double s = 0, t = 0;
    double area = 0;  ///< of the region, ds dt [sr]: 1/density; 0 where no light arrives
  };
  /// Even over the region.
  Direction sample(double radius_mm, double u, double v) const;
  /// The density of sample() at a direction [1/sr].
  double density(double radius_mm, double s, double t) const;

 private:
  static constexpr int sectors = 64;
  struct Region {
    double middle_s = 0, middle_t = 0, area = 0;
    std::vector<double> reach;       ///< of each sector
    std::vector<double> cumulative;  ///< areas, scaled to end at 1
  };
  using Outline = std::vector<std::pair<double, double>>;

  Region enclosing(const std::vector<Outline>& outlines) const;
  const Region& at(double radius_mm) const;

  double largest_radius_mm_;
  std::vector<Region> regions_;
};

}  // namespace petzval::render
