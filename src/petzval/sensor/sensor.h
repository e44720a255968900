// SPDX-License-Identifier: BSD-3-Clause
// Description of a sensor.
#pragma once

#include <string>

namespace petzval {

/// Where the pixels are: columns × rows at a square pitch, centred on the optical axis.
struct SensorGeometry {
  int columns = 0, rows = 0;
  double pitch_um = 0;

  double width_mm() const { return columns * pitch_um * 1e-3; }
  double height_mm() const { return rows * pitch_um * 1e-3; }
  double half_diagonal_mm() const;
  /// Image-space coordinates [mm] of the real (inverted) image at a pixel position (centres at half-integers).
  double x_mm(double column) const { return (columns / 2.0 - column) * pitch_um * 1e-3; }
  double y_mm(double row) const { return (row - rows / 2.0) * pitch_um * 1e-3; }
};

struct Sensor {
  std::string name, source;
  SensorGeometry geometry;
};

/// Reads "768x576@6.25" (columns x rows @ pitch in µm), a path, or the name of a bundled sensor
/// (JSON, "format": "petzval-sensor/1", strict).
/// \throws InputError saying what would be right.
Sensor read_sensor(const std::string& text);

}  // namespace petzval
