// SPDX-License-Identifier: BSD-3-Clause
// PSFs seen through the window of a kernel, to be taken at any place.
#pragma once

#include <petzval/imaging/psf_deposit.h>

#include <array>
#include <span>
#include <vector>

namespace petzval {

/// The window through which a kernel sees the light: a Gaussian with this standard deviation [cells]. It is
/// round, so that a PSF may be seen through it once and then be turned to any azimuth; and it leaves so
/// little at the cells' own frequency (2·10⁻⁴) that a kernel is samples of a smooth function, with its sum,
/// centroid and spread wherever the cells lie. What it takes off below, the pixel filter gives back
/// (PixelTaps).
inline constexpr double window_cells = 0.65;
/// What the window leaves of a frequency [cycles a cell].
double window_transform(double frequency);
/// How far light is followed beyond the PSF [cells]: 4.6 standard deviations.
inline constexpr int window_reach = 3;

/// A PSF ⊛ window as a cubic B-spline on a square lattice: smooth, and taken at any place by 16 products.
///
/// The light of the lattice's samples has a spread of its own, of what laid it down; the window is made
/// narrower by as much, along either axis, so that the moments are those wanted.
class SmoothPsf {
 public:
  /// \param samples  of the PSF, with the tangential direction along the rows' growing numbers (deposit()
  /// along (0, 1)); not of sum 0. \param spacing_cells  of the lattice. \param wanted  moments of the PSF in
  /// that orientation [cells], without the window.
  SmoothPsf(const Kernel& samples, double spacing_cells, const Moments& wanted);

  /// Coefficients on either side of the middle one.
  int half() const { return half_; }
  const std::vector<float>& coefficients() const { return coefficients_; }
  /// With the window [cells]: those wanted, but for light that is spread so much more that no window helps.
  const Moments& moments() const { return moments_; }

 private:
  int half_;
  Moments moments_;
  std::vector<float> coefficients_;  ///< row-major, of unit sum before the kernel's normalisation
};

/// What one PSF contributes to a mixture.
struct WeightedPsf {
  const SmoothPsf* psf;
  double weight;
};

/// The mixture at the cells of a kernel, the tangential direction along `direction` (x', y') of image space.
/// \param wanted  moments of the PSF [cells], without the window: the mixture is moved and stretched along
/// both axes by the little that its own differ. Where the spread of light grows ever faster with height, a
/// wall would show what mixtures of a few PSFs make of it.
void sample_mixture(std::span<const WeightedPsf> psfs, double spacing_cells, const Moments& wanted,
                    const std::array<double, 2>& direction, Kernel& kernel);

}  // namespace petzval
