// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/otf_interpolation.h>
#include <petzval/numeric/fft.h>

#include <cmath>

namespace petzval {

namespace {

using Image = AlignedVector<double>;
using OtfSamples = AlignedVector<std::complex<double>>;

/// Where cell (row, column) of a kernel lies in a cyclic square with the middle cell at index 0.
std::size_t cyclic_index(int row, int column, int radius, int square) {
  const int i = (row - radius + square) % square, j = (column - radius + square) % square;
  return static_cast<std::size_t>(i) * static_cast<std::size_t>(square) + static_cast<std::size_t>(j);
}

OtfSamples otf(const Kernel& kernel, const RealFft2<double>& fft) {
  Image image(fft.size());
  OtfSamples spectrum(fft.spectrum_size());
  for (int row = 0; row < kernel.size(); ++row)
    for (int column = 0; column < kernel.size(); ++column)
      image[cyclic_index(row, column, kernel.radius, fft.columns())] =
          kernel.weights[static_cast<std::size_t>(row * kernel.size() + column)];
  fft.forward(image, spectrum);
  return spectrum;
}

}  // namespace

Kernel between_otfs(const Kernel& low, const Kernel& high, double weight_high) {
  const int square = good_fft_size(2 * low.size());  // room for what interpolation spreads
  const RealFft2<double> fft(square, square);
  OtfSamples spectrum = otf(low, fft);
  const OtfSamples other = otf(high, fft);
  for (std::size_t k = 0; k < spectrum.size(); ++k) {
    const double modulus = (1 - weight_high) * std::abs(spectrum[k]) + weight_high * std::abs(other[k]);
    const double turn = std::arg(other[k] * std::conj(spectrum[k]));
    spectrum[k] = std::polar(modulus, std::arg(spectrum[k]) + weight_high * turn);
  }
  Image image(fft.size());
  fft.inverse(spectrum, image);

  Kernel result = low;
  for (int row = 0; row < result.size(); ++row)
    for (int column = 0; column < result.size(); ++column)
      result.weights[static_cast<std::size_t>(row * result.size() + column)] =
          image[cyclic_index(row, column, result.radius, square)] / double(fft.size());
  return result;
}

}  // namespace petzval
