// SPDX-License-Identifier: BSD-3-Clause
// A sensor with fewer and larger pixels, for pictures of the size of a screen.
#pragma once

#include <petzval/sensor/sensor.h>

#include <string>
#include <vector>

namespace petzval {

/// A sensor whose pixels are added up k × k, and the settings of its file that make it so ("pitch_um=35.82"),
/// by which `read_sensor(name, settings)` makes it anywhere.
struct BinnedSensor {
  Sensor sensor = {};
  std::vector<std::string> settings = {};  ///< none: the sensor as it is
  int pixels_added = 1;                    ///< k
  int whole_columns = 0, whole_rows = 0;   ///< of the sensor itself
};

/// The least k with which a sensor has at most so many columns. Frame and light stay: a pixel of k² the area
/// holds k² the electrons, and its noise adds up as that of k² pixels does: read noise and dark
/// non-uniformity by k, dark current and hot pixels by k², noise that all pixels of a row share by k^1.5.
/// Colour filters are those of the small sensor: one of them covers the whole larger pixel, as on a sensor
/// that was made so. \param name  as read_sensor() takes it.
BinnedSensor binned_sensor(const std::string& name, int most_columns);

/// The most columns with which a sensor, whose pixels are added up k × k, has at most so many pixels.
int columns_for_pixels(const std::string& name, double most_pixels);

/// The bundled sensor with colours whose corner is nearest to this height of the image, smaller ones first.
std::string usual_sensor(double image_height_mm);

}  // namespace petzval
