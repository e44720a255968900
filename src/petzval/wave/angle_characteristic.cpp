// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/wave/angle_characteristic.h>

#include <Eigen/Dense>
#include <cmath>
#include <complex>

namespace petzval {

namespace {

using Complex = std::complex<double>;
using ComplexMatrix = Eigen::Matrix<Complex, Eigen::Dynamic, Eigen::Dynamic>;

/// Nodes a block: the matrices of one block stay in the second-level cache.
constexpr Eigen::Index block_nodes = 256;

/// Steps between fresh sines in a recurrence of rotations: keeps the error at 1e-15.
constexpr int recurrence_length = 64;

/// Calls put(i, e^{iθ_i}) for θ_i = first + i·step.
template <class Put>
void rotations(double first, double step, int count, Put&& put) {
  const Complex turn = std::polar(1.0, step);
  Complex value;
  for (int i = 0; i < count; ++i) {
    value = i % recurrence_length == 0 ? std::polar(1.0, first + i * step) : value * turn;
    put(i, value);
  }
}

/// The field on rows t (all) and columns s ≥ 0: [row][column].
ComplexMatrix half_field(const PupilWaves& waves, int size, double spacing_mm) {
  const int columns = size / 2 + 1;
  const double k = 2 * pi * waves.image_index / (waves.wavelength_nm * mm_per_nm);
  // U = tangential · sagittal: with the mirror half folded in, the sagittal factor is 2 cos(k α s), real, so
  // that the complex product is two real ones.
  Eigen::MatrixXd real = Eigen::MatrixXd::Zero(size, columns), imaginary = real;
  Eigen::MatrixXd tangential_re(size, block_nodes), tangential_im(size, block_nodes),
      sagittal(block_nodes, columns);
  const auto count = static_cast<Eigen::Index>(waves.size());
  for (Eigen::Index start = 0; start < count; start += block_nodes) {
    const Eigen::Index width = std::min(block_nodes, count - start);
    for (Eigen::Index j = 0; j < width; ++j) {
      const auto node = static_cast<std::size_t>(start + j);
      const double step = k * waves.beta[node] * spacing_mm;
      const double first = 2 * pi * std::remainder(waves.phase_waves[node], 1.0) - (size / 2) * step;
      rotations(first, step, size, [&](int i, Complex e) {
        tangential_re(i, j) = waves.amplitude[node] * e.real();
        tangential_im(i, j) = waves.amplitude[node] * e.imag();
      });
      rotations(0.0, k * waves.alpha[node] * spacing_mm, columns,
                [&](int i, Complex e) { sagittal(j, i) = 2 * e.real(); });
    }
    real.noalias() += tangential_re.leftCols(width) * sagittal.topRows(width);
    imaginary.noalias() += tangential_im.leftCols(width) * sagittal.topRows(width);
  }
  ComplexMatrix field(size, columns);
  field.real() = real;
  field.imag() = imaginary;
  return field;
}

}  // namespace

Psf sum_plane_waves(const PupilWaves& waves, int size, double spacing_um) {
  if (size < 1 || !(spacing_um > 0))
    throw InputError("a PSF needs at least one sample and a positive spacing");
  const ComplexMatrix field = half_field(waves, size, spacing_um * mm_per_um);
  Eigen::MatrixXd intensity(size, size);
  for (int j = 0; j < size; ++j) intensity.col(j) = field.col(std::abs(j - size / 2)).cwiseAbs2();

  const double sum = intensity.sum();
  Psf psf;
  psf.size = size;
  psf.spacing_um = spacing_um;
  const double lambda_mm = waves.wavelength_nm * mm_per_nm / waves.image_index;
  const double spacing_mm = spacing_um * mm_per_um;
  psf.captured = sum * spacing_mm * spacing_mm / (lambda_mm * lambda_mm * waves.flux);
  psf.values.resize(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j)
      psf.values[static_cast<std::size_t>(i) * static_cast<std::size_t>(size) + static_cast<std::size_t>(j)] =
          static_cast<float>(intensity(i, j) / sum);
  return psf;
}

}  // namespace petzval
