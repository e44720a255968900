// SPDX-License-Identifier: BSD-3-Clause
// What becomes of a target's levels: noise, the numbers of a sensor.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/numeric/random.h>
#include <petzval/sensor/capture.h>
#include <petzval/simulate/target.h>

#include <algorithm>
#include <cmath>

namespace petzval {

TargetImage recorded_levels(const TargetImage& levels, const Sensor& sensor, const ExposeOptions& options,
                            const Context& context) {
  const SensorElectronics& electronics = sensor.require_electronics();
  const SensorGeometry& frame = sensor.geometry;
  if (levels.columns() > frame.columns || levels.rows() > frame.rows)
    throw InputError(
        fmt::format("a picture of {} x {} pixels on {}, which has {} x {}; a smaller `size` is right",
                    levels.columns(), levels.rows(), sensor.name, frame.columns, frame.rows));
  constexpr double usual_s = 0.01;
  if (options.exposure.kind == Exposure::Kind::exposure_value)
    throw InputError("`exposure` by value knows no levels; seconds would be right");
  const double exposure_s =
      options.exposure.kind == Exposure::Kind::seconds ? options.exposure.value : usual_s;
  if (!(exposure_s > 0)) throw InputError("`exposure` of a target's levels: a positive time is right");
  const double full_e =
      electronics.saturation_e(electronics.gain_mode(options.gain_mode), options.analog_gain);
  // The middle of the sensor.
  PhotoCurrent current{levels.columns(),
                       levels.rows(),
                       (frame.columns - levels.columns()) / 2,
                       (frame.rows - levels.rows()) / 2,
                       {}};
  for (const double value : levels.values())
    current.e_per_s.push_back(static_cast<float>(std::max(0.0, value) * full_e / exposure_s));
  const RawImage raw = result_within(context, [&](const ProgressCallback&) {
    return capture(current, sensor, exposure_s,
                   {options.gain_mode, options.analog_gain, options.temperature_c, context.seed,
                    options.serial, options.without, options.frames});
  });
  const double white = electronics.black_level_dn + full_e * raw.dn_per_e;
  const double top = raw.linearization.empty() ? white : raw.white_level;
  TargetImage result(levels.rows(), levels.columns());
  for (int row = 0; row < result.rows(); ++row)
    for (int column = 0; column < result.columns(); ++column)
      result.at(row, column) = (raw.pixel(row, column) - raw.black_level) / (top - raw.black_level);
  return result;
}

void add_target_noise(TargetImage& levels, double sigma, std::uint64_t seed) {
  if (!(sigma >= 0) || !std::isfinite(sigma))
    throw InputError(fmt::format("`noise` {}: zero or more is right", sigma));
  constexpr std::uint32_t purpose = 0x7a26e7;  // of this noise alone
  if (sigma == 0) return;
  std::uint64_t index = 0;
  for (double& value : levels.values()) value += sigma * RandomStream(seed, purpose, index++).normal();
}

}  // namespace petzval
