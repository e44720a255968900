// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/colour/rgb_to_spectrum.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// Enough for every colour of the gamut's inside; Gauss-Newton doubles the digits once it is near.
constexpr int most_steps = 30;
/// Difference in CIELAB that no eye and no 16-bit picture tells from none.
constexpr double good_enough_lab = 1e-5;
/// A step of an 8-bit grey is 0.3 to 0.4 of L*, about 0.5 in the darkest and in a* and b*.
constexpr double tenth_of_8_bit_step_lab = 0.03;
constexpr int most_steps_of_refinement = 4;
/// The colour is approached from grey in this many steps, so that every fit starts close.
constexpr int approach_steps = 4;
/// |x| of the sigmoid at which a reflectance is within 1e-5 of 0 or 1; beyond that coefficients run away.
constexpr double largest_coefficient = 2e3;

/// The cube root of CIELAB with its linear part (CIE 15), and its slope.
double lab_root(double value) {
  constexpr double delta = 6.0 / 29;
  return value > delta * delta * delta ? std::cbrt(value) : value / (3 * delta * delta) + 4.0 / 29;
}
double lab_root_slope(double value) {
  constexpr double delta = 6.0 / 29;
  return value > delta * delta * delta ? 1 / (3 * std::cbrt(value * value)) : 1 / (3 * delta * delta);
}

/// CIELAB relative to display white, and its derivative with respect to XYZ.
struct Lab {
  Eigen::Vector3d value;
  Eigen::Matrix3d slope;

  explicit Lab(const Eigen::Vector3d& xyz) {
    const Xyz white = display_white();
    const Eigen::Vector3d n(white.x, white.y, white.z);
    Eigen::Vector3d root, d;
    for (int i = 0; i < 3; ++i) {
      root[i] = lab_root(xyz[i] / n[i]);
      d[i] = lab_root_slope(xyz[i] / n[i]) / n[i];
    }
    value << 116 * root[1] - 16, 500 * (root[0] - root[1]), 200 * (root[1] - root[2]);
    slope << 0, 116 * d[1], 0, 500 * d[0], -500 * d[1], 0, 0, 200 * d[1], -200 * d[2];
  }
};

struct ColourAndSlope {
  Eigen::Vector3d xyz;
  Eigen::Matrix3d slope;
};

ColourAndSlope colour_of(const Eigen::Vector3d& c, const ReflectanceColour& under) {
  const ReflectanceColour::WithSlope colour = under.with_slope(c[0], c[1], c[2]);
  ColourAndSlope result;
  for (int i = 0; i < 3; ++i) {
    const auto row = static_cast<std::size_t>(i);
    result.xyz[i] = colour.xyz[row];
    for (int j = 0; j < 3; ++j) result.slope(i, j) = colour.slope[row][static_cast<std::size_t>(j)];
  }
  return result;
}

/// Gauss-Newton with halved steps while they make it worse (Jakob & Hanika 2019, section 3).
Eigen::Vector3d fit(Eigen::Vector3d c, const Eigen::Vector3d& wanted_lab, const ReflectanceColour& under,
                    int steps = most_steps, double good_enough = good_enough_lab) {
  ColourAndSlope colour = colour_of(c, under);
  Lab lab(colour.xyz);
  Eigen::Vector3d residual = lab.value - wanted_lab;
  for (int i = 0; i < steps && residual.norm() > good_enough; ++i) {
    const Eigen::Matrix3d jacobian = lab.slope * colour.slope;
    // A trace of damping keeps the step finite where the sigmoid saturates.
    const Eigen::Matrix3d normal = jacobian.transpose() * jacobian;
    const double damping = 1e-9 * normal.trace();
    const Eigen::Vector3d step =
        (normal + damping * Eigen::Matrix3d::Identity()).ldlt().solve(jacobian.transpose() * residual);
    bool better = false;
    for (double share = 1; share > 1e-3 && !better; share /= 2) {
      const Eigen::Vector3d trial = c - share * step;
      if (!(trial.cwiseAbs().maxCoeff() < largest_coefficient)) continue;
      const ColourAndSlope trial_colour = colour_of(trial, under);
      const Lab trial_lab(trial_colour.xyz);
      const Eigen::Vector3d trial_residual = trial_lab.value - wanted_lab;
      if (!(trial_residual.norm() < residual.norm())) continue;
      better = true;
      c = trial, colour = trial_colour, lab = trial_lab, residual = trial_residual;
    }
    if (!better) break;
  }
  return c;
}

Eigen::Vector3d lab_of(LinearRgb colour) {
  const Xyz xyz = xyz_of(colour);
  return Lab(Eigen::Vector3d(xyz.x, xyz.y, xyz.z)).value;
}

/// x of the sigmoid for a grey; infinite for black and white.
double grey_level(double value) {
  return (value - 0.5) / std::sqrt(value * (1 - value));
}

LinearRgb clamped(LinearRgb colour) {
  const auto clamp = [](double value) { return value > 0 ? std::min(value, 1.0) : 0.0; };
  return {clamp(colour.r), clamp(colour.g), clamp(colour.b)};
}

bool is_grey(LinearRgb colour) {
  return colour.r == colour.g && colour.g == colour.b;
}

double smooth_step(double x) {
  return x * x * (3 - 2 * x);
}

}  // namespace

SigmoidReflectance reflectance_of(LinearRgb colour, const ReflectanceColour& under) {
  colour = clamped(colour);
  if (is_grey(colour)) return {0, 0, grey_level(colour.r)};
  const double grey = std::clamp((colour.r + colour.g + colour.b) / 3, 0.01, 0.99);
  Eigen::Vector3d c(0, 0, grey_level(grey));
  for (int step = 1; step <= approach_steps; ++step) {
    const double share = static_cast<double>(step) / approach_steps;
    const auto between = [&](double value) { return grey + share * (value - grey); };
    c = fit(c, lab_of({between(colour.r), between(colour.g), between(colour.b)}), under);
  }
  return {c[0], c[1], c[2]};
}

const SigmoidReflectance& ReflectanceTable::node(int largest, int level, int first, int second) const {
  return nodes_[static_cast<std::size_t>(((largest * nodes + level) * nodes + first) * nodes + second)];
}

// The table is split by the largest component, whose value is one axis (finer towards black and white, where
// coefficients change fast); the other two, relative to it, are the others (Jakob & Hanika 2019,
// section 3.2).
ReflectanceTable::ReflectanceTable(const ReflectanceColour& under) : under_(under) {
  for (int i = 0; i < nodes; ++i)
    levels_[static_cast<std::size_t>(i)] =
        std::clamp(smooth_step(smooth_step(static_cast<double>(i) / (nodes - 1))), 1e-4, 1 - 1e-4);
  nodes_.resize(std::size_t{3} * nodes * nodes * nodes);
  parallel_for(std::size_t{3} * nodes * nodes, [&](std::size_t line) {
    const int largest = static_cast<int>(line) / (nodes * nodes);
    const double first = static_cast<double>(static_cast<int>(line) / nodes % nodes) / (nodes - 1);
    const double second = static_cast<double>(static_cast<int>(line) % nodes) / (nodes - 1);
    // From the middle outwards, each fit beginning where its neighbour ended.
    const auto fit_level = [&](int level, Eigen::Vector3d c) {
      const double value = levels_[static_cast<std::size_t>(level)];
      std::array<double, 3> rgb{};
      rgb[static_cast<std::size_t>(largest)] = value;
      rgb[static_cast<std::size_t>((largest + 1) % 3)] = first * value;
      rgb[static_cast<std::size_t>((largest + 2) % 3)] = second * value;
      c = fit(c, lab_of({rgb[0], rgb[1], rgb[2]}), under_);
      const std::size_t at = static_cast<std::size_t>(largest * nodes + level) * nodes * nodes +
                             line % (std::size_t{nodes} * nodes);
      nodes_[at] = {c[0], c[1], c[2]};
      return c;
    };
    std::array<double, 3> middle{};
    const double value = levels_[nodes / 2];
    middle[static_cast<std::size_t>(largest)] = value;
    middle[static_cast<std::size_t>((largest + 1) % 3)] = first * value;
    middle[static_cast<std::size_t>((largest + 2) % 3)] = second * value;
    SigmoidReflectance start = reflectance_of({middle[0], middle[1], middle[2]}, under_);
    if (!std::isfinite(start.c2)) start = {};
    Eigen::Vector3d c(start.c0, start.c1, start.c2);
    for (int level = nodes / 2; level < nodes; ++level) c = fit_level(level, c);
    c = Eigen::Vector3d(start.c0, start.c1, start.c2);
    for (int level = nodes / 2 - 1; level >= 0; --level) c = fit_level(level, c);
  });
}

SigmoidReflectance ReflectanceTable::operator()(LinearRgb colour) const {
  colour = clamped(colour);
  if (is_grey(colour)) return {0, 0, grey_level(colour.r)};
  const std::array<double, 3> rgb{colour.r, colour.g, colour.b};
  const int largest = static_cast<int>(std::max_element(rgb.begin(), rgb.end()) - rgb.begin());
  const double value = rgb[static_cast<std::size_t>(largest)];
  const auto place = [](double at, int& low) {
    low = std::min(static_cast<int>(at), nodes - 2);
    return at - low;
  };
  int first = 0, second = 0;
  const double s = place(rgb[static_cast<std::size_t>((largest + 1) % 3)] / value * (nodes - 1), first);
  const double t = place(rgb[static_cast<std::size_t>((largest + 2) % 3)] / value * (nodes - 1), second);
  const auto above = std::upper_bound(levels_.begin(), levels_.end(), value);
  const int level = std::clamp(static_cast<int>(above - levels_.begin()) - 1, 0, nodes - 2);
  const double low = levels_[static_cast<std::size_t>(level)],
               high = levels_[static_cast<std::size_t>(level) + 1];
  const double u = std::clamp((value - low) / (high - low), 0.0, 1.0);

  SigmoidReflectance sum;
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
    const double weight = (i ? u : 1 - u) * (j ? s : 1 - s) * (k ? t : 1 - t);
    const SigmoidReflectance& at = node(largest, level + i, first + j, second + k);
    sum.c0 += weight * at.c0, sum.c1 += weight * at.c1, sum.c2 += weight * at.c2;
  }
  return sum;
}

SigmoidReflectance ReflectanceTable::refined(LinearRgb colour) const {
  colour = clamped(colour);
  const SigmoidReflectance near = (*this)(colour);
  if (is_grey(colour)) return near;
  const Eigen::Vector3d c = fit({near.c0, near.c1, near.c2}, lab_of(colour), under_, most_steps_of_refinement,
                                tenth_of_8_bit_step_lab);
  return {c[0], c[1], c[2]};
}

}  // namespace petzval
