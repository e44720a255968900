// SPDX-License-Identifier: BSD-3-Clause
// From light on a sensor to a raw image.
#pragma once

#include <petzval/base/context.h>
#include <petzval/colour/spectrum.h>
#include <petzval/image/spectral_image.h>
#include <petzval/sensor/capture.h>
#include <petzval/sensor/exposure.h>
#include <petzval/sensor/raw_image.h>
#include <petzval/sensor/sensor.h>

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace petzval {

/// How long a sensor is exposed.
struct Exposure {
  enum class Kind { automatic, seconds, exposure_value };
  Kind kind = Kind::automatic;
  double value = 0;  ///< seconds, or the exposure value at ISO 100

  static Exposure automatic() { return {}; }
  static Exposure seconds(double time_s) { return {Kind::seconds, time_s}; }
  static Exposure of_value(double ev) { return {Kind::exposure_value, ev}; }
  /// "auto", a time ("0.01", "10ms", "1/100") or an exposure value ("ev:12"). \throws InputError saying what
  /// would be right.
  static Exposure parse(std::string_view text);
};

struct ExposeOptions {
  Exposure exposure = {};
  Metering::Rule metering = Metering::Rule::highlights;  ///< of automatic exposure
  double compensation_ev = 0;                            ///< +1 doubles the exposure
  /// Of a sensor with several conversion gains; empty: the first; "dual": one exposure is read at all of
  /// them, and the readings are merged.
  std::string gain_mode = {};
  double analog_gain = 1;
  std::optional<double> temperature_c = {};  ///< absent: the one that the dark current is stated for
  std::optional<std::uint64_t> serial = {};  ///< another copy of the sensor, with other fixed patterns
  std::set<NoiseSource> without = {};
  int frames = 1;                            ///< exposures that are averaged
  std::vector<double> bracket_ev = {};       ///< exposures that differ by these stops are merged
  std::optional<double> f_number = {};       ///< for exposure values; absent: the lens's, where known
  std::optional<double> exit_pupil_mm = {};  ///< from the sensor, negative in front of it; for microlenses
  std::optional<DateTime> date_time = {};    ///< by the camera's clock, for files; absent: they state none
  std::optional<Spectrum> illuminant = {};   ///< for white balance; absent: as the image says
};

/// Exposes a sensor to light.
///
///     ExposeOptions options;
///     options.exposure = Exposure::seconds(0.01);
///     const RawImage raw = expose(light, sensor, options);
///
/// The raw image is complete: its colour matrices, its white balance (of the light
/// of the scene; where that is not known, as if the scene were grey on average, and a note says so), its ISO
/// speed and the facts of its lens. Noise grows from the context's seed; frames of a bracket have seeds of
/// their own. \throws InputError for a sensor that turns no light into numbers, an image that was not made
/// for it, and options that it cannot take; Cancelled.
RawImage expose(const SpectralImage& light, const Sensor& sensor, const ExposeOptions& options = {},
                const Context& context = {});

}  // namespace petzval
