// SPDX-License-Identifier: BSD-3-Clause
// The light that a medium itself sends out: flames, plasma, glowing gas.
#pragma once

#include <petzval/render/media/colour_grid.h>

#include <memory>

namespace petzval::render {

/// How hot a medium is from place to place, and what it shines with there: the spectrum of a black body whose
/// strongest wavelength has radiance 1, nothing up to 100 K (pbrt-v4).
class Temperatures {
 public:
  /// \param samples  to become (sample − offset) · scale [K] between them.
  Temperatures(GridSamples samples, double offset, double scale, const WavelengthGroups& groups);
  Lanes radiance(const UnitPlace& place, int group) const;

 private:
  GridSamples samples_;
  double offset_, scale_;
  BandSpectrum exponents_;  ///< hc/(λk) [K]
};

/// A medium shines with its absorption times this radiance in each unit of length, so that a thick one has
/// the radiance (Kirchhoff's law for a black body seen through its own substance).
struct Emission {
  BandSpectrum radiance;  ///< [group]; W·m⁻²·sr⁻¹·nm⁻¹
  std::shared_ptr<const Temperatures>
      temperatures;                              ///< that give it a spectrum of its own; null: 1 everywhere
  std::shared_ptr<const ColourSamples> colours;  ///< the same
  std::shared_ptr<const GridSamples> strength;   ///< that all is times; null: 1 everywhere
  int source = -1;                               ///< the light of the scene that this is

  Lanes at(const UnitPlace& place, int group) const;
};

}  // namespace petzval::render
