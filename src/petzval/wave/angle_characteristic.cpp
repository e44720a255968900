// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/wave/angle_characteristic.h>

#include <petzval/wave/plane_wave_kernel.h>

#include <cmath>
#include <complex>
#include <cstdlib>

namespace petzval {

namespace {

/// Every node as a wave at the first row and its turns from sample to sample.
WaveTurns turns_of(const PupilWaves& waves, int size, double spacing_mm) {
  const double k = 2 * pi * waves.image_index / (waves.wavelength_nm * mm_per_nm);
  WaveTurns turns;
  turns.resize(waves.size());
  for (std::size_t j = 0; j < waves.size(); ++j) {
    const double row_turn = k * waves.beta[j] * spacing_mm, column_turn = k * waves.alpha[j] * spacing_mm;
    const double first = 2 * pi * std::remainder(waves.phase_waves[j], 1.0) - (size / 2) * row_turn;
    turns.start_re[j] = waves.amplitude[j] * std::cos(first);
    turns.start_im[j] = waves.amplitude[j] * std::sin(first);
    turns.row_re[j] = std::cos(row_turn);
    turns.row_im[j] = std::sin(row_turn);
    turns.column_re[j] = std::cos(column_turn);
    turns.column_im[j] = std::sin(column_turn);
  }
  return turns;
}

/// |U|² on the grid. Node by node e^{ikαs} = cos + i sin, and the kernel sums real columns: the mirrored half
/// folds the cosines in two, and columns s ≥ 0 are enough; a whole pupil adds the sines, which change their
/// sign with s.
std::vector<double> intensities(const PupilWaves& waves, int size, double spacing_mm) {
  const int columns = size / 2 + 1;
  const WaveTurns turns = turns_of(waves, size, spacing_mm);
  std::vector<double> even_re, even_im, odd_re, odd_im;
  sum_wave_turns(turns, WaveColumns::cosines, size, columns, even_re, even_im);
  if (!waves.mirrored) sum_wave_turns(turns, WaveColumns::sines, size, columns, odd_re, odd_im);
  std::vector<double> result(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j) {
      const int s = j - size / 2;
      const auto at = static_cast<std::size_t>(i) * static_cast<std::size_t>(columns) +
                      static_cast<std::size_t>(std::abs(s));
      double re = even_re[at], im = even_im[at];
      if (!waves.mirrored) {  // U = (E ± i O)/2
        re = 0.5 * (re - (s < 0 ? -1 : 1) * odd_im[at]);
        im = 0.5 * (im + (s < 0 ? -1 : 1) * odd_re[at]);
      }
      result[static_cast<std::size_t>(i) * static_cast<std::size_t>(size) + static_cast<std::size_t>(j)] =
          re * re + im * im;
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
