// SPDX-License-Identifier: BSD-3-Clause
// The Fourier transform of real masses at arbitrary places (type 1, two dimensions).
#pragma once

#include <complex>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace petzval {

/// Real masses at places in turns: x and y are taken modulo 1.
struct PointMasses {
  std::vector<double> x, y, mass;

  void reserve(std::size_t count);
  void add(double at_x, double at_y, double of_mass);
  std::size_t size() const { return mass.size(); }
};

/// F(k, l) = Σ_j mass_j exp(−2πi(k x_j + l y_j)) for k = 0 … k_max and l = −l_max … l_max. The other half
/// follows from F(−k, −l) = conj F(k, l).
///
/// Masses are spread onto a grid 1.5 times as fine as the highest frequency needs, by a kernel 14 cells wide,
/// whose transform is divided out afterwards (Barnett, Magland & af Klinteberg, SIAM J. Sci. Comput. 41
/// (2019) C479: "exponential of semicircle"). Relative error in the root mean square: below 1e-10.
class NonuniformFft2 {
 public:
  /// \throws InputError unless both are from 0 to 2^23.
  NonuniformFft2(int k_max, int l_max);

  /// Takes a column of F: `values[l + l_max]`.
  using Visitor = std::function<void(int k, std::span<const std::complex<double>> values)>;

  /// Visits every column once. Columns whose k agree up to sign modulo `alias_period` (≥ 1) are visited by
  /// one thread in rising order, others at the same time, so that a visitor may fold aliases without locks.
  /// The grid is made in as many passes as `max_bytes` asks for. The bytes do not depend on the number of
  /// threads.
  void transform(const PointMasses& points, int alias_period, std::size_t max_bytes,
                 const Visitor& visit) const;

 private:
  int k_max_, l_max_, columns_, rows_;
  std::vector<double> column_correction_, row_correction_;  ///< 1/transform of the kernel, by |k| and |l|
};

/// F(l) = Σ_j mass_j exp(−2πi l y_j) for l = 0 … l_max, in the same way.
std::vector<std::complex<double>> nonuniform_fft(std::span<const double> y, std::span<const double> mass,
                                                 int l_max);

}  // namespace petzval
