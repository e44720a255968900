// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/measure/sfr/frame_sharpness.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

/// Share of the half diagonal over which edges count for a place: most at it, nothing beyond.
constexpr double neighbourhood = 0.4;
/// The square of a deviation below which edges count alike: what a lens changes by within a neighbourhood.
constexpr double least_deviation_cpp = 0.003;

double tricube(double share) {
  const double rest = 1 - share * share * share;
  return share < 1 ? rest * rest * rest : 0;
}

/// The value at the origin of the plane through weighted values, a constant where they do not span one.
template <int terms>
class LocalFit {
 public:
  void add(double weight, const Eigen::Matrix<double, terms, 1>& row, double value) {
    normal_ += weight * row * row.transpose();
    right_ += weight * value * row;
  }
  double at_origin() const {
    if (!(normal_(0, 0) > 0)) return std::numeric_limits<double>::quiet_NaN();
    // Slopes that the places hardly tell are held down.
    Eigen::Matrix<double, terms, terms> held = normal_;
    for (int k = 1; k < terms; ++k) held(k, k) += 1e-3 * normal_(0, 0);
    return held.ldlt().solve(right_)[0];
  }

 private:
  Eigen::Matrix<double, terms, terms> normal_ = Eigen::Matrix<double, terms, terms>::Zero();
  Eigen::Matrix<double, terms, 1> right_ = Eigen::Matrix<double, terms, 1>::Zero();
};

double weight_of(const EdgeInFrame& edge) {
  return 1 / (least_deviation_cpp * least_deviation_cpp + edge.deviation_cpp * edge.deviation_cpp);
}

double greatest_height(std::span<const EdgeInFrame> edges) {
  double height = 1;
  for (const EdgeInFrame& edge : edges) height = std::max(height, edge.height_px);
  return height;
}

}  // namespace

std::vector<EdgeInFrame> edges_in_frame(std::span<const MeasuredEdge> edges, int columns, int rows) {
  std::vector<EdgeInFrame> placed;
  for (const MeasuredEdge& edge : edges) {
    if (!std::isfinite(edge.mtf50())) continue;
    const EdgeLine& line = edge.exact.line;
    EdgeInFrame at;
    at.x_px = line.centre_x - 0.5 * columns, at.y_px = 0.5 * rows - line.centre_y;
    at.height_px = std::hypot(at.x_px, at.y_px);
    // In the picture y runs down.
    const double nx = std::cos(line.normal_rad), ny = -std::sin(line.normal_rad);
    at.outward = at.height_px > 0 ? (nx * at.x_px + ny * at.y_px) / at.height_px : 0;
    constexpr double within = 0.8660254037844386;  // cos 30°
    const double along = std::sqrt(std::max(0.0, 1 - at.outward * at.outward));
    at.direction = std::abs(at.outward) >= within ? EdgeDirection::meridional
                   : along >= within              ? EdgeDirection::sagittal
                                                  : EdgeDirection::oblique;
    at.mtf50_cpp = edge.mtf50();
    at.deviation_cpp = edge.iso ? 0 : edge.exact.mtf50().deviation_cpp;
    if (!std::isfinite(at.deviation_cpp)) at.deviation_cpp = 0;
    at.channel = edge.channel;
    at.lateral_offset_px = edge.lateral_offset_px;
    placed.push_back(at);
  }
  return placed;
}

SharpnessSurface sharpness_surface(std::span<const EdgeInFrame> edges, int columns, int rows) {
  if (columns < 1 || rows < 1) throw InputError("a picture without pixels has no sharpness");
  constexpr int across = 60;
  SharpnessSurface surface;
  const double cell = static_cast<double>(std::max(columns, rows)) / across;
  surface.columns = std::max(1, static_cast<int>(std::lround(columns / cell)));
  surface.rows = std::max(1, static_cast<int>(std::lround(rows / cell)));
  const double reach = neighbourhood * 0.5 * std::hypot(columns, rows);
  for (int r = 0; r < surface.rows; ++r)
    for (int c = 0; c < surface.columns; ++c) {
      const double x = ((c + 0.5) / surface.columns - 0.5) * columns,
                   y = (0.5 - (r + 0.5) / surface.rows) * rows;
      LocalFit<3> fit;
      double nearest = 1;
      for (const EdgeInFrame& edge : edges) {
        const double dx = (edge.x_px - x) / reach, dy = (edge.y_px - y) / reach;
        nearest = std::min(nearest, std::hypot(dx, dy));
        const double weight = tricube(std::hypot(dx, dy)) * weight_of(edge);
        if (weight > 0) fit.add(weight, {1, dx, dy}, edge.mtf50_cpp);
      }
      constexpr double near_enough = 0.6;
      surface.mtf50_cpp.push_back(nearest < near_enough ? static_cast<float>(fit.at_origin())
                                                        : std::numeric_limits<float>::quiet_NaN());
    }
  return surface;
}

std::vector<double> sharpness_over_height(std::span<const EdgeInFrame> edges,
                                          std::span<const double> heights_px) {
  const double reach = 0.5 * neighbourhood * greatest_height(edges);
  std::vector<double> values;
  for (const double height : heights_px) {
    LocalFit<2> fit;
    double nearest = 1;
    for (const EdgeInFrame& edge : edges) {
      const double d = (edge.height_px - height) / reach, weight = tricube(std::abs(d)) * weight_of(edge);
      nearest = std::min(nearest, std::abs(d));
      if (weight > 0) fit.add(weight, {1, d}, edge.mtf50_cpp);
    }
    values.push_back(nearest < 1 ? fit.at_origin() : std::numeric_limits<double>::quiet_NaN());
  }
  return values;
}

std::optional<LateralColour> lateral_colour(std::span<const EdgeInFrame> edges, const std::string& channel,
                                            double half_diagonal_px) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  LateralColour result;
  double square = 0;
  for (const EdgeInFrame& edge : edges) {
    if (edge.channel != channel || !edge.lateral_offset_px) continue;
    const double h = edge.height_px / half_diagonal_px;
    const Eigen::Vector2d row{edge.outward * h, edge.outward * h * h * h};
    normal += row * row.transpose();
    right += *edge.lateral_offset_px * row;
    square += *edge.lateral_offset_px * *edge.lateral_offset_px;
    ++result.edges;
  }
  constexpr std::size_t least = 4;
  if (result.edges < least) return std::nullopt;
  // With edges at one height only, the cubic part is nothing.
  normal.diagonal() += Eigen::Vector2d(1e-12, 1e-9) * (normal.trace() + 1e-300);
  const Eigen::Vector2d solution = normal.ldlt().solve(right);
  result.linear_px = solution[0], result.cubic_px = solution[1];
  const double rest = square - 2 * solution.dot(right) + solution.dot(normal * solution);
  result.rms_residual_px = std::sqrt(std::max(0.0, rest) / static_cast<double>(result.edges));
  return result;
}

}  // namespace petzval
