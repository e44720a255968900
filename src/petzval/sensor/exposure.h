// SPDX-License-Identifier: BSD-3-Clause
// How long to expose, and how fast a sensor is.
#pragma once

#include <petzval/colour/spectrum.h>
#include <petzval/sensor/photo_current.h>
#include <petzval/sensor/sensor.h>

#include <cstdint>
#include <optional>
#include <span>

namespace petzval {

/// The rule of automatic exposure. It looks at the mean photoelectrons of every pixel of the raw frame,
/// whatever its colour, before noise.
struct Metering {
  enum class Rule {
    highlights,  ///< the level that 99 % of the pixels do not exceed comes to 80 % of saturation
    average  ///< the mean comes to 12.7 % of saturation: 18 % grey with half a stop to spare (ISO 12232:2019)
  };
  Rule rule = Rule::highlights;
  double compensation_ev = 0;  ///< +1 doubles the exposure

  static constexpr double highlight_share = 0.99, highlight_level = 0.80, average_level = 0.127;
};

/// \param saturation_e  SensorElectronics::saturation_e. \param left_out  not 0 for pixels that are not
/// metered, unless no other has light; may be empty. \throws InputError if there is no light to meter.
double metered_exposure_s(const PhotoCurrent& current, double saturation_e, const Metering& metering,
                          std::span<const std::uint8_t> left_out = {});

/// Exposure time of an exposure value at ISO 100 as photographers count: t = N²/2^EV.
double exposure_of_ev_s(double ev, double f_number);

/// ISO 12232 saturation-based speed S_sat = 78/H_sat: H_sat [lx·s] is the exposure under `light` (any scale)
/// at which the most sensitive channel saturates. \throws InputError for light without luminance or that no
/// channel sees.
double saturation_speed(const Sensor& sensor, const GainMode& mode, double analog_gain,
                        const Spectrum& light);

/// ISO 12232 noise-based speed 10/H: H [lx·s] is the exposure at which a pixel of the most sensitive channel
/// has this ratio of signal to noise, 40 ("excellent") or 10 ("acceptable"). The noise is that of the raw
/// file, temporal and fixed, without dark current; the standard looks at developed pictures, whose noise
/// depends on the development. Absent if saturation or PRNU come first. \throws InputError as
/// saturation_speed.
std::optional<double> noise_speed(const Sensor& sensor, const GainMode& mode, double analog_gain,
                                  const Spectrum& light, double snr);

}  // namespace petzval
