// SPDX-License-Identifier: BSD-3-Clause
// Sensors and light for tests, made of numbers that can be reckoned with.
#pragma once

#include <petzval/image/spectral_image.h>
#include <petzval/sensor/sensor.h>

#include <string>
#include <vector>

namespace petzval::test {

/// Monochrome, no noise but the photons': efficiency 0.5 from 400 to 700 nm, 100,000 e, 0.5 DN/e, 16 bits,
/// black 100.
inline Sensor mono_sensor(int columns, int rows) {
  Sensor sensor;
  sensor.name = "test";
  sensor.source = "made up";
  sensor.geometry = {columns, rows, 5};
  SensorElectronics electronics;
  electronics.channels = {{"grey", Spectrum({400, 700}, {0.5, 0.5})}};
  electronics.gain_modes = {{"base", 100000, 0.5, 0, 0, 16}};
  electronics.bits = 16;
  electronics.black_level_dn = 100;
  electronics.white_level_dn = 65535;
  sensor.electronics = electronics;
  return sensor;
}

/// The same as a Bayer sensor, in the order of the letters ("RGGB").
inline Sensor bayer_sensor(int columns, int rows, const std::string& order = "RGGB") {
  Sensor sensor = mono_sensor(columns, rows);
  const std::string letters = "RGB";
  sensor.electronics->channels = {{"red", Spectrum({560, 600, 700}, {0.05, 0.5, 0.4})},
                                  {"green", Spectrum({460, 540, 640}, {0.05, 0.6, 0.05})},
                                  {"blue", Spectrum({400, 460, 540}, {0.3, 0.5, 0.05})}};
  sensor.electronics->mosaic = {2, 2, {}};
  for (const char letter : order)
    sensor.electronics->mosaic.cells.push_back(static_cast<int>(letters.find(letter)));
  return sensor;
}

/// The same irradiance [W·m⁻²·nm⁻¹] everywhere, from 400 to 700 nm.
inline SpectralImage uniform_light(int columns, int rows, double irradiance) {
  SpectralImage image(columns, rows, {400, 500, 600, 700}, 5);
  for (int band = 0; band < image.bands(); ++band)
    for (float& value : image.band(band)) value = static_cast<float>(irradiance);
  return image;
}

}  // namespace petzval::test
