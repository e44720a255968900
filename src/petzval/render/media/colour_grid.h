// SPDX-License-Identifier: BSD-3-Clause
// Colours that fill a box.
#pragma once

#include <petzval/colour/sigmoid_reflectance.h>
#include <petzval/render/media/grid_samples.h>
#include <petzval/render/spectra/wavelength_groups.h>

#include <memory>

namespace petzval::render {

/// Spectra at the centres of cells, with straight lines between as GridSize::each_about() has them.
class ColourSamples {
 public:
  /// \param rgb  three numbers for each cell, none negative, which become smooth spectra (Jakob & Hanika
  /// 2019). \param white  the spectrum of 1 1 1.
  ColourSamples(const std::array<int, 3>& cells, const std::vector<double>& rgb, BandSpectrum white,
                const WavelengthGroups& groups);
  Lanes at(const UnitPlace& place, int group) const;
  /// The greatest value of a cell's spectrum at any band.
  double greatest(std::size_t cell) const;

 private:
  struct Colour {
    SigmoidReflectance shape;
    double scale = 0;
  };
  Lanes of(const Colour& colour, int group) const;

  GridSize size_;
  std::vector<Colour> colours_;
  BandSpectrum white_, wavelengths_nm_;
};

/// Absorption and scattering that each have their own colour from place to place (pbrt-v4's "rgbgrid"), per
/// scene unit.
struct ColourCoefficients {
  std::shared_ptr<const ColourSamples> absorption, scattering;  ///< null: `otherwise`
  double otherwise = 1;

  Lanes absorbed(const UnitPlace& place, int group) const {
    return absorption ? absorption->at(place, group) : Lanes::all(otherwise);
  }
  Lanes scattered(const UnitPlace& place, int group) const {
    return scattering ? scattering->at(place, group) : Lanes::all(otherwise);
  }
};

}  // namespace petzval::render
