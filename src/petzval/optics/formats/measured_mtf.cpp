// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/numeric/fft.h>
#include <petzval/numeric/interpolation.h>
#include <petzval/optics/formats/measured_mtf.h>

#include <algorithm>
#include <cmath>
#include <complex>

namespace petzval {

namespace {

/// Contrast below this is none.
constexpr double no_contrast = 1e-3;
/// What noise may add to a contrast of 1.
constexpr double largest_contrast = 1.02;

/// One curve of contrast, to any frequency.
class Contrast {
 public:
  Contrast(std::vector<double> frequency, std::vector<double> contrast) {
    if (frequency.front() > 0) {
      frequency.insert(frequency.begin(), 0.0);
      contrast.insert(contrast.begin(), 1.0);
    }
    last_ = frequency.back();
    end_ = contrast.back();
    const double before = contrast[contrast.size() - 2], gap = last_ - frequency[frequency.size() - 2];
    const double slope = std::max((before - end_) / gap, end_ / last_);
    decay_ = end_ > 0 ? slope / end_ : 0;
    curve_ = MonotoneCubic(std::move(frequency), std::move(contrast));
  }

  double operator()(double frequency) const {
    return frequency <= last_ ? curve_(frequency) : end_ * std::exp(-(frequency - last_) * decay_);
  }
  /// Where there is no contrast left, up to four times the last frequency.
  double end() const {
    const double further = end_ > no_contrast ? std::log(end_ / no_contrast) / decay_ : 0;
    return std::min(last_ + further, 4 * last_);
  }

 private:
  MonotoneCubic curve_;
  double last_ = 0, end_ = 0, decay_ = 0;
};

void require_good(const MeasuredMtf& mtf) {
  const std::vector<double>& f = mtf.frequency_cpmm;
  if (f.size() < 2) throw InputError("has fewer than two frequencies");
  for (std::size_t i = 0; i < f.size(); ++i) {
    if (f[i] < 0 || (i > 0 && f[i] <= f[i - 1]))
      throw InputError(fmt::format("has frequencies that do not increase from 0: {} cycles/mm", f[i]));
    for (const double contrast : {mtf.tangential[i], mtf.sagittal[i]})
      if (!(contrast >= 0 && contrast <= largest_contrast))
        throw InputError(
            fmt::format("has a contrast of {} at {} cycles/mm; 0 to 1 would be right", contrast, f[i]));
  }
}

/// Samples to a period of the highest contrast: they are squares of light, and must not blur it much.
constexpr double samples_per_period = 4;

/// Transform of a square sample along one axis, which the light of a PSF is convolved with.
double of_sample(double frequency_times_spacing) {
  const double x = pi * frequency_times_spacing;
  return x == 0 ? 1 : std::sin(x) / x;
}

/// Samples a side, so that frequencies are twice as close as the first that was measured.
int side_of(const MeasuredMtf& mtf, double end_cpmm) {
  constexpr double least = 64, most = 512;
  const double first = mtf.frequency_cpmm.front() > 0 ? mtf.frequency_cpmm.front() : mtf.frequency_cpmm[1];
  return good_fft_size(static_cast<int>(std::clamp(2 * samples_per_period * end_cpmm / first, least, most)));
}

/// The inverse transform of the model, its middle at [size/2][size/2].
std::vector<double> light_of(const Contrast& tangential, const Contrast& sagittal, int size,
                             double end_cpmm) {
  RealFft2<double> fft(size, size);
  AlignedVector<std::complex<double>> spectrum(fft.spectrum_size());
  const double step = samples_per_period * end_cpmm / size;
  for (int k = 0; k < size; ++k)
    for (int l = 0; l < fft.spectrum_columns(); ++l) {
      const double ft = (k <= size / 2 ? k : k - size) * step, fs = l * step, f = std::hypot(ft, fs);
      const double share = f > 0 ? ft * ft / (f * f) : 1;
      const double blurred = of_sample(double(l) / size) * of_sample(ft / (step * size));
      const double otf = (share * tangential(f) + (1 - share) * sagittal(f)) / blurred;
      // The alternating sign moves the origin to the middle.
      spectrum[static_cast<std::size_t>(k) * static_cast<std::size_t>(fft.spectrum_columns()) +
               static_cast<std::size_t>(l)] = (k + l) % 2 == 0 ? otf : -otf;
    }
  AlignedVector<double> image(fft.size());
  fft.inverse(spectrum, image);
  return {image.begin(), image.end()};
}

}  // namespace

double mtf_of_psf(const Psf& psf, double frequency_cpmm, bool tangential) {
  std::complex<double> sum = 0;
  const double phase = 2 * pi * frequency_cpmm * psf.spacing_um * mm_per_um;
  for (int i = 0; i < psf.size; ++i) {
    double line = 0;
    for (int j = 0; j < psf.size; ++j) line += double(tangential ? psf.at(i, j) : psf.at(j, i));
    sum += line * std::polar(1.0, -phase * (i - psf.size / 2));
  }
  return std::abs(sum) * of_sample(frequency_cpmm * psf.spacing_um * mm_per_um);
}

MtfPsf psf_of_mtf(const MeasuredMtf& mtf) {
  require_good(mtf);
  const Contrast tangential(mtf.frequency_cpmm, mtf.tangential), sagittal(mtf.frequency_cpmm, mtf.sagittal);
  const double end_cpmm = std::max(tangential.end(), sagittal.end());
  MtfPsf result;
  Psf& psf = result.psf;
  psf.size = side_of(mtf, end_cpmm);
  psf.spacing_um = um_per_mm / (samples_per_period * end_cpmm);
  std::vector<double> light = light_of(tangential, sagittal, psf.size, end_cpmm);
  double sum = 0;
  for (double& value : light) sum += value = std::max(value, 0.0);
  if (!(sum > 0)) throw InputError("has no contrast that a PSF could have");
  for (const double value : light) psf.values.push_back(static_cast<float>(value / sum));
  for (std::size_t i = 0; i < mtf.frequency_cpmm.size(); ++i)
    for (const bool along_t : {true, false}) {
      const double measured = along_t ? mtf.tangential[i] : mtf.sagittal[i];
      const double misfit = std::abs(mtf_of_psf(psf, mtf.frequency_cpmm[i], along_t) - measured);
      if (misfit <= result.worst_misfit) continue;
      result.worst_misfit = misfit;
      result.worst_frequency_cpmm = mtf.frequency_cpmm[i];
    }
  return result;
}

}  // namespace petzval
