// SPDX-License-Identifier: BSD-3-Clause
// From which directions light reaches a point of the film: what a camera that sends rays backwards samples.
#pragma once

#include <petzval/trace/pupil_density_lanes.h>
#include <petzval/trace/tracer.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace petzval {

/// For every film point a region of direction cosines (α, β) that holds all the light which the lens lets
/// through to it, and little more: a star-shaped outline about a centre that moves with the film radius.
/// Light with cosines (α, β) arrives from where the backward ray (−α, −β, −√(1 − α² − β²)) goes. Since E = ∬
/// L dα dβ, a sample drawn evenly from the region carries its area as weight, and nothing else:
///
///     const ExitPupilRegions regions(tracers, 21.6);
///     if (const auto sample = regions.sample(x_mm, y_mm, random1, random2))
///       irradiance += sample->area_sr * radiance_along(sample->alpha, sample->beta);  // 0 where it is
///       clipped
///
/// Method: float SIMD rays backwards from film points on a grid of directions, zoomed onto those that pass
/// (bounds of the exit pupil by film radius: M. Pharr, W. Jakob and G. Humphreys, Physically Based Rendering,
/// 2016, 6.4.5; there boxes on the rear element). Parts of a pupil that lie apart or leave a hole are all
/// inside the outline. A lens with poses has regions that hold the light of all film points at one radius.
class ExitPupilRegions {
 public:
  struct Sample {
    double alpha, beta;  ///< direction cosines of the light, along x and y
    double area_sr;      ///< ∬ dα dβ of the region: 1/probability density
  };

  static constexpr std::size_t default_radii = 64;

  /// \param tracers         one a wavelength, with one image plane; the regions hold the light of all of
  /// them. \param film_radius_mm  to the farthest film point [mm]. \param radii           film radii that are
  /// traced, evenly from 0 to film_radius_mm. \throws InputError for no tracer, a film radius that is not
  /// positive, or fewer than 2 or more than 100 000
  ///         radii.
  ExitPupilRegions(std::span<const Tracer> tracers, double film_radius_mm, std::size_t radii = default_radii);

  /// The direction for two numbers in [0, 1), evenly over the region; neighbours stay neighbours. Nothing
  /// where no light arrives. Film radii beyond the last have the region of the last.
  std::optional<Sample> sample(double x_mm, double y_mm, double random_1, double random_2) const;

  /// Area of the region of a film point [sr]; 0 where no light arrives.
  double area_sr(double x_mm, double y_mm) const;
  /// Probability density of sample(), 1/area inside the region and 0 outside [1/sr].
  double density_per_sr(double x_mm, double y_mm, double alpha, double beta) const;
  /// The same for many, in SIMD lanes and single precision, for light that lies inside by more than a float's
  /// rounding, as all does that passes the lens. \param per_sr  as many as directions.
  void densities_per_sr(const PupilDirections& directions, float* per_sr) const {
    pupil_densities(densities_, directions, per_sr);
  }

  double film_radius_mm() const { return film_radius_mm_; }

 private:
  static constexpr std::size_t sectors = PupilDensityTable::sectors;
  /// What lies between two neighbouring film radii; film point on +y, so that v is along it and u across.
  struct Zone {
    double centre_v = 0, centre_v_per_mm = 0;  ///< at the zone's middle, and how it moves
    double scale_u = 0, scale_v = 0;           ///< sectors are those of (u/scale_u, v/scale_v)
    std::array<double, sectors> radius{};
    std::array<double, sectors + 1> share{};    ///< of the area, up to each sector
    std::array<std::uint8_t, sectors> first{};  ///< sector in which each 1/sectors of the area begins
    double area_sr = 0;
  };
  struct Place;
  struct Probe;

  static Zone zone_between(const Probe& inner, const Probe& outer, double step_mm);
  static PupilDensityTable::Row density_row(const Zone& zone);
  static void find_bends(std::vector<Probe>& probes);
  const Zone& zone_at(double radius_mm) const;
  Place place(double x_mm, double y_mm) const;

  double film_radius_mm_;
  std::vector<Zone> zones_;
  PupilDensityTable densities_;
};

/// The radius of the circle on the film that light comes to, at one azimuth at least: to one part in a
/// hundred of `film_radius_mm`, at which the search begins. 0 where none comes.
double lit_radius_mm(const Tracer& tracer, double film_radius_mm);

}  // namespace petzval
