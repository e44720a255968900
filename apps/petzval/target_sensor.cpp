// SPDX-License-Identifier: BSD-3-Clause
#include "target_sensor.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/sensor/capture.h>

#include <algorithm>

namespace petzval::app {

void TargetSensor::add_to(CLI::App& command) {
  CLI::Option* named = command.add_option(
      "--sensor", name,
      "Sensor, by name or file: its pitch, photosite, low-pass filter, noise, well and converter");
  for (const char* settled : {"--pixel-pitch", "--photosite", "--fill-factor", "--low-pass", "--noise"})
    named->excludes(command.get_option(settled));
  command.add_option("--exposure", exposure_s, "Exposure time [s], for the dark current of the --sensor")
      ->needs(named)
      ->check(positive_number())
      ->capture_default_str();
  command.add_option("--gain", gain, "Analog gain of the --sensor")->needs(named)->capture_default_str();
  command
      .add_option("--without", without,
                  "Noise of the --sensor to leave out: shot, read, prnu, ... (petzval sense)")
      ->needs(named)
      ->delimiter(',');
}

void TargetSensor::prepare(TargetOptics& optics) {
  if (name.empty()) return;
  sensor_ = read_sensor(name);
  sensor_->require_electronics();
  optics.pitch_um = sensor_->geometry.pitch_um;
  optics.photosite = sensor_->photosite.text();
  optics.sensor_site = sensor_->photosite;
}

void TargetSensor::expose(TargetImage& image, const Shared& shared) const {
  const SensorGeometry& frame = sensor_->geometry;
  if (image.columns > frame.columns || image.rows > frame.rows)
    throw InputError(
        fmt::format("a picture of {} x {} pixels on {}, which has {} x {}; a smaller --size is right",
                    image.columns, image.rows, sensor_->name, frame.columns, frame.rows));
  CaptureOptions options;
  options.seed = shared.seed;
  options.analog_gain = gain;
  for (const std::string& source : without) options.without.insert(noise_source(source));
  const SensorElectronics& electronics = *sensor_->electronics;
  const double full_e = electronics.saturation_e(electronics.gain_mode(""), gain);
  // The middle of the sensor.
  PhotoCurrent current{
      image.columns, image.rows, (frame.columns - image.columns) / 2, (frame.rows - image.rows) / 2, {}};
  for (const double value : image.values)
    current.e_per_s.push_back(static_cast<float>(std::max(0.0, value) * full_e / exposure_s));
  const RawImage raw = capture(current, *sensor_, exposure_s, options);
  const double white = electronics.black_level_dn + full_e * raw.dn_per_e;
  const double top = raw.linearization.empty() ? white : raw.white_level;
  for (int row = 0; row < image.rows; ++row)
    for (int column = 0; column < image.columns; ++column)
      image.values[static_cast<std::size_t>(row) * static_cast<std::size_t>(image.columns) +
                   static_cast<std::size_t>(column)] =
          (raw.pixel(row, column) - raw.black_level) / (top - raw.black_level);
}

}  // namespace petzval::app
