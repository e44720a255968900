// SPDX-License-Identifier: BSD-3-Clause
// Parts of a frame in which a lens does about the same to detail.
#pragma once

#include <petzval/imaging/field_error.h>
#include <petzval/sensor/sensor.h>

#include <array>
#include <cstddef>

namespace petzval {

/// Rings about the axis, each as wide, and in each of them waves that run along the radius and waves that run
/// across it.
class FrameZones {
 public:
  static constexpr std::size_t rings = 8, count = 2 * rings;

  explicit FrameZones(const SensorGeometry& sensor);

  /// The ring of a height; the last one reaches as far as you like.
  std::size_t ring_at(double height_mm) const;
  /// How much of each ring lies between two heights, as shares of the frame.
  std::array<double, rings> shares(double from_mm, double to_mm) const;
  static std::size_t along_radius(std::size_t ring) { return 2 * ring; }
  static std::size_t across_radius(std::size_t ring) { return 2 * ring + 1; }

 private:
  FrameRings frame_;
  std::array<double, rings + 1> borders_mm_{};
};

/// Bands of spatial frequency: the b-th has its middle at (b + ½) · step [cycles/pixel].
struct DetailBands {
  static constexpr double step_cpp = 0.05;
  static constexpr std::size_t a_cycle = 20;  ///< bands
  static constexpr std::size_t count = 20 * a_cycle;

  static double middle_cpp(std::size_t band) { return (double(band) + 0.5) * step_cpp; }
};

}  // namespace petzval
