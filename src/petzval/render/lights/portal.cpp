// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/stop.h>
#include <petzval/base/units.h>
#include <petzval/render/lights/portal.h>

#include <algorithm>
#include <cmath>

namespace petzval::render {

WindowedDistribution::WindowedDistribution(std::vector<double> weights, int side)
    : side_(side), weights_(std::move(weights)) {
  const auto n = static_cast<std::size_t>(side);
  sums_.assign((n + 1) * (n + 1), 0);
  for (std::size_t row = 0; row < n; ++row) {
    double along = 0;
    for (std::size_t column = 0; column < n; ++column) {
      along += weights_[row * n + column];
      sums_[(row + 1) * (n + 1) + column + 1] = sums_[row * (n + 1) + column + 1] + along;
    }
  }
}

/// Up to a place in cells, linear between their edges.
double WindowedDistribution::sum_to(double across, double down) const {
  const auto n = static_cast<std::size_t>(side_);
  const auto column = std::min(static_cast<std::size_t>(std::max(0.0, across)), n - 1),
             row = std::min(static_cast<std::size_t>(std::max(0.0, down)), n - 1);
  const double right = across - static_cast<double>(column), below = down - static_cast<double>(row);
  const double* at = &sums_[row * (n + 1) + column];
  return (1 - below) * ((1 - right) * at[0] + right * at[1]) +
         below * ((1 - right) * at[n + 1] + right * at[n + 2]);
}

double WindowedDistribution::sum(double left, double right, double top, double bottom) const {
  return std::max(0.0, sum_to(right, bottom) - sum_to(left, bottom) - sum_to(right, top) + sum_to(left, top));
}

double WindowedDistribution::integral(const SquareWindow& w) const {
  const double n = side_;
  return sum(n * w.low[0], n * w.high[0], n * w.low[1], n * w.high[1]) / (n * n);
}

double WindowedDistribution::weight(double u, double v) const {
  const auto cell = [&](double at) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>(at * side_), 0, side_ - 1));
  };
  return weights_[cell(v) * static_cast<std::size_t>(side_) + cell(u)];
}

namespace {

/// Where a sum that grows from `low` to `high`, linear between whole numbers, has come to a share of its end.
template <class Sum>
double place_of(double low, double high, double share, const Sum& sum_to) {
  const double wanted = share * sum_to(high);
  const int first = static_cast<int>(std::floor(low)) + 1, end = static_cast<int>(std::ceil(high));
  int above = first, beyond = std::max(first, end);  // the first edge of cells with a sum above
  while (above < beyond) {
    const int middle = (above + beyond) / 2;
    if (sum_to(middle) > wanted)
      beyond = middle;
    else
      above = middle + 1;
  }
  const double left = above > first ? above - 1 : low, right = above < end ? above : high;
  const double at_left = sum_to(left), at_right = sum_to(right);
  const double within = at_right > at_left ? (wanted - at_left) / (at_right - at_left) : 0.5;
  return left + std::clamp(within, 0.0, 1.0) * (right - left);
}

}  // namespace

WindowedDistribution::Point WindowedDistribution::sample(const SquareWindow& w, double u, double v) const {
  const double n = side_;
  const double left = n * w.low[0], right = n * w.high[0], top = n * w.low[1], bottom = n * w.high[1];
  const double across = place_of(left, right, u, [&](double x) { return sum(left, x, top, bottom); });
  const double column = std::floor(std::min(across, n - 1));
  const double from = std::max(left, column), to = std::min(right, column + 1);
  const double down = place_of(top, bottom, v, [&](double y) { return sum(from, to, top, y); });
  return {across / n, down / n};
}

Portal::Portal(const std::array<Vector3, 4>& corners) : corners_(corners) {
  const Vector3 x = corners[3] - corners[0], y = corners[1] - corners[0];
  wide_ = length(x), high_ = length(y);
  constexpr double slack = 1e-3;  // of a side: pbrt-v4's
  const Vector3 off = corners[2] - corners[0] - x - y;
  if (!(wide_ > 0 && high_ > 0 && std::isfinite(wide_ * high_)) ||
      !(std::abs(dot(x, y)) <= slack * wide_ * high_) || !(length(off) <= slack * std::max(wide_, high_)))
    throw InputError("these corners are no rectangle; four of one in turn would be right");
  x_ = normalised(x), z_ = normalised(cross(x, y)), y_ = cross(z_, x_);
}

std::optional<SquareWindow> Portal::window(Vector3 from) const {
  const Vector3 to = corners_[0] - from;
  const double away = dot(to, z_), left = dot(to, x_), below = dot(to, y_);
  if (!(away > 0)) return {};
  const auto place = [&](double at) { return std::atan(at / away) / pi + 0.5; };
  return SquareWindow{{place(left), place(below)}, {place(left + wide_), place(below + high_)}};
}

bool Portal::lets_out(Vector3 origin, Vector3 direction) const {
  const Vector3 to = corners_[0] - origin;
  const double away = dot(to, z_), along = dot(direction, z_);
  if (!(away > 0 && along > 0)) return false;
  const Vector3 met = away / along * direction - to;
  const double right = dot(met, x_), up = dot(met, y_);
  return right >= 0 && right <= wide_ && up >= 0 && up <= high_;
}

namespace {

/// Solid angle over area of the rectified square, by the tangents of the two angles.
double per_square(double a, double b) {
  const double root = std::sqrt(1 + a * a + b * b);
  return pi * pi * (1 + a * a) * (1 + b * b) / (root * root * root);
}

double tangent(double place) {
  constexpr double nearly = 1e-9;  // of a half turn from the plane of the portal
  return std::tan(pi * (std::clamp(place, nearly, 1 - nearly) - 0.5));
}

}  // namespace

Vector3 Portal::direction_at(double u, double v) const {
  return normalised(tangent(u) * x_ + tangent(v) * y_ + z_);
}

void Portal::rectify(int side, const std::function<double(Vector3)>& luminance,
                     const std::vector<Vector3>& bright) {
  const auto n = static_cast<std::size_t>(side);
  std::vector<double> seen(n * n);
  double mean = 0;
  for (std::size_t row = 0; row < n; ++row) {
    check_stop();
    for (std::size_t column = 0; column < n; ++column) {
      double& each = seen[row * n + column];
      for (const double down : {0.25, 0.75})
        for (const double across : {0.25, 0.75})
          each += luminance(direction_at((static_cast<double>(column) + across) / side,
                                         (static_cast<double>(row) + down) / side)) /
                  4;
      mean += each / static_cast<double>(n * n);
    }
  }
  for (const Vector3 direction : bright) {
    const double along = dot(direction, z_);
    if (!(along > 0)) continue;
    const auto cell = [&](Vector3 axis) {
      const double place = std::atan(dot(direction, axis) / along) / pi + 0.5;
      return static_cast<std::size_t>(std::clamp(static_cast<int>(place * side), 0, side - 1));
    };
    double& each = seen[cell(y_) * n + cell(x_)];
    each = std::max(each, luminance(direction));
  }
  constexpr double least = 0.02;  // of the mean, so that nothing is missed that falls between
  for (std::size_t row = 0; row < n; ++row)
    for (std::size_t column = 0; column < n; ++column) {
      double& each = seen[row * n + column];
      each = std::max(each, least * mean) * per_square(tangent((static_cast<double>(column) + 0.5) / side),
                                                       tangent((static_cast<double>(row) + 0.5) / side));
    }
  map_.emplace(std::move(seen), side);
}

double Portal::fluence(Vector3 from) const {
  const auto seen = window(from);
  return seen ? map_->integral(*seen) : 0;
}

double Portal::irradiance(Vector3 from, Vector3 normal, bool both_sides) const {
  double cosine = 0;
  const auto look = [&](Vector3 place) {
    const double each = dot(normalised(place - from), normal);
    cosine = std::max(cosine, both_sides ? std::abs(each) : each);
  };
  for (const Vector3 corner : corners_) look(corner);
  look(0.5 * (corners_[0] + corners_[2]));
  return cosine > 0 ? cosine * fluence(from) : 0;
}

Portal::Sample Portal::sample(Vector3 from, double u, double v) const {
  const auto seen = window(from);
  if (!seen || !(map_->integral(*seen) > 0)) return {};
  const WindowedDistribution::Point point = map_->sample(*seen, u, v);
  const Vector3 direction = direction_at(point.u, point.v);
  return {direction, pdf(from, direction)};
}

double Portal::pdf(Vector3 from, Vector3 direction) const {
  const double along = dot(direction, z_);
  const auto seen = window(from);
  if (!seen || !lets_out(from, direction)) return 0;
  const double all = map_->integral(*seen);
  const double a = dot(direction, x_) / along, b = dot(direction, y_) / along;
  const double density = map_->weight(std::atan(a) / pi + 0.5, std::atan(b) / pi + 0.5) / per_square(a, b);
  return all > 0 ? density / all : 0;
}

}  // namespace petzval::render
