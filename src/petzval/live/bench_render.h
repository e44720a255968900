// SPDX-License-Identifier: BSD-3-Clause
// Pictures of scenes in three dimensions, rendered through the lens of the bench.
#pragma once

#include <petzval/live/bench_picture.h>
#include <petzval/simulate/render_session.h>

#include <optional>
#include <string>

namespace petzval {

/// The renderings of one bench. Full and finest ones are sent again and again while their samples are taken.
class BenchRender {
 public:
  /// \param camera  with the lens as it was given, without a sensor.
  void show(const BenchState& state, const Camera& camera, const std::string& sensor_path,
            PictureQuality quality, const Context& context, const SendReply& send);

  /// From the sensor, along the axis, to what the last picture shows at a place (x right, y up, on the
  /// sensor [mm]). \throws InputError if there is none, or nothing is seen there.
  double distance_m(const std::array<double, 2>& place_mm) const;
  /// Files of the last picture of full quality, or of the finest. \throws InputError if there is none yet.
  void write(const std::string& path, const Context& context) const;

 private:
  struct Shot {
    std::string light_key = {}, shown_key = {};
    RenderSession session = {};
    std::optional<PreparedScene> scene = {};
    std::optional<SpectralImage> light = {};
    ShownSensor sensor = {};
    OutputOptions outputs = {};

    bool is_shown() const { return light && !shown_key.empty(); }
    double pixels() const {
      const SensorGeometry& frame = sensor.binned.sensor.geometry;
      return double{1} * frame.columns * frame.rows;
    }
  };
  Shot preview_, full_, finest_;
};

}  // namespace petzval
