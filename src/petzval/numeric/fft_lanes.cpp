// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/numeric/fft_lanes.h>

// What pocketfft includes must be read before it, outside of the code for one instruction set.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <stdexcept>
#include <type_traits>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/numeric/fft_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"  // vectors are passed between functions of this file only
#endif

// pocketfft is read once for every instruction set, under a name of its own each time.
#define PETZVAL_JOINED(a, b) a##b
#define PETZVAL_JOIN(a, b) PETZVAL_JOINED(a, b)
#undef pocketfft
#define pocketfft PETZVAL_JOIN(pocketfft_, HWY_NAMESPACE)
#undef POCKETFFT_HDRONLY_H
#undef POCKETFFT_NO_VECTORS
#define POCKETFFT_NO_MULTITHREADING
// It would call aligned_alloc() for sizes that are no multiple of the alignment, which not every C library
// grants.
#ifndef _LIBCPP_HAS_NO_ALIGNED_ALLOCATION
#define _LIBCPP_HAS_NO_ALIGNED_ALLOCATION
#endif
HWY_BEFORE_NAMESPACE();
#include <gemmi/third_party/pocketfft_hdronly.h>
namespace petzval::HWY_NAMESPACE {

template <typename Real>
constexpr std::size_t lanes = std::size_t{HWY_MAX_BYTES > 64 ? 64 : HWY_MAX_BYTES} / sizeof(Real);
template <typename Real>
struct LaneVector {
  typedef Real type __attribute__((vector_size(lanes<Real> * sizeof(Real))));
};
template <typename Real>
using Lanes = typename LaneVector<Real>::type;

/// Calls `vectors(first line)` for as many lines at a time as there are lanes, `single(line)` for the rest.
template <typename Real, class Vectors, class Single>
void over_lines(std::size_t count, Vectors&& vectors, Single&& single) {
  std::size_t line = 0;
  for (; line + lanes<Real> <= count; line += lanes<Real>) vectors(line);
  for (; line < count; ++line) single(line);
}

template <typename Real>
class ComplexLinesOf final : public ComplexLines<Real> {
 public:
  explicit ComplexLinesOf(std::size_t length) : length_(length), plan_(length) {}

  void transform(std::complex<Real>* first, std::size_t count, LineSteps steps, bool forward) const override {
    // Lines side by side are read by whole vectors, if the compiler knows that they are.
    if (steps.line == 1)
      transform(first, count, std::integral_constant<std::ptrdiff_t, 1>(), steps.number, forward);
    else
      transform(first, count, steps.line, steps.number, forward);
  }

 private:
  template <class LineStep>
  void transform(std::complex<Real>* first, std::size_t count, LineStep line_step, std::ptrdiff_t step,
                 bool forward) const {
    using Wide = pocketfft::detail::cmplx<Lanes<Real>>;
    using Narrow = pocketfft::detail::cmplx<Real>;
    pocketfft::detail::arr<Wide> wide(count >= lanes<Real> ? length_ : 0);
    pocketfft::detail::arr<Narrow> narrow(count % lanes<Real> == 0 ? 0 : length_);
    over_lines<Real>(
        count,
        [&](std::size_t line) {
          std::complex<Real>* at = first + static_cast<std::ptrdiff_t>(line) * line_step;
          for (std::size_t i = 0; i < length_; ++i, at += step) {
            Lanes<Real> r, im;
            for (std::size_t j = 0; j < lanes<Real>; ++j) {
              const auto* value =
                  reinterpret_cast<const Real*>(at + static_cast<std::ptrdiff_t>(j) * line_step);
              r[j] = value[0];
              im[j] = value[1];
            }
            wide[i].r = r;
            wide[i].i = im;
          }
          plan_.exec(wide.data(), Real(1), forward);
          at = first + static_cast<std::ptrdiff_t>(line) * line_step;
          for (std::size_t i = 0; i < length_; ++i, at += step) {
            const Lanes<Real> r = wide[i].r, im = wide[i].i;
            for (std::size_t j = 0; j < lanes<Real>; ++j) {
              auto* value = reinterpret_cast<Real*>(at + static_cast<std::ptrdiff_t>(j) * line_step);
              value[0] = r[j];
              value[1] = im[j];
            }
          }
        },
        [&](std::size_t line) {
          std::complex<Real>* at = first + static_cast<std::ptrdiff_t>(line) * line_step;
          for (std::size_t i = 0; i < length_; ++i) {
            const std::complex<Real>& value = at[static_cast<std::ptrdiff_t>(i) * step];
            narrow[i].Set(value.real(), value.imag());
          }
          plan_.exec(narrow.data(), Real(1), forward);
          for (std::size_t i = 0; i < length_; ++i)
            at[static_cast<std::ptrdiff_t>(i) * step] = {narrow[i].r, narrow[i].i};
        });
  }

  std::size_t length_;
  pocketfft::detail::pocketfft_c<Real> plan_;
};

/// pocketfft keeps the spectrum of a real line as r₀ r₁ i₁ r₂ i₂ … and, of an even length, a last r.
template <typename Real>
class RealLinesOf final : public RealLines<Real> {
 public:
  explicit RealLinesOf(std::size_t length) : length_(length), plan_(length) {}

  void forward(const Real* lines, std::ptrdiff_t line_step, std::complex<Real>* spectra,
               std::ptrdiff_t spectrum_step, std::size_t count) const override {
    pocketfft::detail::arr<Lanes<Real>> wide(count >= lanes<Real> ? length_ : 0);
    pocketfft::detail::arr<Real> narrow(count % lanes<Real> == 0 ? 0 : length_);
    over_lines<Real>(
        count,
        [&](std::size_t line) {
          const Real* in = lines + static_cast<std::ptrdiff_t>(line) * line_step;
          for (std::size_t i = 0; i < length_; ++i) {
            Lanes<Real> numbers;
            for (std::size_t j = 0; j < lanes<Real>; ++j)
              numbers[j] = in[static_cast<std::ptrdiff_t>(j) * line_step + static_cast<std::ptrdiff_t>(i)];
            wide[i] = numbers;
          }
          plan_.exec(wide.data(), Real(1), true);
          for (std::size_t j = 0; j < lanes<Real>; ++j)
            unpack(spectra + static_cast<std::ptrdiff_t>(line + j) * spectrum_step,
                   [&](std::size_t i) { return wide[i][j]; });
        },
        [&](std::size_t line) {
          std::copy_n(lines + static_cast<std::ptrdiff_t>(line) * line_step, length_, narrow.data());
          plan_.exec(narrow.data(), Real(1), true);
          unpack(spectra + static_cast<std::ptrdiff_t>(line) * spectrum_step,
                 [&](std::size_t i) { return narrow[i]; });
        });
  }

  void backward(const std::complex<Real>* spectra, std::ptrdiff_t spectrum_step, Real* lines,
                std::ptrdiff_t line_step, std::size_t count) const override {
    pocketfft::detail::arr<Lanes<Real>> wide(count >= lanes<Real> ? length_ : 0);
    pocketfft::detail::arr<Real> narrow(count % lanes<Real> == 0 ? 0 : length_);
    over_lines<Real>(
        count,
        [&](std::size_t line) {
          for (std::size_t j = 0; j < lanes<Real>; ++j)
            pack(spectra + static_cast<std::ptrdiff_t>(line + j) * spectrum_step,
                 [&](std::size_t i, Real value) { wide[i][j] = value; });
          plan_.exec(wide.data(), Real(1), false);
          for (std::size_t j = 0; j < lanes<Real>; ++j) {
            Real* out = lines + static_cast<std::ptrdiff_t>(line + j) * line_step;
            for (std::size_t i = 0; i < length_; ++i) out[i] = wide[i][j];
          }
        },
        [&](std::size_t line) {
          pack(spectra + static_cast<std::ptrdiff_t>(line) * spectrum_step,
               [&](std::size_t i, Real value) { narrow[i] = value; });
          plan_.exec(narrow.data(), Real(1), false);
          std::copy_n(narrow.data(), length_, lines + static_cast<std::ptrdiff_t>(line) * line_step);
        });
  }

 private:
  template <class At>
  void unpack(std::complex<Real>* spectrum, At&& at) const {
    spectrum[0] = {at(0), 0};
    std::size_t k = 1;
    for (; 2 * k < length_; ++k) spectrum[k] = {at(2 * k - 1), at(2 * k)};
    if (2 * k == length_) spectrum[k] = {at(length_ - 1), 0};
  }
  template <class Set>
  void pack(const std::complex<Real>* spectrum, Set&& set) const {
    set(0, spectrum[0].real());
    std::size_t k = 1;
    for (; 2 * k < length_; ++k) {
      set(2 * k - 1, spectrum[k].real());
      set(2 * k, spectrum[k].imag());
    }
    if (2 * k == length_) set(length_ - 1, spectrum[k].real());
  }

  std::size_t length_;
  pocketfft::detail::pocketfft_r<Real> plan_;
};

// Highway's table of instruction sets holds plain functions.
ComplexLines<float>* complex_float(std::size_t length) {
  return new ComplexLinesOf<float>(length);
}
ComplexLines<double>* complex_double(std::size_t length) {
  return new ComplexLinesOf<double>(length);
}
RealLines<float>* real_float(std::size_t length) {
  return new RealLinesOf<float>(length);
}
RealLines<double>* real_double(std::size_t length) {
  return new RealLinesOf<double>(length);
}

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(complex_float);
HWY_EXPORT(complex_double);
HWY_EXPORT(real_float);
HWY_EXPORT(real_double);

template <>
std::unique_ptr<const ComplexLines<float>> ComplexLines<float>::make(std::size_t length) {
  return std::unique_ptr<const ComplexLines>(HWY_DYNAMIC_DISPATCH(complex_float)(length));
}
template <>
std::unique_ptr<const ComplexLines<double>> ComplexLines<double>::make(std::size_t length) {
  return std::unique_ptr<const ComplexLines>(HWY_DYNAMIC_DISPATCH(complex_double)(length));
}
template <>
std::unique_ptr<const RealLines<float>> RealLines<float>::make(std::size_t length) {
  return std::unique_ptr<const RealLines>(HWY_DYNAMIC_DISPATCH(real_float)(length));
}
template <>
std::unique_ptr<const RealLines<double>> RealLines<double>::make(std::size_t length) {
  return std::unique_ptr<const RealLines>(HWY_DYNAMIC_DISPATCH(real_double)(length));
}

}  // namespace petzval
#endif
