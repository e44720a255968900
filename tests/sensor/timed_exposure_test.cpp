// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/sensor/capture.h>
#include <petzval/sensor/timed_exposure.h>

#include <cmath>
#include <complex>
#include <functional>

#include "flat_sensor.h"

namespace petzval {
namespace {

constexpr int frame_columns = 160, frame_rows = 90;
constexpr double bright = 2000;  // e/s

PhotoCurrent frame_of(const std::function<double(int row, int column)>& current) {
  PhotoCurrent frame{frame_columns, frame_rows, 0, 0, {}};
  for (int r = 0; r < frame_rows; ++r)
    for (int c = 0; c < frame_columns; ++c) frame.e_per_s.push_back(static_cast<float>(current(r, c)));
  return frame;
}

/// A bright bar, whose edges are seen through pixels of a box: the share of each that it covers.
PhotoCurrent bar_at(double left, double width) {
  return frame_of([&](int, int column) {
    return bright * std::max(0.0, std::min(left + width, column + 1.0) - std::max(left, double(column)));
  });
}

/// Exposes light that is given at all times, at instants `step_s` apart.
PhotoCurrent exposed(const FrameTiming& timing, const LampFlicker& flicker, double step_s,
                     const std::function<PhotoCurrent(double t_s)>& light) {
  TimedExposure exposure(timing, flicker);
  const double end_s = timing.end_s(frame_rows);
  const auto steps = static_cast<int>(std::ceil((end_s - timing.start_s) / step_s));
  double t0 = timing.start_s;
  PhotoCurrent before = light(t0);
  for (int k = 1; k <= steps; ++k) {
    const double t1 = timing.start_s + (end_s - timing.start_s) * k / steps;
    PhotoCurrent after = light(t1);
    exposure.add(t0, before, t1, after);
    t0 = t1;
    before = std::move(after);
  }
  return exposure.mean_current();
}

double centroid(const PhotoCurrent& frame, int row) {
  double sum = 0, moment = 0;
  for (int c = 0; c < frame_columns; ++c) {
    const double value = frame.e_per_s[static_cast<std::size_t>(row * frame_columns + c)];
    sum += value;
    moment += value * (c + 0.5);
  }
  return moment / sum;
}

// The centroid of a bar of constant width moves as the bar does, through box pixels too. Instants a whole
// number of which fall in a row time and in the exposure leave no error but that of float.
TEST(TimedExposure, SlantsAMovingBarByItsSpeedTimesTheRowTime) {
  const double speed = 2000, row_time = 20e-6, exposure = 1e-3;  // px/s: 0.04 px a row
  const FrameTiming timing{0.01, exposure, {Shutter::Kind::rolling, row_time}};
  const PhotoCurrent frame =
      exposed(timing, {}, row_time, [&](double t) { return bar_at(20 + speed * (t - 0.01), 12); });
  for (int r = 0; r < frame_rows; ++r)
    EXPECT_NEAR(centroid(frame, r), 26 + speed * (r * row_time + exposure / 2), 1e-5) << r;

  const PhotoCurrent global = exposed({0.01, exposure, {}}, {}, row_time,
                                      [&](double t) { return bar_at(20 + speed * (t - 0.01), 12); });
  for (int r = 0; r < frame_rows; ++r) EXPECT_NEAR(centroid(global, r), 26 + speed * exposure / 2, 1e-5) << r;
}

// A row that opens at t for T under 1 + d cos(ωt + φ) collects T + (d/ω)(sin(ω(t + T) + φ) − sin(ωt + φ)).
TEST(TimedExposure, BandsAsTheMainsFlicker) {
  const double row_time = 100e-6, exposure = 3e-3, depth = 0.6, phase = 0.15;
  const LampFlicker flicker = LampFlicker::mains(50, depth, phase);
  const FrameTiming timing{2.345, exposure, {Shutter::Kind::rolling, row_time}};
  const PhotoCurrent grey = frame_of([](int, int) { return bright; });
  const PhotoCurrent frame = exposed(timing, flicker, 1, [&](double) { return grey; });
  const double w = 2 * M_PI * 100;
  for (int r = 0; r < frame_rows; ++r) {
    const double t = timing.start_s + r * row_time, begin = w * t + 2 * M_PI * phase;
    const double expected = 1 + depth / (w * exposure) * (std::sin(begin + w * exposure) - std::sin(begin));
    EXPECT_NEAR(frame.e_per_s[static_cast<std::size_t>(r * frame_columns)] / bright, expected, 1e-6) << r;
  }
}

// The bands of a PWM lamp repeat every 1/(f · row time) rows; over one period that is a whole number of rows
// the Fourier sum at that frequency has the phase of the lamp's first harmonic in the middle of the windows.
TEST(TimedExposure, BandsOfASwitchedLampHaveItsFrequencyAndPhase) {
  const double row_time = 100e-6, frequency = 500, duty = 0.25, phase = 0.1, exposure = 0.5e-3;
  const FrameTiming timing{1, exposure, {Shutter::Kind::rolling, row_time}};
  const PhotoCurrent grey = frame_of([](int, int) { return bright; });
  const PhotoCurrent frame =
      exposed(timing, LampFlicker::pwm(frequency, duty, phase), 1, [&](double) { return grey; });
  constexpr int period = 20;  // rows: 1/(500 Hz · 100 µs)
  double sum = 0;
  for (int r = 0; r < period; ++r) {
    const double value = frame.e_per_s[static_cast<std::size_t>(r * frame_columns)];
    sum += value;
    // In windows that begin later by whole row times, in each of which the lamp is on or off for whole row
    // times.
    EXPECT_NEAR(value, frame.e_per_s[static_cast<std::size_t>((r + period) * frame_columns)], 1e-3) << r;
    // Closed form: the overlap of the window with the lamp's on-times.
    double lit = 0;
    for (int k = -2; k < 4; ++k) {
      const double on = (k - phase) / frequency, off = on + duty / frequency, open = r * row_time;
      lit += std::max(0.0, std::min(off, open + exposure) - std::max(on, open));
    }
    EXPECT_NEAR(value, bright * lit / duty / exposure, 1e-3) << r;
  }
  EXPECT_NEAR(sum / period, bright, 1e-3);
}

// A bar that moves by 6 pixels, against 256 still exposures of a 256th of the time each. The electrons of the
// two differ by shot noise alone: of 14,400 pixels the sum of squared differences over variances is χ².
TEST(TimedExposure, MotionBlurIsTheSumOfManyStills) {
  Sensor sensor = test::mono_sensor(frame_columns, frame_rows);
  sensor.electronics->gain_modes[0].dn_per_e = 1;  // electrons are counted without rounding
  const double speed = 600, exposure = 10e-3, scale = 1000;
  const auto light = [&](double t) {
    PhotoCurrent bar = bar_at(40.3 + speed * t, 9.7);
    for (float& value : bar.e_per_s) value = static_cast<float>(scale * (value + 200));
    return bar;
  };
  CaptureOptions options;
  const RawImage blurred =
      capture(exposed({0, exposure, {}}, {}, 0.25 / speed, light), sensor, exposure, options);
  constexpr int stills = 256;
  std::vector<double> sums(blurred.samples.size()), means(blurred.samples.size());
  options.seed = 77;
  for (int k = 0; k < stills; ++k) {
    options.first_frame = k;
    const PhotoCurrent current = light((k + 0.5) * exposure / stills);
    const RawImage still = capture(current, sensor, exposure / stills, options);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      sums[i] += (still.samples[i] - still.black_level) / still.dn_per_e;
      means[i] += double(current.e_per_s[i]) * exposure / stills;
    }
  }
  double chi_square = 0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double electrons = (blurred.samples[i] - blurred.black_level) / blurred.dn_per_e;
    const double variance = 2 * means[i];  // shot noise of both
    chi_square += (electrons - sums[i]) * (electrons - sums[i]) / variance;
  }
  const auto n = static_cast<double>(sums.size());
  EXPECT_NEAR(chi_square / n, 1, 5 * std::sqrt(2 / n));
}

// What the header states: a detail of f cycles per pixel keeps πfh/tan(πfh) of what true motion leaves it.
TEST(TimedExposure, LosesWhatIsStatedToItsSteps) {
  const double f = 0.3, speed = 400, exposure = 10e-3;  // 4 px
  const auto light = [&](double t) {
    return frame_of(
        [&](int, int c) { return bright * (1 + 0.5 * std::cos(2 * M_PI * f * (c - speed * t))); });
  };
  for (const double h : {1.0, 0.5, 0.25}) {
    const PhotoCurrent frame = exposed({0, exposure, {}}, {}, h / speed, light);
    std::complex<double> sum = 0;
    for (int c = 0; c < frame_columns; ++c)  // whole periods
      sum += double(frame.e_per_s[static_cast<std::size_t>(c)]) * std::polar(1.0, -2 * M_PI * f * c);
    const double contrast = std::abs(sum) / frame_columns / (bright * 0.25);
    const double length = speed * exposure;
    const double true_motion = std::abs(std::sin(M_PI * f * length) / (M_PI * f * length));
    EXPECT_NEAR(contrast / true_motion, M_PI * f * h / std::tan(M_PI * f * h), 1e-5) << h;
  }
}

TEST(TimedExposure, HasTheSameBytesForAnyNumberOfThreads) {
  const auto made = [](int threads) {
    const ThreadLimit limit(threads);
    return exposed({0, 1e-3, {Shutter::Kind::rolling, 1e-5}}, LampFlicker::mains(50, 0.3), 1e-4,
                   [](double t) { return bar_at(3 + 5000 * t, 7); })
        .e_per_s;
  };
  EXPECT_EQ(made(1), made(2));
}

TEST(TimedExposure, RefusesFramesThatDoNotFollow) {
  TimedExposure exposure({0, 1, {}}, {});
  const PhotoCurrent frame = bar_at(3, 4);
  EXPECT_THROW(exposure.add(1, frame, 1, frame), InputError);
  exposure.add(0, frame, 1, frame);
  PhotoCurrent other = frame;
  other.e_per_s.pop_back();
  EXPECT_THROW(exposure.add(1, frame, 2, other), InputError);
}

// Temporal noise of two frames differs, the fixed pattern does not: the mean of many tells it.
TEST(Clip, NoiseIsNewInEachFrameAndTheFixedPatternStays) {
  Sensor sensor = test::mono_sensor(frame_columns, frame_rows);
  sensor.electronics->dsnu_e = 20;
  const PhotoCurrent dim = frame_of([](int, int) { return 10000.0; });  // 100 e, shot noise 10 e
  CaptureOptions options;
  constexpr int frames = 32;
  std::vector<RawImage> raws;
  for (int k = 0; k < frames; ++k) {
    options.first_frame = k;
    raws.push_back(capture(dim, sensor, 0.01, options));
  }
  EXPECT_NE(raws[0].samples, raws[1].samples);
  // Covariance of two frames over pixels: the DSNU alone; variance of their difference: twice the shot noise.
  double covariance = 0, difference = 0, a = 0, b = 0;
  const auto n = static_cast<double>(raws[0].samples.size());
  for (std::size_t i = 0; i < raws[0].samples.size(); ++i)
    a += raws[0].samples[i] / n, b += raws[1].samples[i] / n;
  for (std::size_t i = 0; i < raws[0].samples.size(); ++i) {
    covariance += (raws[0].samples[i] - a) * (raws[1].samples[i] - b) / n;
    difference += std::pow(raws[0].samples[i] - a - raws[1].samples[i] + b, 2) / n;
  }
  const double dn2 = 0.25;  // (0.5 DN/e)²
  EXPECT_NEAR(covariance / (400 * dn2), 1, 5 * std::sqrt(2.6 / n));
  EXPECT_NEAR(difference / (2 * (100 * dn2 + 1.0 / 12)), 1, 5 * std::sqrt(2 / n));
}

}  // namespace
}  // namespace petzval
