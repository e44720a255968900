// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/numeric/nonuniform_fft.h>
#include <petzval/wave/angle_characteristic.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>

namespace petzval {

namespace {

/// What a sum of waves may hold at once [bytes]; more passes take the same time.
constexpr std::size_t most_bytes = std::size_t{1} << 28;

/// Nodes as masses at −α and −β in units of a turn from one sample to the next; real parts and imaginary
/// ones.
struct WaveMasses {
  PointMasses real, imaginary;

  WaveMasses(const PupilWaves& waves, double spacing_mm) {
    const double turns = spacing_mm * waves.image_index / (waves.wavelength_nm * mm_per_nm);
    const std::size_t count = waves.size() * (waves.mirrored ? 2 : 1);
    real.reserve(count), imaginary.reserve(count);
    for (std::size_t j = 0; j < waves.size(); ++j) {
      const double phase = 2 * pi * std::remainder(waves.phase_waves[j], 1.0);
      add(-turns * waves.alpha[j], -turns * waves.beta[j], std::polar(waves.amplitude[j], phase));
      if (waves.mirrored)
        add(turns * waves.alpha[j], -turns * waves.beta[j], std::polar(waves.amplitude[j], phase));
    }
  }

 private:
  void add(double x, double y, std::complex<double> amplitude) {
    real.add(x, y, amplitude.real());
    imaginary.add(x, y, amplitude.imag());
  }
};

/// |U|² on the grid. Both transforms have one half of the plane, and the other by conjugation.
std::vector<double> intensities(const PupilWaves& waves, int size, double spacing_mm) {
  const int half = size / 2, rows = 2 * half + 1;
  const WaveMasses masses(waves, spacing_mm);
  const NonuniformFft2 fft(half, half);
  const auto place = [&](int k, std::size_t l) {
    return static_cast<std::size_t>(k) * static_cast<std::size_t>(rows) + l;
  };
  std::vector<std::complex<double>> real(place(half + 1, 0)), imaginary(real.size());
  const auto keep = [&](std::vector<std::complex<double>>& into) {
    return [&](int k, std::span<const std::complex<double>> values) {
      std::ranges::copy(values, into.begin() + static_cast<std::ptrdiff_t>(place(k, 0)));
    };
  };
  fft.transform(masses.real, rows, most_bytes, keep(real));
  fft.transform(masses.imaginary, rows, most_bytes, keep(imaginary));
  std::vector<double> result(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j) {
      const int s = j - half, t = i - half;
      const std::size_t at = place(std::abs(s), static_cast<std::size_t>((s < 0 ? -t : t) + half));
      const std::complex<double> a = s < 0 ? std::conj(real[at]) : real[at],
                                 b = s < 0 ? std::conj(imaginary[at]) : imaginary[at];
      result[static_cast<std::size_t>(i) * static_cast<std::size_t>(size) + static_cast<std::size_t>(j)] =
          std::norm(a + std::complex<double>(0, 1) * b);
    }
  return result;
}

}  // namespace

Psf sum_plane_waves(const PupilWaves& waves, int size, double spacing_um) {
  if (size < 1 || !(spacing_um > 0))
    throw InputError("a PSF needs at least one sample and a positive spacing");
  const std::vector<double> intensity = intensities(waves, size, spacing_um * mm_per_um);
  double sum = 0;
  for (const double value : intensity) sum += value;

  Psf psf;
  psf.size = size;
  psf.spacing_um = spacing_um;
  const double lambda_mm = waves.wavelength_nm * mm_per_nm / waves.image_index;
  const double spacing_mm = spacing_um * mm_per_um;
  psf.captured = sum * spacing_mm * spacing_mm / (lambda_mm * lambda_mm * waves.flux);
  for (const double value : intensity) psf.values.push_back(static_cast<float>(value / sum));
  return psf;
}

}  // namespace petzval
