// SPDX-License-Identifier: BSD-3-Clause
// Where a tilted chart is in focus.
#pragma once

#include <petzval/measure/sfr/measure_picture.h>

#include <span>
#include <string>
#include <vector>

namespace petzval {

/// The sharpness of one edge.
struct SharpnessAt {
  double place = 0;  ///< along the chart, in any unit
  double mtf50 = 0, deviation = 0;
};

struct SharpestPlace {
  double place = 0, deviation = 0;  ///< in the unit of the places
  double mtf50 = 0;                 ///< there
  std::size_t edges = 0;            ///< that count
};

/// 1/MTF50² = a + b (place − best)², as blur that grows with defocus adds to what is there without it, by
/// least squares; edges below half of the best sharpness, where blur is no Gaussian, count for nothing. The
/// deviation follows from the scatter about the fit, and is no less than that of the edges makes it. \throws
/// InputError for fewer than four edges, where sharpness does not fall to both sides, or is greatest beyond
/// the edges.
SharpestPlace sharpest_place(std::span<const SharpnessAt> edges);

enum class ChartAxis { x, y };

struct ChannelFocus {
  std::string channel;
  SharpestPlace sharpest;  ///< in mm of the chart where edges say where they are on it, else in pixels
};

/// Where a tilted chart is sharpest along an axis, in each channel, by the edges that run across it within 30
/// degrees: each of these is at one depth. \throws InputError without such edges, and as sharpest_place().
std::vector<ChannelFocus> focus_along(std::span<const MeasuredEdge> edges, ChartAxis axis);

/// How far behind or before the middle of a chart of `length_mm` a place along it stands, tilted by an angle:
/// positive towards its far end in x or y.
double depth_on_tilted_chart(double place_mm, double length_mm, double tilt_deg);

}  // namespace petzval
