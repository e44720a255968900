// SPDX-License-Identifier: BSD-3-Clause
// An event camera (dynamic vision sensor): pixels that speak when their light has changed.
#pragma once

#include <petzval/sensor/photo_current.h>

#include <cstdint>
#include <vector>

namespace petzval {

struct EventCameraOptions {
  /// Change of the natural logarithm of the photocurrent that makes an event.
  double threshold_on = 0.2, threshold_off = 0.2;
  /// rms over pixels, relative to the threshold: fixed, from `serial`.
  double threshold_mismatch = 0;
  double time_constant_s = 0;  ///< of the photoreceptor, a low pass of first order; 0: it follows at once
  double refractory_s =
      0;  ///< after an event a pixel is held in reset, and then starts from where its light is
  double noise_per_s = 0;   ///< events of noise per second and pixel, of either sign
  double dark_e_per_s = 1;  ///< what adds to the photocurrent, so that darkness has a logarithm
  std::uint64_t seed = 1, serial = 1;

  /// \throws InputError for thresholds that are not positive, or negative times and rates.
  void validate() const;
};

struct Event {
  double t_s = 0;
  int column = 0, row = 0;
  bool brighter = false;
  bool operator==(const Event&) const = default;
};

/// Follows the light of every pixel, which changes in straight lines from one instant to the next.
///
///     EventCamera camera(options);
///     camera.see(0, current);
///     for (…) for (const Event& event : camera.see(t_s, current)) …
///
/// A pixel compares ln(low-passed current + dark current) with what it was at its last event (Lichtsteiner,
/// Posch & Delbruck, "A 128 × 128 120 dB 15 µs latency asynchronous temporal contrast vision sensor", IEEE
/// JSSC 43 (2008) 566). Times of events are solved for between the instants: the light is exponential or
/// straight there, so that none depends on how finely it is sampled. An edge of contrast ΔL makes ⌊ΔL/θ⌋
/// events, a ramp of L' per second 1/(θ/L' + refractory time) a second.
class EventCamera {
 public:
  explicit EventCamera(const EventCameraOptions& options);

  /// What happens up to `t_s`, in the order of time, then rows, then columns. The first call is the light
  /// that the camera has always seen. \throws InputError for a frame of another size, or a time that is not
  /// later.
  std::vector<Event> see(double t_s, const PhotoCurrent& current);

 private:
  struct Pixel {
    double level, reference;     ///< of the photoreceptor [e/s]; current at the last event [e/s]
    double resting_until;        ///< the end of the refractory time
    double rise, fall;           ///< thresholds as factors of the reference
    double next_noise;           ///< when
    std::uint32_t noise_events;  ///< so far
  };
  struct Stretch {
    double from_s, to_s, before, after;  ///< current plus dark [e/s]
  };
  void begin(double t_s, const PhotoCurrent& current);
  void follow(Pixel& pixel, const Stretch& light, int row, int column, std::vector<Event>& events) const;
  void draw_noise(Pixel& pixel, std::uint64_t place) const;

  EventCameraOptions options_;
  bool begun_ = false;
  double last_s_ = 0;
  PhotoCurrent last_;
  std::vector<Pixel> pixels_;
};

}  // namespace petzval
