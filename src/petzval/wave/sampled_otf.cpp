// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/numeric/fft.h>
#include <petzval/wave/sampled_otf.h>

#include <algorithm>
#include <cmath>

namespace petzval {

SampledOtf::SampledOtf(const Psf& psf) {
  constexpr int least = 8, largest = 1024, padding = 8;
  const auto size = static_cast<std::size_t>(std::max(psf.size, 0));
  if (psf.size < least || psf.size > largest || psf.values.size() != size * size || !(psf.spacing_um > 0))
    throw InputError(
        fmt::format("a PSF of {} x {} samples at {} um: from {} to {} a side at a positive spacing are right",
                    psf.size, psf.size, psf.spacing_um, least, largest));
  size_ = good_fft_size(padding * psf.size);
  const RealFft2<double> fft(size_, size_);
  AlignedVector<double> image(fft.size());
  AlignedVector<std::complex<double>> spectrum(fft.spectrum_size());
  double sum = 0;
  // The chief ray's sample at the origin; what lies before it wraps to the end.
  const auto wrapped = [&](int i) { return static_cast<std::size_t>((i - psf.size / 2 + size_) % size_); };
  for (int i = 0; i < psf.size; ++i)
    for (int j = 0; j < psf.size; ++j) {
      image[wrapped(i) * static_cast<std::size_t>(size_) + wrapped(j)] = psf.at(i, j);
      sum += psf.at(i, j);
    }
  if (!(sum > 0)) throw InputError("a PSF without light");
  fft.forward(image, spectrum);
  table_.assign(spectrum.begin(), spectrum.end());
  for (std::complex<double>& value : table_) value /= sum;
  step_cpmm_ = 1e3 / (size_ * psf.spacing_um);
  // Two steps short of the samples' own Nyquist frequency, for the cubics.
  cutoff_cpmm_ = step_cpmm_ * (size_ / 2 - 2);
  captured_ = std::clamp(psf.captured, 0.0, 1.0);
  radius_um_ = 2 * psf.half_width_um() / std::sqrt(pi);
}

PsfTail SampledOtf::tail() const {
  return {(1 - captured_) * radius_um_ / (2 * pi), 0, 0};
}

std::complex<double> SampledOtf::table_at(int k, int l) const {
  if (k < 0) return std::conj(table_at(-k, -l));
  const auto row = static_cast<std::size_t>((l % size_ + size_) % size_);
  return table_[row * (static_cast<std::size_t>(size_) / 2 + 1) + static_cast<std::size_t>(k)];
}

std::complex<double> SampledOtf::within(double fs_cpmm, double ft_cpmm) const {
  const double u = fs_cpmm / step_cpmm_, v = ft_cpmm / step_cpmm_;
  const int k = static_cast<int>(std::floor(u)) - 1, l = static_cast<int>(std::floor(v)) - 1;
  const auto weights = [](double t, double* w) {
    const double a = t, b = t - 1, c = t - 2, d = t - 3;
    w[0] = -b * c * d / 6, w[1] = a * c * d / 2, w[2] = -a * b * d / 2, w[3] = a * b * c / 6;
  };
  double along[4], across[4];
  weights(u - k, along);
  weights(v - l, across);
  std::complex<double> sum = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) sum += across[i] * along[j] * table_at(k + j, l + i);
  return sum;
}

void SampledOtf::evaluate(double fx_cpmm, std::span<const double> fy_cpmm,
                          std::span<std::complex<double>> values) const {
  for (std::size_t i = 0; i < fy_cpmm.size(); ++i) {
    const double f = std::hypot(fx_cpmm, fy_cpmm[i]);
    values[i] = f > cutoff_cpmm_ ? 0
                                 : captured_ * within(-fx_cpmm, fy_cpmm[i]) +
                                       (1 - captured_) * std::exp(-2 * pi * radius_um_ * 1e-3 * f);
  }
}

}  // namespace petzval
