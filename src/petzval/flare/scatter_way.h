// SPDX-License-Identifier: BSD-3-Clause
// Real rays on the ways of light that one surface of a lens scatters.
#pragma once

#include <petzval/flare/source_beam.h>
#include <petzval/flare/surface_bsdf.h>
#include <petzval/trace/losses.h>
#include <petzval/trace/surface_step.h>
#include <petzval/trace/tracer.h>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace petzval {

/// A place on a surface that a source lights, and what goes on from there unscattered.
struct LitPlace {
  std::array<double, 3> point_mm{}, after{}, normal{};  ///< `after`: the direction behind the surface
  std::array<double, 2> cosines{};                      ///< of that along the surface's own x and y
  double flux_mm2 =
      0;            ///< that meets it, over the irradiance at the first vertex; without losses by coatings
  double kept = 1;  ///< of which the surfaces in front have scattered the rest
  double cosine_before = 1, cosine_after = 1;  ///< of the unscattered light there
  ScatterShares shares;
  Ray start;
  std::vector<Intersection> path = {};  ///< up to it, if losses count
};

/// How a place lights a point of the sensor.
struct ScatterLink {
  std::array<double, 2> direction{};  ///< cosines along the surface's own x and y, behind it
  /// β − β₀ along the surface: its length, and the way in which x and y of its direction differ.
  double tau = 0;
  std::array<double, 2> offset{};
  double per_mm2 = 0;  ///< irradiance there over the BSDF and the irradiance at the first vertex
};

/// The image of a source.
struct SourceImage {
  double flux_mm2 = 0;        ///< over the irradiance at the first vertex
  double clear_flux_mm2 = 0;  ///< the same, did nothing scatter
  double x_mm = 0, y_mm = 0;  ///< its centre of light

  double scattered_share() const { return clear_flux_mm2 > 0 ? 1 - flux_mm2 / clear_flux_mm2 : 0; }
};

/// A lens at one wavelength, whose surfaces scatter. Light is scattered once: what another surface on its way
/// would scatter again is lost.
class ScatterTracer {
 public:
  /// Mirrors pass light on and do not scatter. \throws InputError for lenses whose mirrors state scatter,
  /// that have gratings, ideal lenses or ray transfers, and as Losses::validate() and SurfaceBsdf.
  ScatterTracer(const Lens& lens, double wavelength_nm, const Losses& losses,
                Tracer::Clip clip = Tracer::Clip::apertures);

  const Tracer& tracer() const { return tracer_; }
  std::size_t surface_count() const { return bsdfs_.size(); }
  const SurfaceBsdf& bsdf(std::size_t surface) const { return bsdfs_[surface]; }
  /// Whether any surface does.
  bool scatters() const;

  /// The places that a source lights on each surface that scatters, on even grids of about `across` ×
  /// `across` rays over what passes up to there. Each stands for the light of a cell. \param image  receives
  /// the source's own.
  std::vector<std::vector<LitPlace>> light(const SourceBeam& beam, int across,
                                           SourceImage* image = nullptr) const;
  /// The ray of a place to a point of the sensor, by Newton's method from `guess`, with the determinant of
  /// d²(x, y)/d²β there. Nothing where none arrives through the apertures.
  std::optional<ScatterLink> link(std::size_t surface, const LitPlace& place, double x_mm, double y_mm,
                                  const std::optional<std::array<double, 2>>& guess = {}) const;

 private:
  struct Inward;
  struct Landing;
  struct LandingSlopes;
  struct Crossing;
  bool cross(std::size_t surface, SurfaceRay& ray, Crossing& at) const;
  std::array<double, 3> behind(std::size_t surface, const std::array<double, 2>& cosines) const;
  bool inward(const Ray& start, std::size_t last, Inward& at) const;
  bool onward(std::size_t surface, const LitPlace& place, const std::array<double, 2>& direction,
              Landing& end) const;
  /// Besides, what the surfaces on the way do not scatter, and the path if losses count.
  bool onward_with_light(std::size_t surface, const LitPlace& place, const std::array<double, 2>& direction,
                         Landing& end, std::vector<Intersection>* path) const;
  template <typename Meet>
  bool follow_onward(std::size_t surface, const LitPlace& place, const std::array<double, 2>& direction,
                     Landing& end, const Meet& meet) const;
  bool differentiate(std::size_t surface, const LitPlace& place, const std::array<double, 2>& at,
                     const Landing& end, LandingSlopes& by) const;
  bool aim_onward(std::size_t surface, const LitPlace& place, double x_mm, double y_mm,
                  const std::array<double, 2>& home, std::array<double, 2>& at) const;
  std::optional<LitPlace> lit_place(const SourceBeam& beam, double x_mm, double y_mm,
                                    std::size_t surface) const;
  SourceImage image_of(const std::vector<LitPlace>& behind) const;

  Tracer tracer_;
  Tracer::Clip clip_;
  std::vector<SurfaceBsdf> bsdfs_;
  std::optional<LensTransmittance> transmittance_;
};

/// The lens with this way to scatter at every surface between two media that states none of its own.
Lens with_scatter(Lens lens, const Scatter& scatter);
/// \throws InputError naming a mirror that states scatter.
void require_clean_mirrors(const Lens& lens);
/// Whether it says anything of scatter.
bool states_scatter(const Lens& lens);

}  // namespace petzval
