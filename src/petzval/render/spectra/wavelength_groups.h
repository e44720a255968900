// SPDX-License-Identifier: BSD-3-Clause
// Which wavelengths travel together.
#pragma once

#include <petzval/render/spectra/lanes.h>

#include <functional>
#include <vector>

namespace petzval::render {

/// A quantity at every wavelength of a picture, [group] of lanes.
using BandSpectrum = std::vector<Lanes>;

/// Over all lanes, the repeated ones too: a weight for choosing by, no measured quantity.
double mean_of(const BandSpectrum& spectrum);

/// The bands of a picture dealt out into groups of up to eight, each spread over the whole range: group g of
/// G holds bands g, g + G, g + 2G, … Every band belongs to one group; a lane without a band repeats the
/// group's first wavelength and is never read.
class WavelengthGroups {
 public:
  /// \throws InputError unless the wavelengths are finite, positive and strictly increasing.
  explicit WavelengthGroups(std::vector<double> wavelengths_nm);

  const std::vector<double>& wavelengths_nm() const { return wavelengths_nm_; }
  int count() const { return count_; }
  /// Lanes of a group that have a band: the first so many.
  int lanes(int group) const { return lanes_[static_cast<std::size_t>(group)]; }
  /// −1 for a lane without one.
  int band(int group, int lane) const { return lane < lanes(group) ? group + lane * count_ : -1; }
  double wavelength_nm(int group, int lane) const;

  /// `value` at every wavelength.
  BandSpectrum sampled(const std::function<double(double wavelength_nm)>& value) const;

 private:
  std::vector<double> wavelengths_nm_;
  int count_;
  std::vector<int> lanes_;  ///< [group]
};

}  // namespace petzval::render
