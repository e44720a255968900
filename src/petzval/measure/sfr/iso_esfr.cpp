// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/measure/sfr/iso_esfr.h>

#include <algorithm>
#include <cmath>
#include <complex>

namespace petzval {

namespace {

constexpr int bins_per_pixel = 4;

double hamming(double position, double centre, double half_width) {
  const double u = (position - centre) / half_width;
  return std::abs(u) > 1 ? 0 : 0.54 + 0.46 * std::cos(pi * u);
}

/// The box with its edge upright: rows run across the edge.
struct UprightEdge {
  int columns = 0, rows = 0;
  bool turned = false;
  std::vector<double> values;
  double at(int column, int row) const {
    return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(column)];
  }
};

UprightEdge upright(const Plane& plane, const PixelBox& box) {
  double across = 0, down = 0;
  for (int r = box.y; r < box.y + box.height; ++r)
    for (int c = box.x; c < box.x + box.width; ++c) {
      if (c + 1 < box.x + box.width) across += std::pow(plane.at(c + 1, r) - plane.at(c, r), 2);
      if (r + 1 < box.y + box.height) down += std::pow(plane.at(c, r + 1) - plane.at(c, r), 2);
    }
  UprightEdge edge;
  edge.turned = down > across;
  edge.columns = edge.turned ? box.height : box.width;
  edge.rows = edge.turned ? box.width : box.height;
  for (int r = 0; r < edge.rows; ++r)
    for (int c = 0; c < edge.columns; ++c)
      edge.values.push_back(edge.turned ? plane.at(box.x + r, box.y + c) : plane.at(box.x + c, box.y + r));
  return edge;
}

struct Line {
  double offset = 0, slope = 0;  ///< column = offset + slope·row
};

Line fit_rows(const UprightEdge& edge, const Line* about) {
  double n = 0, sr = 0, sc = 0, srr = 0, src = 0;
  for (int r = 0; r < edge.rows; ++r) {
    const double centre = about != nullptr ? about->offset + about->slope * r : 0.5 * (edge.columns - 2);
    double moment = 0, mass = 0;
    for (int c = 0; c + 1 < edge.columns; ++c) {
      const double difference = (edge.at(c + 1, r) - edge.at(c, r)) * hamming(c, centre, 0.5 * edge.columns);
      moment += difference * (c + 0.5), mass += difference;
    }
    if (mass == 0) throw InputError("a row without a difference in it has no edge");
    const double column = moment / mass;
    n += 1, sr += r, sc += column, srr += static_cast<double>(r) * r, src += r * column;
  }
  const double determinant = n * srr - sr * sr;
  const double slope = (n * src - sr * sc) / determinant;
  return {(sc - slope * sr) / n, slope};
}

}  // namespace

IsoEsfr iso_esfr(const Plane& plane, const PixelBox& box) {
  samples_in(plane, box);
  constexpr int least = 16;
  if (std::min(box.width, box.height) < least)
    throw InputError("the ISO method needs an ROI of at least 16 by 16 pixels");
  const UprightEdge edge = upright(plane, box);
  Line line = fit_rows(edge, nullptr);
  line = fit_rows(edge, &line);

  const int bins = edge.columns * bins_per_pixel;
  std::vector<double> sum(static_cast<std::size_t>(bins)), count(static_cast<std::size_t>(bins));
  const double middle_row = 0.5 * (edge.rows - 1);
  for (int r = 0; r < edge.rows; ++r)
    for (int c = 0; c < edge.columns; ++c) {
      const double place = c - line.slope * (r - middle_row);
      const int bin = static_cast<int>(std::floor(place * bins_per_pixel));
      if (bin < 0 || bin >= bins) continue;
      sum[static_cast<std::size_t>(bin)] += edge.at(c, r), count[static_cast<std::size_t>(bin)] += 1;
    }
  std::vector<double> profile(sum.size());
  for (std::size_t i = 0; i < sum.size(); ++i) {
    // An empty bin takes the value of the nearest full one.
    std::size_t from = i;
    for (std::size_t d = 0; d < sum.size(); ++d) {
      if (i >= d && count[i - d] > 0) {
        from = i - d;
        break;
      }
      if (i + d < sum.size() && count[i + d] > 0) {
        from = i + d;
        break;
      }
    }
    if (count[from] == 0) throw InputError("the ISO method found no pixels along the edge");
    profile[i] = sum[from] / count[from];
  }
  std::vector<double> spread(profile.size());
  for (std::size_t i = 1; i + 1 < profile.size(); ++i) spread[i] = 0.5 * (profile[i + 1] - profile[i - 1]);
  const double centre = (line.offset + line.slope * middle_row) * bins_per_pixel;
  for (std::size_t i = 0; i < spread.size(); ++i)
    spread[i] *= hamming(static_cast<double>(i), centre, 0.5 * bins);

  IsoEsfr result;
  const double slant = std::atan(line.slope);
  result.angle_deg = (edge.turned ? slant : -slant) * 180 / pi;
  double at_zero = 0;
  for (int k = 0; k <= edge.columns; ++k) {
    std::complex<double> value = 0;
    for (std::size_t i = 0; i < spread.size(); ++i)
      value += spread[i] * std::polar(1.0, -2 * pi * k * static_cast<double>(i) / bins);
    if (k == 0) at_zero = std::abs(value);
    if (at_zero == 0) throw InputError("the ISO method found no edge: its two sides are equally bright");
    const double phase = 2 * pi * k / bins;
    const double correction = k == 0 ? 1 : std::min(10.0, phase / std::max(1e-9, std::sin(phase)));
    const double frequency = static_cast<double>(k) / edge.columns / std::cos(slant);
    if (frequency > 1 + 1e-9) break;
    result.frequencies_cpp.push_back(frequency);
    result.sfr.push_back(std::abs(value) / at_zero * correction);
  }
  result.mtf50_cpp = NAN;
  for (std::size_t i = 1; i < result.sfr.size(); ++i)
    if (result.sfr[i] < 0.5) {
      const double t = (result.sfr[i - 1] - 0.5) / (result.sfr[i - 1] - result.sfr[i]);
      result.mtf50_cpp =
          result.frequencies_cpp[i - 1] + t * (result.frequencies_cpp[i] - result.frequencies_cpp[i - 1]);
      break;
    }
  return result;
}

}  // namespace petzval
