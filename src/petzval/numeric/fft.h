// SPDX-License-Identifier: BSD-3-Clause
// Real two-dimensional Fourier transforms, and those of lines.
#pragma once

#include <complex>
#include <cstddef>
#include <new>
#include <vector>

namespace petzval {

template <typename Real>
class ComplexLines;
template <typename Real>
class RealLines;

/// Memory aligned for the widest vectors of the machine.
template <typename T>
struct AlignedAllocator {
  using value_type = T;
  static constexpr std::align_val_t alignment{64};
  AlignedAllocator() = default;
  template <typename U>
  explicit AlignedAllocator(const AlignedAllocator<U>&) {}
  T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), alignment)); }
  void deallocate(T* memory, std::size_t) { ::operator delete(memory, alignment); }
  bool operator==(const AlignedAllocator&) const = default;
};

template <typename T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

/// Transforms of rows × columns real numbers and back, for Real = float or double:
///
///     RealFft2<float> fft(64, 64);
///     AlignedVector<float> image(fft.size());
///     AlignedVector<std::complex<float>> spectrum(fft.spectrum_size());
///     fft.forward(image, spectrum);   // Σ image[r][c] exp(−2πi(kr/rows + lc/columns)), l = 0 … columns/2
///     fft.inverse(spectrum, image);   // exponent +, not normalised: comes back times size()
///
/// The inverse leaves something else in the spectrum. Cheap to copy: what a size needs is made once per
/// process and shared. Both transforms may be called from many threads at once.
template <typename Real>
class RealFft2 {
 public:
  /// \throws InputError unless both are at least 1 and rows × columns is at most 2^28.
  RealFft2(int rows, int columns);

  int rows() const { return rows_; }
  int columns() const { return columns_; }
  int spectrum_columns() const { return columns_ / 2 + 1; }
  std::size_t size() const { return static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_); }
  std::size_t spectrum_size() const {
    return static_cast<std::size_t>(rows_) * static_cast<std::size_t>(spectrum_columns());
  }

  /// \throws InputError if a vector has another size than this transform.
  void forward(const AlignedVector<Real>& image, AlignedVector<std::complex<Real>>& spectrum) const;
  void inverse(AlignedVector<std::complex<Real>>& spectrum, AlignedVector<Real>& image) const;

 private:
  void check(std::size_t image_size, std::size_t spectrum_size) const;

  int rows_, columns_;
  const RealLines<Real>* along_rows_;
  const ComplexLines<Real>* along_columns_;
};

extern template class RealFft2<float>;
extern template class RealFft2<double>;

/// Transforms of lines in double precision, in place: `count` of them, `step` complex numbers apart. Many at
/// once take less time than one by one.
///
/// Complex lines hold size() numbers. A real line of size() numbers lies in the same memory as its spectrum
/// of size()/2 + 1 complex numbers: it is addressed through a pointer to the latter.
class LineFft {
 public:
  /// \throws InputError unless 1 ≤ size ≤ 2^26.
  explicit LineFft(int size);

  int size() const { return size_; }
  /// Σ line[j] exp(−2πi jk/size).
  void forward(std::complex<double>* lines, std::size_t count = 1, std::ptrdiff_t step = 0) const;
  /// Exponent +, not normalised.
  void inverse(std::complex<double>* lines, std::size_t count = 1, std::ptrdiff_t step = 0) const;
  void forward_real(std::complex<double>* lines, std::size_t count = 1, std::ptrdiff_t step = 0) const;
  void inverse_real(std::complex<double>* lines, std::size_t count = 1, std::ptrdiff_t step = 0) const;

 private:
  int size_;
};

/// The smallest even size of at least `at_least` (≥ 1) that transforms fast: 2^a·3^b·5^c, a ≥ 1.
int good_fft_size(int at_least);

}  // namespace petzval
