// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/measure/sfr/edge_prior.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace petzval {

namespace {

constexpr double scale_px = EdgeSpreadBasis::scale_px;

constexpr double usual_tail_spread_px = 0.06;

/// Of the shapes' unknowns, over the step. How wide an edge is, is known to 0.2 from its first fit. Of their
/// difference 0.5 makes a Gaussian and −0.5 a circular pupil; defocus, spherical aberration and halos take up
/// to that and a little more.
constexpr std::array<double, EdgeShapes::count - 1> shape_spreads{0.2, 0.5};

/// Third differences of the coefficients of a sharp edge with knots a quarter of a pixel apart, over the
/// step.
constexpr double edge_roughness = 0.1;
/// The same of what an edge has beside its shapes: defocus, spherical aberration and halos leave 0.03 to
/// 0.08. Less would be a bias that all edges of a photograph share.
constexpr double departure_roughness = 0.05;
/// Greatest weight of the roughness far from the edge, over that at the edge.
constexpr double most_weight = 1e8;

/// Coefficients of splines that pass through values at their middles; near the ends these stay as they are.
std::vector<double> in_splines(const std::vector<double>& values) {
  constexpr int rounds = 12;  // each leaves a fifth of what the values have at half their sampling frequency
  std::vector<double> coefficients = values, rest(values.size(), 0.0);
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 2; i + 2 < values.size(); ++i) {
      const double* c = &coefficients[i];
      rest[i] = values[i] - (c[-2] + 26 * c[-1] + 66 * c[0] + 26 * c[1] + c[2]) / 120;
    }
    for (std::size_t i = 0; i < values.size(); ++i) coefficients[i] += rest[i];
  }
  return coefficients;
}

}  // namespace

EdgePrior::EdgePrior(const EdgePriorOptions& options, const EdgeSpreadBasis& basis, double range)
    : options_(options), basis_(basis), range_(range) {}

double EdgePrior::noise() const {
  return std::max(options_.noise, 1e-7 * range_);
}

void EdgePrior::add_first_part(BorderedBand& normal) const {
  // In units of the noise: the first tail is about the usual one, the second below it at twice the blur.
  const double weight1 = noise() / (usual_tail_spread_px * range_);
  const double offset = scale_px / pi - usual_tail_px;
  const int step = basis_.step(), tail1 = basis_.tail1(), tail3 = basis_.tail3();
  normal.at(step, step) += weight1 * weight1 * offset * offset;
  normal.at(tail1, step) += weight1 * weight1 * offset;
  normal.at(tail1, tail1) += weight1 * weight1;
  const double weight3 = noise() / (usual_tail_spread_px * range_ * 4 * options_.blur_px * options_.blur_px);
  normal.at(tail3, tail3) += weight3 * weight3;
  for (int k = 0; k < basis_.shapes; ++k) {
    const double weight = noise() / (shape_spreads[static_cast<std::size_t>(k)] * range_);
    normal.at(basis_.shape(k), basis_.shape(k)) += weight * weight;
  }
}

/// What closed forms and shapes add to the coefficients whose roughness counts: with shapes, that of all the
/// profile but step · shape 0 and the others, in any amount.
std::vector<EdgePrior::RoughForm> EdgePrior::rough_forms() const {
  if (!options_.shapes) return {};
  constexpr int beyond = 8;  // the ends, where coefficients are not yet right
  const int places = basis_.splines + 2 * beyond;
  std::array<std::vector<double>, 3 + EdgeShapes::count - 1> values;
  for (std::vector<double>& each : values) each.resize(static_cast<std::size_t>(places));
  for (int j = 0; j < places; ++j) {
    const double d = (j - 0.5 * (places - 1)) * basis_.knot_px, q = 1 / (d * d + scale_px * scale_px);
    const auto at = static_cast<std::size_t>(j), mirrored = static_cast<std::size_t>(places - 1 - j);
    values[1][at] = -d * q;
    values[2][at] = -d * q * q;
    if (d < 0) continue;  // all are odd about ½
    const std::array<double, EdgeShapes::count> shape = (*options_.shapes)(d);
    values[0][at] = 0.5 + std::atan(d / scale_px) / pi - shape[0];
    values[3][at] = -shape[1], values[4][at] = -shape[2];
    for (const std::size_t k : {0, 3, 4}) values[k][mirrored] = -values[k][at];
  }
  const std::array<int, values.size()> unknowns{basis_.step(), basis_.tail1(), basis_.tail3(),
                                                basis_.shape(0), basis_.shape(1)};
  std::vector<RoughForm> forms;
  for (std::size_t k = 0; k < values.size(); ++k) {
    std::vector<double> coefficients = in_splines(values[k]);
    forms.push_back({unknowns[k], {coefficients.begin() + beyond, coefficients.end() - beyond}});
  }
  return forms;
}

BorderedBand EdgePrior::roughness() const {
  BorderedBand matrix(basis_.splines, basis_.border());
  const std::vector<RoughForm> forms = rough_forms();
  for (int j = 0; j + 3 < basis_.splines; ++j) {
    // A line spread that falls as 1/d² has curvature that falls as 1/d⁴.
    const double d = (j + 1.5 - 0.5 * (basis_.splines - 1)) * basis_.knot_px / options_.blur_px;
    const double square = (1 + d * d) * (1 + d * d), weight = std::min(square * square, most_weight);
    constexpr double difference[4] = {-1, 3, -3, 1};
    for (int p = 0; p < 4; ++p)
      for (int q = 0; q <= p; ++q) matrix.at(j + p, j + q) += weight * difference[p] * difference[q];
    std::array<double, EdgeSpreadBasis::closed_forms + EdgeShapes::count> of_form{};
    for (std::size_t k = 0; k < forms.size(); ++k) {
      for (int p = 0; p < 4; ++p)
        of_form[k] += difference[p] * forms[k].coefficients[static_cast<std::size_t>(j + p)];
      for (int p = 0; p < 4; ++p) matrix.at(forms[k].unknown, j + p) += weight * of_form[k] * difference[p];
      for (std::size_t l = 0; l <= k; ++l)
        matrix.at(forms[k].unknown, forms[l].unknown) += weight * of_form[k] * of_form[l];
    }
  }
  return matrix;
}

int EdgePrior::rank() const {
  return std::max(0, basis_.splines - 3);
}

int EdgePrior::unsettled() const {
  return basis_.splines + basis_.fixed() - rank();
}

EdgePrior::Weights EdgePrior::weights(double unit) const {
  const double roughness = (options_.shapes ? departure_roughness : edge_roughness) *
                           std::pow(basis_.knot_px / (0.25 * options_.blur_px), 3) * range_;
  const double most = std::max(least_weight, std::pow(options_.noise / roughness, 2) / unit);
  return {std::max(least_weight, options_.least_smoothing_share * most), most};
}

double EdgePrior::log_spread_of_shapes() const {
  double sum = 0;
  for (int k = 0; k < basis_.shapes; ++k)
    sum += 2 * std::log(shape_spreads[static_cast<std::size_t>(k)] * range_ / noise());
  return sum;
}

}  // namespace petzval
