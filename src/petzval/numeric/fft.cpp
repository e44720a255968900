// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/numeric/fft.h>
#include <petzval/numeric/fft_lanes.h>

#include <map>
#include <mutex>

namespace petzval {

namespace {

/// What transforms lines of a length, made at its first use and kept as long as the process lives.
template <class Lines>
const Lines& lines_of(int length) {
  static std::mutex mutex;
  static std::map<int, std::unique_ptr<const Lines>> known;
  const std::lock_guard lock(mutex);
  std::unique_ptr<const Lines>& lines = known[length];
  if (!lines) lines = Lines::make(static_cast<std::size_t>(length));
  return *lines;
}

}  // namespace

template <typename Real>
RealFft2<Real>::RealFft2(int rows, int columns) : rows_(rows), columns_(columns) {
  constexpr std::size_t max_size = std::size_t{1} << 28;
  if (rows < 1 || columns < 1 || size() > max_size)
    throw InputError(
        fmt::format("a Fourier transform of {} × {}: sizes from 1 to 2^28 in all are right", rows, columns));
  along_rows_ = &lines_of<RealLines<Real>>(columns);
  along_columns_ = &lines_of<ComplexLines<Real>>(rows);
}

template <typename Real>
void RealFft2<Real>::check(std::size_t image_size, std::size_t spectrum_size) const {
  if (image_size != this->size() || spectrum_size != this->spectrum_size())
    throw InputError(fmt::format("buffers of {} and {} for a Fourier transform of {} and {}", image_size,
                                 spectrum_size, this->size(), this->spectrum_size()));
}

template <typename Real>
void RealFft2<Real>::forward(const AlignedVector<Real>& image,
                             AlignedVector<std::complex<Real>>& spectrum) const {
  check(image.size(), spectrum.size());
  const auto across = static_cast<std::size_t>(spectrum_columns());
  along_rows_->forward(image.data(), columns_, spectrum.data(), spectrum_columns(),
                       static_cast<std::size_t>(rows_));
  along_columns_->transform(spectrum.data(), across, {1, spectrum_columns()}, true);
}

template <typename Real>
void RealFft2<Real>::inverse(AlignedVector<std::complex<Real>>& spectrum, AlignedVector<Real>& image) const {
  check(image.size(), spectrum.size());
  const auto across = static_cast<std::size_t>(spectrum_columns());
  along_columns_->transform(spectrum.data(), across, {1, spectrum_columns()}, false);
  along_rows_->backward(spectrum.data(), spectrum_columns(), image.data(), columns_,
                        static_cast<std::size_t>(rows_));
}

template class RealFft2<float>;
template class RealFft2<double>;

LineFft::LineFft(int size) : size_(size) {
  if (size < 1 || size > (1 << 26))
    throw InputError(fmt::format("a Fourier transform of {}: 1 to 2^26 is right", size));
}

void LineFft::forward(std::complex<double>* lines, std::size_t count, std::ptrdiff_t step) const {
  lines_of<ComplexLines<double>>(size_).transform(lines, count, {step, 1}, true);
}

void LineFft::inverse(std::complex<double>* lines, std::size_t count, std::ptrdiff_t step) const {
  lines_of<ComplexLines<double>>(size_).transform(lines, count, {step, 1}, false);
}

void LineFft::forward_real(std::complex<double>* lines, std::size_t count, std::ptrdiff_t step) const {
  lines_of<RealLines<double>>(size_).forward(reinterpret_cast<const double*>(lines), 2 * step, lines, step,
                                             count);
}

void LineFft::inverse_real(std::complex<double>* lines, std::size_t count, std::ptrdiff_t step) const {
  lines_of<RealLines<double>>(size_).backward(lines, step, reinterpret_cast<double*>(lines), 2 * step, count);
}

int good_fft_size(int at_least) {
  for (int size = at_least + at_least % 2;; size += 2) {
    int rest = size;
    for (const int prime : {2, 3, 5})
      while (rest > 1 && rest % prime == 0) rest /= prime;
    if (rest == 1 && size > 1) return size;
  }
}

}  // namespace petzval
