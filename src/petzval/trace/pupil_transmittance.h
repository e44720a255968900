// SPDX-License-Identifier: BSD-3-Clause
// How much of the light a lens lets through, by film point and direction: for a camera that asks millions of
// times.
#pragma once

#include <petzval/numeric/chebyshev_surface.h>
#include <petzval/trace/exit_pupil_region.h>
#include <petzval/trace/losses.h>

#include <span>
#include <vector>

namespace petzval {

/// LensTransmittance, which changes little and smoothly over a pupil and a film, fitted for several
/// wavelengths. Method: at evenly spaced film radii a polynomial of eighth degree in the direction cosines,
/// by least squares over rays in and a little around the exit pupil; between radii linear. Of a lens that is
/// not centred the same at evenly spaced azimuths, and cubic between them (Lagrange).
class PupilTransmittance {
 public:
  static constexpr std::size_t default_radii = 33;
  /// Of a term that goes as cos φ, cubic between them leaves 2 parts in 1,000; of cos 2φ 3 in 100.
  static constexpr std::size_t posed_azimuths = 12;

  /// \param tracers  one for each wavelength of `wavelengths_nm`, or one for all. \param regions  where light
  /// arrives from; as far as its film radius. \throws InputError as LensTransmittance.
  PupilTransmittance(const Lens& lens, std::span<const Tracer> tracers,
                     std::span<const double> wavelengths_nm, const Losses& losses,
                     const ExitPupilRegions& regions, std::size_t radii = default_radii);

  /// 0…1, for light of one of the wavelengths that passes the lens and reaches a film point with direction
  /// cosines (α, β). Film radii beyond the last have its transmittance.
  double at(std::size_t wavelength, double x_mm, double y_mm, double alpha, double beta) const;

 private:
  /// [radius][wavelength]; of α across and β along the film point's meridian. Where no light arrives: those
  /// of the next radius inside.
  using Meridian = std::vector<std::vector<ChebyshevSurface>>;
  double on_meridian(std::size_t meridian, std::size_t wavelength, double radius_mm, double u,
                     double v) const;

  double step_mm_;
  std::vector<Meridian> meridians_;  ///< from +y towards +x; of a centred lens one
};

}  // namespace petzval
