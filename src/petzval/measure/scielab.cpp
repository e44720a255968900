// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/colour/cielab.h>
#include <petzval/colour/display.h>
#include <petzval/measure/scielab.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace petzval {

namespace {

using Samples = std::vector<float>;

/// Opponent channels (light-dark, red-green, blue-yellow) from XYZ, Poirson & Wandell as in the paper's
/// appendix.
constexpr ColourMatrix opponent_from_xyz = {
    {{0.279, 0.720, -0.107}, {-0.449, 0.290, -0.077}, {0.086, -0.590, 0.501}}};

struct Gaussian {
  double weight, spread_deg;  ///< exp(−r²/spread²)
};
// Table of the paper; weights are scaled so that each channel's sum is 1.
const std::vector<Gaussian> filters[] = {{{0.921, 0.0283}, {0.105, 0.133}, {-0.108, 4.336}},
                                         {{0.531, 0.0392}, {0.330, 0.494}},
                                         {{0.488, 0.0536}, {0.371, 0.386}}};

std::vector<float> kernel(double spread_px) {
  constexpr double reach = 2.5;  // exp(−6.25): 2e-3 of the middle
  const int radius = std::max(1, static_cast<int>(std::ceil(reach * spread_px)));
  std::vector<float> weights;
  float sum = 0;
  for (int i = -radius; i <= radius; ++i) {
    weights.push_back(static_cast<float>(std::exp(-(i / spread_px) * (i / spread_px))));
    sum += weights.back();
  }
  for (float& weight : weights) weight /= sum;
  return weights;
}

/// Along rows, result transposed: twice gives both directions. The picture is mirrored at its edges, again
/// and again where a filter is wider than the picture.
Samples blurred_transposed(const Samples& plane, int columns, int rows, const std::vector<float>& weights) {
  Samples result(plane.size());
  const int radius = static_cast<int>(weights.size()) / 2;
  std::vector<int> source;
  for (int i = -radius; i < columns + radius; ++i) {
    const int turn = ((i % (2 * columns)) + 2 * columns) % (2 * columns);
    source.push_back(turn < columns ? turn : 2 * columns - 1 - turn);
  }
  parallel_for(static_cast<std::size_t>(rows), [&](std::size_t row) {
    const float* in = plane.data() + row * static_cast<std::size_t>(columns);
    std::vector<float> line;
    for (const int from : source) line.push_back(in[from]);
    for (int c = 0; c < columns; ++c) {
      float sum = 0;
      for (std::size_t k = 0; k < weights.size(); ++k)
        sum += weights[k] * line[static_cast<std::size_t>(c) + k];
      result[static_cast<std::size_t>(c) * static_cast<std::size_t>(rows) + row] = sum;
    }
  });
  return result;
}

Samples seen(const Samples& plane, int columns, int rows, const std::vector<Gaussian>& gaussians,
             double per_degree) {
  double total = 0;
  for (const Gaussian& gaussian : gaussians) total += gaussian.weight;
  Samples sum(plane.size());
  for (const Gaussian& gaussian : gaussians) {
    const std::vector<float> weights = kernel(gaussian.spread_deg * per_degree);
    const Samples part =
        blurred_transposed(blurred_transposed(plane, columns, rows, weights), rows, columns, weights);
    const auto share = static_cast<float>(gaussian.weight / total);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += share * part[i];
  }
  return sum;
}

/// The picture as it is seen, in CIELAB.
std::vector<Lab> seen_lab(const ViewedPicture& picture, double per_degree) {
  std::array<Samples, 3> planes;
  for (const Xyz& pixel : picture.pixels) {
    const Xyz opponent = opponent_from_xyz * pixel;
    planes[0].push_back(static_cast<float>(opponent.x));
    planes[1].push_back(static_cast<float>(opponent.y));
    planes[2].push_back(static_cast<float>(opponent.z));
  }
  for (std::size_t k = 0; k < 3; ++k)
    planes[k] = seen(planes[k], picture.columns, picture.rows, filters[k], per_degree);
  const ColourMatrix back = inverse(opponent_from_xyz);
  std::vector<Lab> lab;
  for (std::size_t i = 0; i < picture.pixels.size(); ++i)
    lab.push_back(cielab(back * Xyz{static_cast<double>(planes[0][i]), static_cast<double>(planes[1][i]),
                                    static_cast<double>(planes[2][i])},
                         display_white()));
  return lab;
}

}  // namespace

double pixels_per_degree(double distance_mm, double pixel_pitch_um) {
  return 2 * distance_mm * std::tan(radians(0.5)) / (pixel_pitch_um * mm_per_um);
}

ScielabDifference scielab(const ViewedPicture& a, const ViewedPicture& b, double per_degree) {
  if (a.columns != b.columns || a.rows != b.rows)
    throw InputError(fmt::format("pictures of {} x {} and {} x {} pixels cannot be compared", a.columns,
                                 a.rows, b.columns, b.rows));
  constexpr double coarsest = 4, finest = 1000;
  if (!(per_degree >= coarsest && per_degree <= finest))
    throw InputError(
        fmt::format("{:.3g} pixels a degree; {:g} to {:g} would be right", per_degree, coarsest, finest));
  const std::vector<Lab> seen_a = seen_lab(a, per_degree), seen_b = seen_lab(b, per_degree);
  ScielabDifference result{a.columns, a.rows, {}, 0, 0, 0};
  for (std::size_t i = 0; i < seen_a.size(); ++i) {
    const double difference = delta_e_ab(seen_a[i], seen_b[i]);
    result.delta_e.push_back(static_cast<float>(difference));
    result.mean += difference / static_cast<double>(seen_a.size());
    result.max = std::max(result.max, difference);
  }
  std::vector<float> sorted = result.delta_e;
  const auto nth =
      sorted.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), nth, sorted.end());
  result.percentile_95 = static_cast<double>(*nth);
  return result;
}

}  // namespace petzval
