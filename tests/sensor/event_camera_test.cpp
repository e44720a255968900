// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/sensor/event_camera.h>

#include <algorithm>
#include <cmath>

namespace petzval {
namespace {

PhotoCurrent even(double current, int columns = 1, int rows = 1) {
  return {columns, rows, 0, 0,
          std::vector<float>(static_cast<std::size_t>(columns * rows), static_cast<float>(current))};
}

EventCameraOptions plain(double threshold) {
  EventCameraOptions options;
  options.threshold_on = options.threshold_off = threshold;
  options.dark_e_per_s = 1e-9;
  return options;
}

// A light that is stepped through an exponential in pieces: straight between instants 1/1000 of an e-fold
// apart, whose logarithm is right to 1e-7.
std::vector<Event> ramp(EventCamera& camera, double per_second, double seconds) {
  std::vector<Event> all;
  constexpr int pieces = 1000;
  const int count = static_cast<int>(std::abs(per_second) * seconds * pieces);
  camera.see(0, even(1000));
  for (int k = 1; k <= count; ++k) {
    const double t = seconds * k / count;
    for (const Event& event : camera.see(t, even(1000 * std::exp(per_second * t)))) all.push_back(event);
  }
  return all;
}

TEST(EventCamera, AStepMakesAsManyEventsAsThresholdsFitIntoIt) {
  for (const double factor : {1.5, 3.0, 0.3}) {
    EventCamera camera(plain(0.15));
    camera.see(0, even(1000));
    const std::vector<Event> events = camera.see(1e-6, even(1000 * factor));
    EXPECT_EQ(events.size(), static_cast<std::size_t>(std::abs(std::log(factor)) / 0.15)) << factor;
    for (const Event& event : events) EXPECT_EQ(event.brighter, factor > 1);
  }
}

// Event n of a step from I₁ to I₂ through a low pass of time constant τ comes at
// −τ ln(1 − I₁(e^{nθ} − 1)/(I₂ − I₁)). The photocurrent is a float.
TEST(EventCamera, TheLatencyOfAStepIsThatOfItsLowPass) {
  EventCameraOptions options = plain(0.2);
  options.time_constant_s = 1e-3;
  EventCamera camera(options);
  camera.see(0, even(1000));
  camera.see(1, even(1000));
  const double rise = 1e-9;
  std::vector<Event> events = camera.see(1 + rise, even(3000));
  for (const Event& event : camera.see(1.1, even(3000))) events.push_back(event);
  ASSERT_EQ(events.size(), 5u);  // ln 3 / 0.2 = 5.49
  for (std::size_t n = 1; n <= events.size(); ++n) {
    const double late = -1e-3 * std::log(1 - 1000 * (std::exp(0.2 * double(n)) - 1) / 2000);
    EXPECT_NEAR(events[n - 1].t_s - 1, late, 1e-8) << n;
  }
}

TEST(EventCamera, ARampMakesEventsAtTheRateOfItsSlope) {
  EventCamera camera(plain(0.1));
  const std::vector<Event> events = ramp(camera, 2, 3);
  ASSERT_GE(events.size(), 59u);  // 6/0.1, the last on the edge
  for (std::size_t n = 0; n < events.size(); ++n) EXPECT_NEAR(events[n].t_s, 0.05 * double(n + 1), 1e-6);
}

// After its rest a pixel starts from where its light is: the gap between events is θ/L' and the rest.
TEST(EventCamera, TheRefractoryTimeAddsToTheGap) {
  EventCameraOptions options = plain(0.1);
  options.refractory_s = 0.03;
  EventCamera camera(options);
  const std::vector<Event> events = ramp(camera, -2, 3);
  ASSERT_EQ(events.size(), 37u);  // 0.05, 0.13, 0.21, …: (3 − 0.05)/0.08 and the first
  for (std::size_t n = 0; n < events.size(); ++n) {
    EXPECT_NEAR(events[n].t_s, 0.05 + 0.08 * double(n), 1e-6);
    EXPECT_FALSE(events[n].brighter);
  }
}

TEST(EventCamera, ALowPassedRampComesToTheSameRate) {
  EventCameraOptions options = plain(0.1);
  options.time_constant_s = 0.02;
  EventCamera camera(options);
  const std::vector<Event> events = ramp(camera, 2, 3);
  ASSERT_GE(events.size(), 55u);
  for (std::size_t n = 20; n < events.size(); ++n)
    EXPECT_NEAR(events[n].t_s - events[n - 1].t_s, 0.05, 1e-5);  // e^{−t/τ} has died away
}

TEST(EventCamera, DoesNotDependOnHowFinelyLightIsSeen) {
  EventCameraOptions options = plain(0.07);
  options.time_constant_s = 2e-3;
  options.refractory_s = 1e-4;
  options.noise_per_s = 50;
  const auto seen = [&](int pieces) {
    EventCamera camera(options);
    std::vector<Event> all;
    camera.see(0, even(0, 8, 4));
    for (int k = 1; k <= pieces; ++k)  // dyadic: floats are exact
      for (const Event& event : camera.see(k / double(pieces), even(4096.0 * k / pieces, 8, 4)))
        all.push_back(event);
    return all;
  };
  const std::vector<Event> coarse = seen(1), fine = seen(64);
  ASSERT_EQ(coarse.size(), fine.size());
  for (std::size_t i = 0; i < coarse.size(); ++i) EXPECT_NEAR(coarse[i].t_s, fine[i].t_s, 1e-9);
}

// Of 4,000 pixels in a second 20,000 ± 141 events of noise; half are of either sign.
TEST(EventCamera, NoiseIsAPoissonProcess) {
  EventCameraOptions options = plain(0.2);
  options.noise_per_s = 5;
  EventCamera camera(options);
  camera.see(0, even(100, 100, 40));
  const std::vector<Event> events = camera.see(1, even(100, 100, 40));
  EXPECT_NEAR(double(events.size()), 20000, 5 * std::sqrt(20000));
  EXPECT_NEAR(double(std::ranges::count(events, true, &Event::brighter)), double(events.size()) / 2,
              5 * std::sqrt(5000));
  EXPECT_TRUE(std::ranges::is_sorted(events, {}, &Event::t_s));
}

// A step of L over thresholds θ(1 + σz): the share of pixels with an event is the normal law's at (L/θ −
// 1)/σ.
TEST(EventCamera, ThresholdsDifferByTheirMismatch) {
  EventCameraOptions options = plain(0.2);
  options.threshold_mismatch = 0.1;
  EventCamera camera(options);
  constexpr int pixels = 10000;
  camera.see(0, even(1000, 100, 100));
  const std::vector<Event> events = camera.see(1, even(1000 * std::exp(0.21), 100, 100));
  const double share = 0.5 * std::erfc(-0.5 / std::sqrt(2.0));
  EXPECT_NEAR(double(events.size()), pixels * share, 5 * std::sqrt(pixels * share * (1 - share)));
}

TEST(EventCamera, HasTheSameEventsForAnyNumberOfThreads) {
  EventCameraOptions options = plain(0.05);
  options.noise_per_s = 10;
  options.threshold_mismatch = 0.2;
  const auto made = [&](int threads) {
    const ThreadLimit limit(threads);
    EventCamera camera(options);
    camera.see(0, even(100, 40, 30));
    return camera.see(0.1, even(150, 40, 30));
  };
  EXPECT_EQ(made(1), made(2));
}

TEST(EventCamera, RefusesWhatItCannotBe) {
  EXPECT_THROW(EventCamera{plain(0)}, InputError);
  EventCameraOptions options = plain(0.2);
  options.refractory_s = -1;
  EXPECT_THROW(EventCamera{options}, InputError);
  options = plain(0.2);
  options.dark_e_per_s = 0;
  EXPECT_THROW(EventCamera{options}, InputError);
  EventCamera camera(plain(0.2));
  camera.see(0, even(1));
  EXPECT_THROW(camera.see(0, even(1)), InputError);
  EXPECT_THROW(camera.see(1, even(1, 2, 2)), InputError);
}

}  // namespace
}  // namespace petzval
