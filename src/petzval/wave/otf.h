// SPDX-License-Identifier: BSD-3-Clause
// The optical transfer function of an image-forming system, as the exact renderer takes it.
#pragma once

#include <petzval/wave/radial_pupil.h>

#include <complex>
#include <memory>
#include <span>
#include <vector>

namespace petzval {

/// Mean of a PSF over direction and over its own ripple, far away: share of light per µm² → k3/r³ + k5/r⁵.
struct PsfTail {
  double k3_um = 0, k5_um3 = 0;
  /// From this distance on, at the least, what the PSF has beyond these terms (spikes, further powers) may be
  /// left out; 0: as soon as the PSF's reach is passed.
  double settled_um = 0;
};

/// OTF(f) = ∬ PSF(x) exp(−2πi f·x) d²x, with the PSF's integral 1; x to the right and y down in the stored
/// picture, frequencies in cycles/mm on the sensor.
class Otf {
 public:
  virtual ~Otf() = default;

  /// Zero (below 1e-13) at any frequency beyond.
  virtual double cutoff_cpmm() const = 0;
  /// values[i] = OTF(fx, fy[i]).
  virtual void evaluate(double fx_cpmm, std::span<const double> fy_cpmm,
                        std::span<std::complex<double>> values) const = 0;
  virtual PsfTail tail() const { return {}; }
  /// Beyond a few of these from its centre the PSF is the tail.
  virtual double reach_um() const = 0;

  std::complex<double> at(double fx_cpmm, double fy_cpmm) const;
};

/// An OTF that depends on |f| alone, by table.
class RadialOtf : public Otf {
 public:
  /// `table`: values at 0, cutoff/(size − 1), … cutoff, at least four. \throws InputError.
  RadialOtf(std::vector<double> table, double cutoff_cpmm, PsfTail tail, double reach_um);

  double cutoff_cpmm() const override { return cutoff_cpmm_; }
  void evaluate(double fx_cpmm, std::span<const double> fy_cpmm,
                std::span<std::complex<double>> values) const override;
  PsfTail tail() const override { return tail_; }
  double reach_um() const override { return reach_um_; }
  double operator()(double frequency_cpmm) const;

 private:
  std::vector<double> table_;
  double cutoff_cpmm_;
  PsfTail tail_;
  double reach_um_;
};

/// Of a pupil at a wavelength and a (working) f-number; the cut-off is 1/(λN).
/// \throws InputError unless both are positive and finite, and as RadialPupil::validate.
std::unique_ptr<RadialOtf> radial_pupil_otf(const RadialPupil& pupil, double wavelength_nm, double f_number);

/// Of a Gaussian PSF, standard deviation along each axis. \throws InputError unless sigma is positive.
std::unique_ptr<RadialOtf> gaussian_otf(double sigma_um);

/// Several wavelengths together: Σ weight · OTF / Σ weight.
class MixedOtf : public Otf {
 public:
  struct Part {
    double weight;
    std::shared_ptr<const Otf> otf;
  };
  /// \throws InputError without parts, or unless weights are finite, not negative and not all zero.
  explicit MixedOtf(std::vector<Part> parts);

  double cutoff_cpmm() const override;
  void evaluate(double fx_cpmm, std::span<const double> fy_cpmm,
                std::span<std::complex<double>> values) const override;
  PsfTail tail() const override;
  double reach_um() const override;

 private:
  std::vector<Part> parts_;  ///< weights sum to 1
};

}  // namespace petzval
