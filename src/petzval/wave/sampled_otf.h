// SPDX-License-Identifier: BSD-3-Clause
// The transfer function of a PSF that is known by its samples, as that of a real lens at a field point.
#pragma once

#include <petzval/wave/otf.h>
#include <petzval/wave/psf.h>

#include <vector>

namespace petzval {

/// With the field along +y' of image space (Psf): the picture's x runs against s and its y along t. Between
/// the samples' own frequencies by zero padding and cubics. The light that fell outside the window is given
/// the 1/r³ tail of a sharp-edged pupil, as an exp(−2πa|f|) with a the radius of the circle of the window's
/// area.
class SampledOtf : public Otf {
 public:
  /// \throws InputError for a PSF of fewer than 8 × 8 samples, of samples that do not fill it, or without
  /// light.
  explicit SampledOtf(const Psf& psf);

  double cutoff_cpmm() const override { return cutoff_cpmm_; }
  void evaluate(double fx_cpmm, std::span<const double> fy_cpmm,
                std::span<std::complex<double>> values) const override;
  PsfTail tail() const override;
  double reach_um() const override { return radius_um_; }

 private:
  std::complex<double> table_at(int k, int l) const;
  std::complex<double> within(double fs_cpmm, double ft_cpmm) const;

  int size_ = 0;  ///< of the padded transform
  double step_cpmm_ = 0, cutoff_cpmm_ = 0, captured_ = 1, radius_um_ = 0;
  std::vector<std::complex<double>> table_;  ///< [t frequency][s frequency ≥ 0]
};

}  // namespace petzval
