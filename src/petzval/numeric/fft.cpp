// SPDX-License-Identifier: BSD-3-Clause
#include <fftw3.h>
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/numeric/fft.h>

#include <map>
#include <mutex>
#include <utility>

namespace petzval {

namespace {

// FFTW has one set of names for each precision; its planner may be used by one thread at a time.
template <typename Real>
struct Fftw;

template <>
struct Fftw<float> {
  using Plan = fftwf_plan;
  using Complex = fftwf_complex;
  static Plan plan_forward(int rows, int columns, float* in, Complex* out, unsigned flags) {
    return fftwf_plan_dft_r2c_2d(rows, columns, in, out, flags);
  }
  static Plan plan_inverse(int rows, int columns, Complex* in, float* out, unsigned flags) {
    return fftwf_plan_dft_c2r_2d(rows, columns, in, out, flags);
  }
  static void execute_forward(Plan plan, float* in, Complex* out) { fftwf_execute_dft_r2c(plan, in, out); }
  static void execute_inverse(Plan plan, Complex* in, float* out) { fftwf_execute_dft_c2r(plan, in, out); }
  static void destroy(Plan plan) { fftwf_destroy_plan(plan); }
};

template <>
struct Fftw<double> {
  using Plan = fftw_plan;
  using Complex = fftw_complex;
  static Plan plan_forward(int rows, int columns, double* in, Complex* out, unsigned flags) {
    return fftw_plan_dft_r2c_2d(rows, columns, in, out, flags);
  }
  static Plan plan_inverse(int rows, int columns, Complex* in, double* out, unsigned flags) {
    return fftw_plan_dft_c2r_2d(rows, columns, in, out, flags);
  }
  static void execute_forward(Plan plan, double* in, Complex* out) { fftw_execute_dft_r2c(plan, in, out); }
  static void execute_inverse(Plan plan, Complex* in, double* out) { fftw_execute_dft_c2r(plan, in, out); }
  static void destroy(Plan plan) { fftw_destroy_plan(plan); }
};

std::mutex& planner_mutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

template <typename Real>
struct RealFft2<Real>::Plans {
  using Library = Fftw<Real>;
  typename Library::Plan forward = nullptr, inverse = nullptr;

  Plans(int rows, int columns) {
    const std::size_t size = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
    const std::size_t spectrum_size =
        static_cast<std::size_t>(rows) * (static_cast<std::size_t>(columns) / 2 + 1);
    AlignedVector<Real> image(size);
    AlignedVector<std::complex<Real>> spectrum(spectrum_size);
    auto* complex = reinterpret_cast<typename Library::Complex*>(spectrum.data());
    forward =
        Library::plan_forward(rows, columns, image.data(), complex, FFTW_ESTIMATE | FFTW_PRESERVE_INPUT);
    inverse = Library::plan_inverse(rows, columns, complex, image.data(), FFTW_ESTIMATE);
    if (forward == nullptr || inverse == nullptr) {
      release();
      throw Failure(fmt::format("no Fourier transform of {} × {} could be planned", rows, columns));
    }
  }
  ~Plans() {
    const std::lock_guard lock(planner_mutex());
    release();
  }
  Plans(const Plans&) = delete;
  Plans& operator=(const Plans&) = delete;

  /// The plans of a size, made at its first use and kept as long as the process lives.
  static std::shared_ptr<const Plans> of_size(int rows, int columns) {
    planner_mutex();  // constructed before, and so destroyed after, the plans that need it
    static std::map<std::pair<int, int>, std::shared_ptr<const Plans>> known;
    const std::lock_guard lock(planner_mutex());
    std::shared_ptr<const Plans>& plans = known[{rows, columns}];
    if (!plans) plans = std::make_shared<const Plans>(rows, columns);
    return plans;
  }

 private:
  void release() {
    if (forward != nullptr) Library::destroy(forward);
    if (inverse != nullptr) Library::destroy(inverse);
  }
};

template <typename Real>
RealFft2<Real>::RealFft2(int rows, int columns) : rows_(rows), columns_(columns) {
  constexpr std::size_t max_size = std::size_t{1} << 28;
  if (rows < 1 || columns < 1 || size() > max_size)
    throw InputError(
        fmt::format("a Fourier transform of {} × {}: sizes from 1 to 2^28 in all are right", rows, columns));
  plans_ = Plans::of_size(rows, columns);
}

template <typename Real>
void RealFft2<Real>::forward(const AlignedVector<Real>& image,
                             AlignedVector<std::complex<Real>>& spectrum) const {
  if (image.size() != size() || spectrum.size() != spectrum_size())
    throw InputError(fmt::format("buffers of {} and {} for a Fourier transform of {} and {}", image.size(),
                                 spectrum.size(), size(), spectrum_size()));
  // The interface of FFTW takes no const; the plan preserves its input.
  Plans::Library::execute_forward(plans_->forward, const_cast<Real*>(image.data()),
                                  reinterpret_cast<typename Plans::Library::Complex*>(spectrum.data()));
}

template <typename Real>
void RealFft2<Real>::inverse(AlignedVector<std::complex<Real>>& spectrum, AlignedVector<Real>& image) const {
  if (image.size() != size() || spectrum.size() != spectrum_size())
    throw InputError(fmt::format("buffers of {} and {} for a Fourier transform of {} and {}", image.size(),
                                 spectrum.size(), size(), spectrum_size()));
  Plans::Library::execute_inverse(
      plans_->inverse, reinterpret_cast<typename Plans::Library::Complex*>(spectrum.data()), image.data());
}

template class RealFft2<float>;
template class RealFft2<double>;

struct LineFft::Plans {
  fftw_plan forward, inverse, forward_real, inverse_real;

  explicit Plans(int size) {
    AlignedVector<std::complex<double>> line(static_cast<std::size_t>(size) + 1);
    auto* complex = reinterpret_cast<fftw_complex*>(line.data());
    auto* real = reinterpret_cast<double*>(line.data());
    // Lines of an array need not be aligned one by one.
    const unsigned flags = FFTW_ESTIMATE | FFTW_UNALIGNED;
    forward = fftw_plan_dft_1d(size, complex, complex, FFTW_FORWARD, flags);
    inverse = fftw_plan_dft_1d(size, complex, complex, FFTW_BACKWARD, flags);
    forward_real = fftw_plan_dft_r2c_1d(size, real, complex, flags);
    inverse_real = fftw_plan_dft_c2r_1d(size, complex, real, flags);
    if (!forward || !inverse || !forward_real || !inverse_real) {
      release();
      throw Failure(fmt::format("no Fourier transform of {} could be planned", size));
    }
  }
  ~Plans() {
    const std::lock_guard lock(planner_mutex());
    release();
  }
  Plans(const Plans&) = delete;
  Plans& operator=(const Plans&) = delete;

  static std::shared_ptr<const Plans> of_size(int size) {
    planner_mutex();
    static std::map<int, std::shared_ptr<const Plans>> known;
    const std::lock_guard lock(planner_mutex());
    std::shared_ptr<const Plans>& plans = known[size];
    if (!plans) plans = std::make_shared<const Plans>(size);
    return plans;
  }

 private:
  void release() {
    for (const fftw_plan plan : {forward, inverse, forward_real, inverse_real})
      if (plan != nullptr) fftw_destroy_plan(plan);
  }
};

LineFft::LineFft(int size) : size_(size) {
  if (size < 1 || size > (1 << 26))
    throw InputError(fmt::format("a Fourier transform of {}: 1 to 2^26 is right", size));
  plans_ = Plans::of_size(size);
}

void LineFft::forward(std::complex<double>* line) const {
  auto* complex = reinterpret_cast<fftw_complex*>(line);
  fftw_execute_dft(plans_->forward, complex, complex);
}

void LineFft::inverse(std::complex<double>* line) const {
  auto* complex = reinterpret_cast<fftw_complex*>(line);
  fftw_execute_dft(plans_->inverse, complex, complex);
}

void LineFft::forward_real(std::complex<double>* line) const {
  fftw_execute_dft_r2c(plans_->forward_real, reinterpret_cast<double*>(line),
                       reinterpret_cast<fftw_complex*>(line));
}

void LineFft::inverse_real(std::complex<double>* line) const {
  fftw_execute_dft_c2r(plans_->inverse_real, reinterpret_cast<fftw_complex*>(line),
                       reinterpret_cast<double*>(line));
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
