// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/measure/sfr/edge_shapes.h>
#include <petzval/numeric/quadrature.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace petzval {

namespace {

/// An edge-spread function E(u) = 1 − E(−u) and its slope, between places at which they are known.
class TabulatedEdge {
 public:
  static constexpr int farthest = 64, per_unit = 32, intervals = farthest * per_unit;

  /// \param at  E and its slope at the i-th of `intervals` + 1 places from u = 0.
  template <typename Function>
  explicit TabulatedEdge(const Function& at) {
    for (int i = 0; i <= intervals; ++i) nodes_.push_back(at(i));
  }

  struct At {
    double value, slope;
  };
  At operator()(double u) const {
    const double size = std::abs(u), at = size * per_unit;
    At result{};
    if (at >= intervals) {  // 1 − A/u
      const double rest = (1 - nodes_.back().value) * farthest / size;
      result = {1 - rest, rest / size};
    } else {
      const auto i = static_cast<std::size_t>(at);
      const At &before = nodes_[i], &after = nodes_[i + 1];
      const double t = at - static_cast<double>(i), h = 1.0 / per_unit,
                   difference = after.value - before.value;
      // Hermite's cubic through values and slopes.
      const double a = h * before.slope - difference, c = difference - h * after.slope;
      result.value = before.value + t * (difference + (1 - t) * (a * (1 - t) + c * t));
      result.slope = per_unit * (difference + (1 - 2 * t) * (a * (1 - t) + c * t) + t * (1 - t) * (c - a));
    }
    if (u < 0) result.value = 1 - result.value;
    return result;
  }

 private:
  std::vector<At> nodes_;
};

/// Of a Gaussian of standard deviation 1.
const TabulatedEdge& gaussian_edge() {
  static const TabulatedEdge made([](int i) {
    const double x = static_cast<double>(i) / TabulatedEdge::per_unit;
    return TabulatedEdge::At{0.5 * std::erfc(-x / std::numbers::sqrt2),
                             std::exp(-0.5 * x * x) / std::sqrt(2 * pi)};
  });
  return made;
}

/// Of a circular pupil of cut-off frequency 1: E(u) = ½ + ∫₀¹ M(ν) sin(2πνu)/(πν) dν, M the MTF.
const TabulatedEdge& circular_edge() {
  static const TabulatedEdge made = [] {
    // Half a turn a node at the farthest, and as much again for what M does at its end.
    const QuadratureRule rule = gauss_legendre(4 * TabulatedEdge::farthest);
    const auto n = static_cast<Eigen::Index>(rule.nodes.size());
    const Eigen::ArrayXd nu = Eigen::Map<const Eigen::ArrayXd>(rule.nodes.data(), n);
    const Eigen::ArrayXd mtf = 2 / pi * (nu.acos() - nu * (1 - nu.square()).sqrt());
    const Eigen::ArrayXd of_slope = 2 * mtf * Eigen::Map<const Eigen::ArrayXd>(rule.weights.data(), n);
    const Eigen::ArrayXd of_value = of_slope / (2 * pi * nu);
    // From place to place all phases turn on, which is many times quicker than their sines.
    const Eigen::ArrayXd turn = 2 * pi / TabulatedEdge::per_unit * nu;
    const Eigen::ArrayXd turn_cosine = turn.cos(), turn_sine = turn.sin();
    Eigen::ArrayXd cosine = Eigen::ArrayXd::Ones(n), sine = Eigen::ArrayXd::Zero(n), turned(n);
    return TabulatedEdge([&](int) {
      const TabulatedEdge::At at{0.5 + (of_value * sine).sum(), (of_slope * cosine).sum()};
      turned = cosine * turn_cosine - sine * turn_sine;
      sine = sine * turn_cosine + cosine * turn_sine;
      cosine.swap(turned);
      return at;
    });
  }();
  return made;
}

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
  const TabulatedEdge &gaussian = gaussian_edge(), &circular = circular_edge();
  std::array<double, count> sum{};
  for (std::size_t i = 0; i < place_.size(); ++i) {
    const double d = distance_px - place_[i], x = d / sigma_px_, u = d * cutoff_cpp_;
    const TabulatedEdge::At gauss = gaussian(x), airy = circular(u);
    sum[0] += 0.5 * weight_[i] * (gauss.value + airy.value);
    sum[1] -= 0.5 * weight_[i] * (x * gauss.slope + u * airy.slope);
    sum[2] += weight_[i] * (gauss.value - airy.value);
  }
  return sum;
}

}  // namespace petzval
