// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/colour/observer.h>
#include <petzval/sensor/exposure.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace petzval {

namespace {

double level_to_meter(const PhotoCurrent& current, Metering::Rule rule) {
  if (rule == Metering::Rule::average)
    return std::accumulate(current.e_per_s.begin(), current.e_per_s.end(), 0.0) /
           static_cast<double>(current.e_per_s.size());
  std::vector<float> levels = current.e_per_s;
  const auto rank =
      static_cast<std::size_t>(std::ceil(Metering::highlight_share * static_cast<double>(levels.size())) - 1);
  const auto nth = levels.begin() + static_cast<std::ptrdiff_t>(std::min(rank, levels.size() - 1));
  std::nth_element(levels.begin(), nth, levels.end());
  if (*nth > 0) return static_cast<double>(*nth);
  // Light in less than one pixel of a hundred: a star is metered by itself.
  return static_cast<double>(*std::max_element(levels.begin(), levels.end()));
}

}  // namespace

double metered_exposure_s(const PhotoCurrent& current, double saturation_e, const Metering& metering) {
  const double level = level_to_meter(current, metering.rule);
  if (!(level > 0)) throw InputError("there is no light to meter; an exposure in seconds would be right");
  const double share =
      metering.rule == Metering::Rule::average ? Metering::average_level : Metering::highlight_level;
  return share * saturation_e / level * std::exp2(metering.compensation_ev);
}

double exposure_of_ev_s(double ev, double f_number) {
  return f_number * f_number * std::exp2(-ev);
}

double saturation_speed(const Sensor& sensor, const GainMode& mode, double analog_gain,
                        const Spectrum& light) {
  const double lux = luminance(light);  // of an irradiance: its illuminance
  const std::vector<double> currents = channel_currents(sensor, light);
  const double fastest = *std::max_element(currents.begin(), currents.end());
  if (!(lux > 0 && fastest > 0))
    throw InputError("a speed needs light that the eye and the sensor see; D55, for example");
  const double saturation_lx_s = sensor.electronics->saturation_e(mode, analog_gain) * lux / fastest;
  constexpr double saturation_constant = 78;
  return saturation_constant / saturation_lx_s;
}

}  // namespace petzval
