// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/colour/observer.h>
#include <petzval/sensor/exposure.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace petzval {

namespace {

/// The currents that are metered.
std::vector<float> metered_levels(const std::vector<float>& currents,
                                  std::span<const std::uint8_t> left_out) {
  if (left_out.size() != currents.size()) return currents;
  std::vector<float> levels;
  for (std::size_t i = 0; i < currents.size(); ++i)
    if (left_out[i] == 0) levels.push_back(currents[i]);
  return std::ranges::any_of(levels, [](float level) { return level > 0; }) ? levels : currents;
}

double level_to_meter(std::vector<float> levels, Metering::Rule rule) {
  if (rule == Metering::Rule::average)
    return std::accumulate(levels.begin(), levels.end(), 0.0) / static_cast<double>(levels.size());
  const auto rank =
      static_cast<std::size_t>(std::ceil(Metering::highlight_share * static_cast<double>(levels.size())) - 1);
  const auto nth = levels.begin() + static_cast<std::ptrdiff_t>(std::min(rank, levels.size() - 1));
  std::nth_element(levels.begin(), nth, levels.end());
  if (*nth > 0) return static_cast<double>(*nth);
  // Light in less than one pixel of a hundred: a star is metered by itself.
  return static_cast<double>(*std::max_element(levels.begin(), levels.end()));
}

/// Exposure that gives the most sensitive channel an electron.
double lx_s_per_electron(const Sensor& sensor, const Spectrum& light) {
  const double lux = luminance(light);  // of an irradiance: its illuminance
  const std::vector<double> currents = channel_currents(sensor, light);
  const double fastest = *std::max_element(currents.begin(), currents.end());
  if (!(lux > 0 && fastest > 0))
    throw InputError("a speed needs light that the eye and the sensor see; D55, for example");
  return lux / fastest;
}

}  // namespace

double metered_exposure_s(const PhotoCurrent& current, double saturation_e, const Metering& metering,
                          std::span<const std::uint8_t> left_out) {
  const double level = level_to_meter(metered_levels(current.e_per_s, left_out), metering.rule);
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
  constexpr double saturation_constant = 78;
  return saturation_constant /
         (sensor.require_electronics().saturation_e(mode, analog_gain) * lx_s_per_electron(sensor, light));
}

std::optional<double> noise_speed(const Sensor& sensor, const GainMode& mode, double analog_gain,
                                  const Spectrum& light, double snr) {
  const SensorElectronics& electronics = sensor.require_electronics();
  const double dn_per_e = mode.dn_per_e * analog_gain, square = snr * snr;
  const double quantised_e2 = (mode.adc_noise_dn * mode.adc_noise_dn + 1.0 / 12) / (dn_per_e * dn_per_e);
  const double dark_e2 =
      mode.read_noise_e * mode.read_noise_e + quantised_e2 + electronics.dsnu_e * electronics.dsnu_e;
  // mean² = snr² (mean + dark + PRNU² mean²)
  const double rest = 1 - square * electronics.prnu * electronics.prnu;
  if (!(rest > 0)) return {};
  const double mean_e = (square + std::sqrt(square * square + 4 * rest * square * dark_e2)) / (2 * rest);
  if (mean_e > electronics.saturation_e(mode, analog_gain)) return {};
  constexpr double noise_constant = 10;
  return noise_constant / (mean_e * lx_s_per_electron(sensor, light));
}

}  // namespace petzval
