// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/measure/sfr/edge_shapes.h>
#include <petzval/numeric/quadrature.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

namespace petzval {

namespace {

/// OTF of a circular pupil of cut-off frequency 1 with w020 ρ² + w040 ρ⁴ waves: the mean of cos 2π ΔW over
/// the overlap of the pupil with itself, shifted (H. H. Hopkins, Proc. R. Soc. A 231, 91, 1955).
double pupil_otf(double nu, double w020, double w040) {
  static const QuadratureRule along = gauss_legendre(48), across = gauss_legendre(12);
  double sum = 0;
  for (std::size_t i = 0; i < along.nodes.size(); ++i) {
    // A quarter of the overlap; the square spreads nodes where its border is steep.
    const double t = along.nodes[i], x = (1 - nu) * (1 - t * t), dx = 2 * t * (1 - nu) * along.weights[i];
    const double height = std::sqrt(std::max(0.0, 1 - (x + nu) * (x + nu)));
    for (std::size_t j = 0; j < across.nodes.size(); ++j) {
      const double y = across.nodes[j] * height;
      const double waves = 4 * x * nu * (w020 + 2 * w040 * (x * x + y * y + nu * nu));
      sum += dx * height * across.weights[j] * std::cos(2 * pi * waves);
    }
  }
  return 4 / pi * sum;
}

/// Of a Gaussian of σ = 1, which at frequency 1 has next to nothing left.
double gaussian_otf(double nu) {
  return std::exp(-2 * pi * pi * nu * nu);
}

double halo_otf(double nu) {
  constexpr double share = 0.25, wider = 4;
  return (1 - share) * gaussian_otf(nu) + share * gaussian_otf(wider * nu);
}

/// The edge of a real OTF M that ends at frequency 1: E(u) = ½ + ∫₀¹ M(ν) sin(2πνu)/(πν) dν, and its
/// derivative.
class ScaledEdge {
 public:
  template <typename Otf>
  explicit ScaledEdge(const Otf& otf) : value_(intervals + 1, 0.5), slope_(intervals + 1, 0) {
    // Half a turn a node at the farthest, and as much again for what M does at its end.
    const QuadratureRule rule = gauss_legendre(4 * farthest);
    for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
      const double nu = rule.nodes[k], weight = rule.weights[k] * otf(nu);
      const std::complex<double> turn = std::polar(1.0, 2 * pi * nu / per_unit);
      std::complex<double> turned = 1;
      for (std::size_t i = 0; i <= intervals; ++i, turned *= turn) {
        value_[i] += weight / (pi * nu) * turned.imag();
        slope_[i] += 2 * weight * turned.real();
      }
    }
    for (int i = 0; i <= frequencies; ++i) otf_.push_back(otf(static_cast<double>(i) / frequencies));
  }
  /// In the order of EdgeShapes.
  static const std::array<ScaledEdge, EdgeShapes::kinds>& all() {
    static const std::array<ScaledEdge, EdgeShapes::kinds> made{
        ScaledEdge(gaussian_otf), ScaledEdge([](double nu) { return pupil_otf(nu, 0, 0); }),
        ScaledEdge([](double nu) { return pupil_otf(nu, 0.5, 0); }),
        ScaledEdge([](double nu) { return pupil_otf(nu, 0, 0.5); }), ScaledEdge(halo_otf)};
    return made;
  }

  /// The lowest of this contrast.
  double frequency(double contrast) const {
    std::size_t i = 1;
    while (i + 1 < otf_.size() && otf_[i] > contrast) ++i;
    return (static_cast<double>(i) - (contrast - otf_[i]) / (otf_[i - 1] - otf_[i])) / frequencies;
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
  static constexpr int farthest = 64, per_unit = 32, intervals = farthest * per_unit, frequencies = 1024;

  std::vector<double> value_, slope_, otf_;
};

double sinc(double x) {
  return x == 0 ? 1 : std::sin(pi * x) / (pi * x);
}

double photosite_mtf(double frequency_cpp, double normal_rad) {
  return sinc(frequency_cpp * std::cos(normal_rad)) * sinc(frequency_cpp * std::sin(normal_rad));
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
  for (std::size_t k = 0; k < scale_cpp_.size(); ++k)
    scale_cpp_[k] = mtf50_cpp / ScaledEdge::all()[k].frequency(contrast);
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
  std::array<double, count> sum{};
  for (std::size_t i = 0; i < place_.size(); ++i) {
    std::array<double, kinds> value{};
    for (std::size_t k = 0; k < kinds; ++k) {
      const double u = (distance_px - place_[i]) * scale_cpp_[k];
      const ScaledEdge::At at = ScaledEdge::all()[k](u);
      value[k] = at.value;
      if (k < 2) sum[1] -= 0.5 * weight_[i] * u * at.slope;
    }
    const double mean = 0.5 * (value[0] + value[1]);
    sum[0] += weight_[i] * mean;
    sum[2] += weight_[i] * (value[0] - value[1]);
    for (std::size_t k = 2; k < kinds; ++k) sum[k + 1] += weight_[i] * (value[k] - mean);
  }
  return sum;
}

}  // namespace petzval
