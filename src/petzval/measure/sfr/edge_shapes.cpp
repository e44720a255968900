// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/measure/sfr/edge_shapes.h>
#include <petzval/numeric/quadrature.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace petzval {

namespace {

/// The edge of a circular pupil of cut-off frequency 1: E(u) = ½ + ∫₀¹ M(ν) sin(2πνu)/(πν) dν and its
/// derivative, M the MTF.
class CircularPupilEdge {
 public:
  static const CircularPupilEdge& table() {
    static const CircularPupilEdge made;
    return made;
  }

  struct At {
    double value, slope;
  };
  At operator()(double u) const {
    const double size = std::abs(u), at = size * per_unit;
    At result{};
    if (at >= intervals) {  // 1 − A/u
      const double rest = (1 - value_.back()) * farthest / size;
      result = {1 - rest, rest / size};
    } else {
      const auto i = static_cast<std::size_t>(at);
      const double t = at - static_cast<double>(i), h = 1.0 / per_unit,
                   difference = value_[i + 1] - value_[i];
      // Hermite's cubic through values and slopes.
      const double a = h * slope_[i] - difference, c = difference - h * slope_[i + 1];
      result.value = value_[i] + t * (difference + (1 - t) * (a * (1 - t) + c * t));
      result.slope = per_unit * (difference + (1 - 2 * t) * (a * (1 - t) + c * t) + t * (1 - t) * (c - a));
    }
    if (u < 0) result.value = 1 - result.value;
    return result;
  }

 private:
  static constexpr int farthest = 64, per_unit = 32, intervals = farthest * per_unit;

  CircularPupilEdge() : value_(intervals + 1, 0.5), slope_(intervals + 1, 0) {
    // Half a turn a node at the farthest, and as much again for what M does at its end.
    const QuadratureRule rule = gauss_legendre(4 * farthest);
    for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
      const double nu = rule.nodes[k], mtf = 2 / pi * (std::acos(nu) - nu * std::sqrt(1 - nu * nu));
      const double weight = rule.weights[k] * mtf, turn = 2 * pi * nu / per_unit;
      for (int i = 0; i <= intervals; ++i) {
        const auto at = static_cast<std::size_t>(i);
        value_[at] += weight * std::sin(turn * i) / (pi * nu);
        slope_[at] += 2 * weight * std::cos(turn * i);
      }
    }
  }

  std::vector<double> value_, slope_;
};

double sinc(double x) {
  return x == 0 ? 1 : std::sin(pi * x) / (pi * x);
}

double photosite_mtf(double frequency_cpp, double normal_rad) {
  return sinc(frequency_cpp * std::cos(normal_rad)) * sinc(frequency_cpp * std::sin(normal_rad));
}

/// Where the MTF of a circular pupil, times its cut-off frequency, is this.
double circular_frequency(double contrast) {
  double low = 0, high = 1;
  for (int i = 0; i < 50; ++i) {
    const double nu = 0.5 * (low + high);
    (2 / pi * (std::acos(nu) - nu * std::sqrt(1 - nu * nu)) > contrast ? low : high) = nu;
  }
  return 0.5 * (low + high);
}

/// Contrast that a photosite must leave for a PSF to be told from none.
constexpr double most_of_photosite = 0.95;

}  // namespace

bool EdgeShapes::possible(double mtf50_cpp, double normal_rad) {
  return mtf50_cpp > 0 && 0.5 < most_of_photosite * photosite_mtf(mtf50_cpp, normal_rad);
}

EdgeShapes::EdgeShapes(double mtf50_cpp, double normal_rad) {
  if (!possible(mtf50_cpp, normal_rad))
    throw InputError("an edge as sharp as a photosite lets it be has no shapes to compare it with");
  const double contrast = 0.5 / photosite_mtf(mtf50_cpp, normal_rad);
  sigma_px_ = std::sqrt(-0.5 * std::log(contrast)) / (pi * mtf50_cpp);
  cutoff_cpp_ = mtf50_cpp / circular_frequency(contrast);
  // The photosite along the normal is one box after another.
  const QuadratureRule wide = gauss_legendre(6), narrow = gauss_legendre(4);
  const double c = std::abs(std::cos(normal_rad)), s = std::abs(std::sin(normal_rad));
  std::size_t at = 0;
  for (std::size_t i = 0; i < wide.nodes.size(); ++i)
    for (std::size_t j = 0; j < narrow.nodes.size(); ++j, ++at) {
      place_[at] = std::max(c, s) * (wide.nodes[i] - 0.5) + std::min(c, s) * (narrow.nodes[j] - 0.5);
      weight_[at] = wide.weights[i] * narrow.weights[j];
    }
}

std::array<double, EdgeShapes::count> EdgeShapes::operator()(double distance_px) const {
  const CircularPupilEdge& circular = CircularPupilEdge::table();
  std::array<double, count> sum{};
  for (std::size_t i = 0; i < place_.size(); ++i) {
    const double d = distance_px - place_[i], x = d / sigma_px_, u = d * cutoff_cpp_;
    constexpr double far = 6;  // where a Gaussian's edge is level to 1e-9
    const double gauss = std::abs(x) > far ? (x > 0 ? 1 : 0) : 0.5 * std::erfc(-x / std::numbers::sqrt2);
    const double gauss_wider = std::abs(x) > far ? 0 : -x * std::exp(-0.5 * x * x) / std::sqrt(2 * pi);
    const CircularPupilEdge::At airy = circular(u);
    sum[0] += 0.5 * weight_[i] * (gauss + airy.value);
    sum[1] += 0.5 * weight_[i] * (gauss_wider - u * airy.slope);
    sum[2] += weight_[i] * (gauss - airy.value);
  }
  return sum;
}

}  // namespace petzval
