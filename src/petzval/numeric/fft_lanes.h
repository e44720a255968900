// SPDX-License-Identifier: BSD-3-Clause
// One-dimensional Fourier transforms of many lines, side by side in the lanes of a vector. fft_lanes.cpp is
// the only file that knows which library makes them (pocketfft).
#pragma once

#include <complex>
#include <cstddef>
#include <memory>

namespace petzval {

/// Where lines of numbers lie: number i of line j at first[j·line + i·number].
struct LineSteps {
  std::ptrdiff_t line = 0, number = 1;
};

template <typename Real>
class ComplexLines {
 public:
  /// For the instruction set of this machine. \param length  at least 1.
  static std::unique_ptr<const ComplexLines> make(std::size_t length);
  virtual ~ComplexLines() = default;
  /// In place, exponent − or, backward, +; not normalised.
  virtual void transform(std::complex<Real>* first, std::size_t count, LineSteps steps,
                         bool forward) const = 0;
};

/// Lines of `length` real numbers and their spectra of length/2 + 1 complex ones. The numbers of a line, and
/// those of a spectrum, lie one after the other; a spectrum may lie where its line does.
template <typename Real>
class RealLines {
 public:
  static std::unique_ptr<const RealLines> make(std::size_t length);
  virtual ~RealLines() = default;
  /// Steps from one line to the next are counted in numbers of either kind.
  virtual void forward(const Real* lines, std::ptrdiff_t line_step, std::complex<Real>* spectra,
                       std::ptrdiff_t spectrum_step, std::size_t count) const = 0;
  virtual void backward(const std::complex<Real>* spectra, std::ptrdiff_t spectrum_step, Real* lines,
                        std::ptrdiff_t line_step, std::size_t count) const = 0;
};

}  // namespace petzval
