// SPDX-License-Identifier: BSD-3-Clause
// From the light on the sensor to what a page shows of it, for flat scenes and for those in three dimensions.
#pragma once

#include <petzval/live/bench.h>
#include <petzval/live/bench_sensor.h>
#include <petzval/sensor/colour_calibration.h>
#include <petzval/simulate/outputs.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace petzval {

/// A sensor as a picture has it, by the columns that it has at most.
struct ShownSensor {
  std::string key = {};
  BinnedSensor binned = {};
  std::vector<ColourCalibration> calibrations = {};  ///< fitted once

  /// Reads it anew if it is another.
  void choose(const std::string& path, int most_columns);
};

/// Exposure and development as a state asks for them; stray light, of which `neglected_ghosts` is left out.
OutputOptions output_options(const BenchState& state);
FlareOptions flare_options(const BenchState& state, double neglected_ghosts);

/// Exposes and develops, or shows the light. \param message  what the page is told besides. \throws
/// Cancelled.
void send_picture(const SpectralImage& light, const ShownSensor& sensor, const OutputOptions& outputs,
                  nlohmann::json message, const Context& context, const SendReply& send);

}  // namespace petzval
