// SPDX-License-Identifier: BSD-3-Clause
// The Fourier transforms beside FFTW's, planned by estimate, where that library is there: one after the other
// in one run. The counter `of_fftw` is our time by FFTW's.
#if __has_include(<fftw3.h>)
#include <benchmark/benchmark.h>
#include <fftw3.h>
#include <petzval/numeric/fft.h>

#include <algorithm>
#include <chrono>
#include <vector>

namespace petzval {
namespace {

template <class Work>
double seconds(Work&& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Times both by turns; the ratio is that of the medians.
template <class Ours, class Theirs>
void compare(benchmark::State& state, Ours&& ours, Theirs&& theirs) {
  std::vector<double> our_times, their_times;
  ours();
  theirs();
  for (auto _ : state) {
    our_times.push_back(seconds(ours));
    their_times.push_back(seconds(theirs));
    state.SetIterationTime(our_times.back());
  }
  const auto median = [](std::vector<double>& times) {
    std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2),
                     times.end());
    return times[times.size() / 2];
  };
  state.counters["of_fftw"] = median(our_times) / median(their_times);
}

template <typename Real>
struct Fftw;
template <>
struct Fftw<float> {
  fftwf_plan plan;
  explicit Fftw(fftwf_plan made) : plan(made) {}
  ~Fftw() { fftwf_destroy_plan(plan); }
  void run() const { fftwf_execute(plan); }
  static Fftw forward(int n, float* in, std::complex<float>* out) {
    return Fftw(fftwf_plan_dft_r2c_2d(n, n, in, reinterpret_cast<fftwf_complex*>(out),
                                      FFTW_ESTIMATE | FFTW_PRESERVE_INPUT));
  }
  static Fftw inverse(int n, std::complex<float>* in, float* out) {
    return Fftw(fftwf_plan_dft_c2r_2d(n, n, reinterpret_cast<fftwf_complex*>(in), out, FFTW_ESTIMATE));
  }
};
template <>
struct Fftw<double> {
  fftw_plan plan;
  explicit Fftw(fftw_plan made) : plan(made) {}
  ~Fftw() { fftw_destroy_plan(plan); }
  void run() const { fftw_execute(plan); }
  static Fftw forward(int n, double* in, std::complex<double>* out) {
    return Fftw(fftw_plan_dft_r2c_2d(n, n, in, reinterpret_cast<fftw_complex*>(out),
                                     FFTW_ESTIMATE | FFTW_PRESERVE_INPUT));
  }
  static Fftw inverse(int n, std::complex<double>* in, double* out) {
    return Fftw(fftw_plan_dft_c2r_2d(n, n, reinterpret_cast<fftw_complex*>(in), out, FFTW_ESTIMATE));
  }
};

/// A square there and back. The numbers stay small: each round divides by the size.
template <typename Real>
void square(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  const RealFft2<Real> fft(n, n);
  AlignedVector<Real> image(fft.size(), Real(1));
  AlignedVector<std::complex<Real>> spectrum(fft.spectrum_size());
  const Fftw<Real> forward = Fftw<Real>::forward(n, image.data(), spectrum.data());
  const Fftw<Real> inverse = Fftw<Real>::inverse(n, spectrum.data(), image.data());
  const int rounds = std::max(1, (1 << 18) / (n * n));
  const auto scaled = [&](auto&& there_and_back) {
    return [&, there_and_back] {
      for (int i = 0; i < rounds; ++i) {
        there_and_back();
        for (Real& value : image) value /= static_cast<Real>(fft.size());
      }
    };
  };
  compare(state, scaled([&] {
            fft.forward(image, spectrum);
            fft.inverse(spectrum, image);
          }),
          scaled([&] {
            forward.run();
            inverse.run();
          }));
}
BENCHMARK(square<float>)->UseManualTime()->Arg(32)->Arg(64)->Arg(90)->Arg(128)->Arg(240)->Arg(512)->Arg(1024);
BENCHMARK(square<double>)
    ->UseManualTime()
    ->Arg(32)
    ->Arg(64)
    ->Arg(90)
    ->Arg(128)
    ->Arg(240)
    ->Arg(512)
    ->Arg(1024);

/// Sixteen real lines, as the targets transform them.
void real_lines(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0)), count = 16;
  const std::ptrdiff_t step = n / 2 + 1;
  AlignedVector<std::complex<double>> lines(static_cast<std::size_t>(count * step), 0.0);
  const LineFft fft(n);
  auto* complex = reinterpret_cast<fftw_complex*>(lines.data());
  const Fftw<double> plan(
      fftw_plan_dft_r2c_1d(n, reinterpret_cast<double*>(complex), complex, FFTW_ESTIMATE | FFTW_UNALIGNED));
  compare(
      state, [&] { fft.forward_real(lines.data(), count, step); },
      [&] {
        for (int i = 0; i < count; ++i)
          fftw_execute_dft_r2c(plan.plan, reinterpret_cast<double*>(complex + i * step), complex + i * step);
      });
}
BENCHMARK(real_lines)->UseManualTime()->Arg(128)->Arg(500)->Arg(1024)->Arg(4096)->Arg(10000);

void complex_lines(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0)), count = 16;
  AlignedVector<std::complex<double>> lines(static_cast<std::size_t>(count * n), 0.0);
  const LineFft fft(n);
  auto* complex = reinterpret_cast<fftw_complex*>(lines.data());
  const Fftw<double> plan(
      fftw_plan_dft_1d(n, complex, complex, FFTW_FORWARD, FFTW_ESTIMATE | FFTW_UNALIGNED));
  compare(
      state, [&] { fft.forward(lines.data(), count, n); },
      [&] {
        for (int i = 0; i < count; ++i)
          fftw_execute_dft(plan.plan, complex + std::ptrdiff_t{i} * n, complex + std::ptrdiff_t{i} * n);
      });
}
BENCHMARK(complex_lines)->UseManualTime()->Arg(128)->Arg(500)->Arg(1024)->Arg(4096)->Arg(10000);

}  // namespace
}  // namespace petzval
#endif
