// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/measure/sfr/edge_line.h>
#include <petzval/measure/sfr/logistic_lanes.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace petzval {

namespace {

using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

/// Mean place and value, and the plane through the values.
struct Overview {
  double x = 0, y = 0, value = 0, slope_x = 0, slope_y = 0, radius = 0;
};

Overview overview_of(std::span<const EdgeSample> samples) {
  Overview o;
  const double n = static_cast<double>(samples.size());
  for (const EdgeSample& s : samples) o.x += s.x / n, o.y += s.y / n, o.value += s.value / n;
  double xx = 0, xy = 0, yy = 0, xv = 0, yv = 0, farthest2 = 0;
  for (const EdgeSample& s : samples) {
    const double x = s.x - o.x, y = s.y - o.y, v = s.value - o.value;
    xx += x * x, xy += x * y, yy += y * y, xv += x * v, yv += y * v;
    farthest2 = std::max(farthest2, x * x + y * y);
  }
  o.radius = std::sqrt(farthest2);
  const double determinant = xx * yy - xy * xy;
  if (determinant > 0) {
    o.slope_x = (xv * yy - yv * xy) / determinant;
    o.slope_y = (yv * xx - xv * xy) / determinant;
  }
  return o;
}

/// Direction in which the values change most: of the structure tensor of differences to the right and lower
/// neighbour. Samples come row by row.
double gradient_direction(std::span<const EdgeSample> samples, double spacing, const Overview& o) {
  double xx = 0, xy = 0, yy = 0;
  std::size_t below = 0;
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    const EdgeSample& s = samples[i];
    const EdgeSample& right = samples[i + 1];
    if (right.y != s.y || right.x - s.x > 1.5 * spacing) continue;
    while (below < samples.size() && (samples[below].y < s.y + 0.5 * spacing ||
                                      (samples[below].y < s.y + 1.5 * spacing && samples[below].x < s.x)))
      ++below;
    if (below == samples.size() || samples[below].x != s.x) continue;
    const double gx = right.value - s.value, gy = samples[below].value - s.value;
    xx += gx * gx, xy += gx * gy, yy += gy * gy;
  }
  double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  if (std::cos(angle) * o.slope_x + std::sin(angle) * o.slope_y < 0) angle += pi;
  return angle;
}

/// Parameters: offset from the mean place along the normal, direction, log of the scale, dark, bright.
class LogisticFit {
 public:
  LogisticFit(std::span<const EdgeSample> samples, const Overview& o) {
    constexpr std::size_t together = 8;
    const std::size_t size = (samples.size() + together - 1) / together * together;
    for (std::vector<double>* each : {&samples_.x, &samples_.y, &samples_.value, &samples_.weight})
      each->resize(size);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      samples_.x[i] = samples[i].x - o.x, samples_.y[i] = samples[i].y - o.y;
      samples_.value[i] = samples[i].value, samples_.weight[i] = 1;
    }
  }

  double cost(const Vector5& p) const { return sums_at(p).square; }

  /// \param least_gain  of a step, as a share of the cost; with less it ends.
  Vector5 run(Vector5 p, double least_gain) const {
    double damping = 1e-3;
    LogisticSums best = sums_at(p);
    for (int step = 0; step < 80; ++step) {
      bool improved = false;
      double gain = 0;
      for (int attempt = 0; attempt < 12 && !improved; ++attempt) {
        const Vector5 next = p + change(best, damping);
        if (next.allFinite() && std::abs(next[2]) < 12)
          if (const LogisticSums sums = sums_at(next); sums.square < best.square) {
            gain = best.square - sums.square;
            p = next, best = sums, damping *= 0.2, improved = true;
            continue;
          }
        damping *= 6;
      }
      if (!improved || gain < least_gain * best.square) break;
    }
    return p;
  }

 private:
  LogisticSums sums_at(const Vector5& p) const {
    return logistic_sums(samples_, {p[0], p[1], p[2], p[3], p[4]});
  }

  static Vector5 change(const LogisticSums& sums, double damping) {
    Matrix5 damped;
    auto product = sums.normal.begin();
    for (int r = 0; r < 5; ++r)
      for (int k = 0; k <= r; ++k) damped(r, k) = damped(k, r) = *product++;
    damped.diagonal() *= 1 + damping;
    damped.diagonal().array() += 1e-300;
    return damped.ldlt().solve(Eigen::Map<const Vector5>(sums.right.data()));
  }

  LogisticSamples samples_;
};

/// Enough samples for a guess, evenly taken but not in step with the rows.
std::vector<EdgeSample> thinned(std::span<const EdgeSample> samples, std::size_t enough) {
  if (samples.size() <= enough) return {samples.begin(), samples.end()};
  std::vector<EdgeSample> few;
  few.reserve(enough + enough / 8);
  const double share = static_cast<double>(enough) / static_cast<double>(samples.size());
  constexpr std::uint32_t spread = 2654435761;  // 2³² over the golden ratio (Knuth, TAOCP 3, section 6.4)
  const auto limit = static_cast<std::uint32_t>(share * 4294967295.0);
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (static_cast<std::uint32_t>(i) * spread < limit) few.push_back(samples[i]);
  return few;
}

/// Most of them from where an edge is expected; the rest tell the levels.
std::vector<EdgeSample> thinned_about(std::span<const EdgeSample> samples, const EdgeLine& line) {
  constexpr double near_px = 8;
  constexpr std::size_t most_near = 500, most_far = 250;
  const EdgeFrame frame(line);
  std::vector<EdgeSample> near, far;
  for (const EdgeSample& s : samples)
    (std::abs(frame.at(s.x, s.y).distance) < near_px ? near : far).push_back(s);
  std::vector<EdgeSample> few = thinned(near, most_near);
  far = thinned(far, most_far);
  few.insert(few.end(), far.begin(), far.end());
  return few;
}

/// A start of the fit, and the values' fifth and ninety-fifth percentile.
struct SideLevels {
  double dark = 0, bright = 0;
};

SideLevels levels_of(const std::vector<EdgeSample>& samples) {
  std::vector<double> values;
  values.reserve(samples.size());
  for (const EdgeSample& s : samples) values.push_back(s.value);
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  if (!(*most > *least)) throw InputError("all values are equal: there is no edge");
  const auto rank = [&](std::size_t place) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(place);
    std::nth_element(values.begin(), at, values.end());
    return *at;
  };
  return {rank(values.size() / 20), rank(values.size() - 1 - values.size() / 20)};
}

/// The guess that a fit has come to. \throws InputError as guess_edge().
EdgeGuess guess_of(Vector5 fitted, double cost, std::size_t fitted_samples, const Overview& o,
                   std::span<const EdgeSample> samples, double spacing) {
  if (fitted[4] < fitted[3]) {
    std::swap(fitted[3], fitted[4]);
    fitted[0] = -fitted[0];
    fitted[1] += pi;
  }
  EdgeGuess guess;
  guess.line.normal_rad = std::remainder(fitted[1], 2 * pi);
  guess.line.centre_x = o.x + fitted[0] * std::cos(fitted[1]);
  guess.line.centre_y = o.y + fitted[0] * std::sin(fitted[1]);
  guess.dark = fitted[3];
  guess.bright = fitted[4];
  guess.scale_px = std::exp(fitted[2]);
  guess.rms_residual = std::sqrt(cost / static_cast<double>(fitted_samples));
  if (!(guess.bright - guess.dark > 4 * guess.rms_residual))
    throw InputError(fmt::format("no edge stands out: a step of {:.3g} among differences of {:.3g} from it",
                                 guess.bright - guess.dark, guess.rms_residual));
  double low = 0, high = 0, farthest = 1;
  const EdgeFrame frame(guess.line);
  for (const EdgeSample& s : samples) {
    const EdgeFrame::Place place = frame.at(s.x, s.y);
    low = std::min(low, place.distance), high = std::max(high, place.distance);
    farthest = std::max(farthest, std::abs(place.along));  // half_length is 1 so far
  }
  guess.line.half_length = farthest;
  if (std::min(-low, high) < 2 * spacing)
    throw InputError("the edge runs along the rim; there must be pixels on both of its sides");
  return guess;
}

}  // namespace

EdgeFrame::EdgeFrame(const EdgeLine& line)
    : line_(line),
      cos_(std::cos(line.normal_rad)),
      sin_(std::sin(line.normal_rad)),
      per_half_length_(1 / line.half_length),
      bent_(std::any_of(line.bend.begin(), line.bend.end(), [](double b) { return b != 0; })) {}

EdgeFrame::Place EdgeFrame::unbent(Place place) const {
  double offset = 0, slope = 0, power = 1;
  for (std::size_t k = 0; k < line_.bend.size(); ++k) {
    slope += static_cast<double>(k + 1) * line_.bend[k] * power * per_half_length_;
    offset += line_.bend[k] * (power *= place.along);
  }
  place.distance = (place.distance - offset) / std::sqrt(1 + slope * slope);
  return place;
}

double EdgeLine::along(double x, double y) const {
  return EdgeFrame(*this).at(x, y).along;
}

double EdgeLine::distance(double x, double y) const {
  return EdgeFrame(*this).at(x, y).distance;
}

double EdgeLine::angle_deg() const {
  const double slope = bend.empty() ? 0 : std::atan(bend[0] / half_length);
  double angle = (normal_rad - slope) * 180 / pi;
  angle -= 90 * std::round(angle / 90);
  return angle;
}

double EdgeLine::radius_px() const {
  return bend.size() < 2 || bend[1] == 0 ? HUGE_VAL : half_length * half_length / (2 * std::abs(bend[1]));
}

EdgeGuess guess_edge(std::span<const EdgeSample> samples, double spacing) {
  const Overview o = overview_of(samples);
  const std::vector<EdgeSample> few = thinned(samples, 20000);
  const SideLevels levels = levels_of(few);
  const LogisticFit fit(few, o);
  Vector5 best = Vector5::Zero();
  double best_cost = HUGE_VAL;
  for (const double direction : {gradient_direction(samples, spacing, o), std::atan2(o.slope_y, o.slope_x)})
    for (const double scale : {0.5, 4.0}) {
      Vector5 start;
      start << 0, direction, std::log(scale * spacing), levels.dark, levels.bright;
      const Vector5 end = fit.run(start, 1e-12);
      const double cost = fit.cost(end);
      if (cost < best_cost) best_cost = cost, best = end;
    }
  return guess_of(best, best_cost, few.size(), o, samples, spacing);
}

EdgeGuess guess_edge(std::span<const EdgeSample> samples, const EdgeLine& start) {
  const Overview o = overview_of(samples);
  const std::vector<EdgeSample> few = thinned_about(samples, start);
  const SideLevels levels = levels_of(few);
  const LogisticFit fit(few, o);
  Vector5 at;
  at << -start.distance(o.x, o.y), start.normal_rad, 0, levels.dark, levels.bright;
  // The start is near, and what follows starts from here in turn.
  const Vector5 end = fit.run(at, 1e-5);
  return guess_of(end, fit.cost(end), few.size(), o, samples, 1);
}

}  // namespace petzval
