// SPDX-License-Identifier: BSD-3-Clause
#include "raw_formats.h"

#include <petzval/isp/develop.h>
#include <petzval/sensor/capture.h>
#include <petzval/sensor/formats/dng.h>
#include <petzval/sensor/sensor_reader.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "require.h"

namespace petzval::fuzz {

namespace {

void expose(const Sensor& sensor) {
  SpectralImage light(std::min(2, sensor.geometry.columns), std::min(2, sensor.geometry.rows),
                      {450, 550, 650}, sensor.geometry.pitch_um,
                      sensor.photosite.is_plain() ? PixelAperture::box : PixelAperture::photosite);
  light.photosite = sensor.photosite.text();
  for (int band = 0; band < light.bands(); ++band) std::ranges::fill(light.band(band), 1e-3F);
  PhotoCurrentOptions optics;
  optics.exit_pupil_mm = -10;
  const PhotoCurrent current = photo_current(light, sensor, optics);
  for (const float e_per_s : current.e_per_s)
    require(e_per_s >= 0 && std::isfinite(e_per_s), "a current that is none");
  CaptureOptions options;
  options.without.insert(NoiseSource::defects);  // as many as the sensor is large
  capture(current, sensor, 0.01, options).validate();
}

}  // namespace

bool try_sensor(std::string_view bytes) {
  std::optional<Sensor> sensor;
  if (!accepted([&] { sensor = parse_sensor(std::string(bytes), "fuzz"); })) return false;
  require(complaint_about(sensor->geometry).empty(), "a frame that is none");
  sensor->photosite.validate();
  if (sensor->electronics) accepted([&] { expose(*sensor); });
  return true;
}

bool try_dng(std::string_view bytes) {
  std::optional<RawImage> raw;
  if (!accepted([&] { raw = parse_dng(std::string(bytes), "fuzz"); })) return false;
  raw->validate();
  accepted([&] { develop_planes(*raw); });
  if (!fits_dng(*raw)) return true;
  const std::string written = dng_bytes(*raw, "fuzz");
  const RawImage again = parse_dng(written, "fuzz");
  require(again.samples == raw->samples && again.columns == raw->columns,
          "a written raw file that reads back as another");
  for (int row = 0; row < raw->rows; ++row)
    for (int column = 0; column < raw->columns; ++column)
      require(again.pixel(row, column) == raw->pixel(row, column) &&
                  again.channels[static_cast<std::size_t>(again.mosaic.channel(row, column))] ==
                      raw->channels[static_cast<std::size_t>(raw->mosaic.channel(row, column))],
              "a pixel that reads back as another");
  return true;
}

}  // namespace petzval::fuzz
