// SPDX-License-Identifier: BSD-3-Clause
// Sensor files: JSON, "petzval-sensor/1".
#pragma once

#include <petzval/lens/formats/json_document.h>
#include <petzval/sensor/sensor.h>

#include <string>

namespace petzval {

/// Reads the text of a sensor file (docs/SENSOR.md lists its keys). \param file  for messages.
/// \throws InputError with file and line for anything that is no sound sensor: unknown or missing keys,
/// numbers out of range, and parts that contradict each other.
Sensor parse_sensor(const std::string& text, const std::string& file);
Sensor parse_sensor(const JsonDocument& document);

/// What is wrong with a frame, or nothing.
std::string complaint_about(const SensorGeometry& geometry);

}  // namespace petzval
