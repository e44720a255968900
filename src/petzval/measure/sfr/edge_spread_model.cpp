// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/measure/sfr/edge_spread_model.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace petzval {

namespace {

constexpr double b = EdgeSpreadBasis::scale_px;
static_assert(EdgeSpreadBasis::closed_forms + EdgeSpreadBasis::light_terms.back() + EdgeShapes::count - 1 <=
              BorderedBand::most_border);

/// Values and slopes [1/knot] of the splines that cover an interval between knots, at a share of it.
void evaluate_splines(double share, double* values, double* slopes) {
  static constexpr auto powers = [] {
    std::array<std::array<double, EdgeRows::support>, EdgeRows::support> all;
    for (std::size_t p = 0; p < all.size(); ++p) all[p] = EdgeSpreadBasis::quintic(static_cast<int>(p));
    return all;
  }();
  for (const auto& coefficients : powers) {
    double value = 0, slope = 0;
    for (std::size_t m = coefficients.size(); m-- > 0;) {
      slope = slope * share + value;
      value = value * share + coefficients[m];
    }
    *values++ = value, *slopes++ = slope;
  }
}

/// One choice of the smoothing.
struct Solved {
  double criterion = HUGE_VAL;  ///< −2 log of the restricted likelihood, but for a constant
  double rest = 0;              ///< sum of squares that the profile and its roughness leave
  double of_rest = 0;           ///< what that adds to the criterion
  double smoothing = 0;
  BorderedCholesky factor;
  Eigen::VectorXd halfway;  ///< to the solution: the right side behind the factor's lower half
};

}  // namespace

BorderedBand EdgeSpreadModel::normal_of(const EdgeRows::Products& sums) const {
  BorderedBand result(basis_.splines, basis_.border());
  const int lanes = rows_.fixed_lanes();
  const double* column = sums.columns.data() + margin * (EdgeRows::spline_lanes + lanes);
  for (int j = 0; j < basis_.splines; ++j, column += EdgeRows::spline_lanes + lanes) {
    std::copy_n(column, std::min(support, basis_.splines - j), result.column(j));
    for (int r = 0; r < basis_.fixed(); ++r)
      result.at(basis_.place(r), j) = column[EdgeRows::spline_lanes + r];
  }
  for (int r = 0; r < basis_.fixed(); ++r)
    for (int s = 0; s <= r; ++s)
      result.at(basis_.place(r), basis_.place(s)) = sums.corner[static_cast<std::size_t>(r * lanes + s)];
  return result;
}

EdgeSpreadModel::EdgeSpreadModel(std::span<const EdgePoint> points, const EdgeSpreadOptions& options,
                                 EdgeRows memory)
    : options_(options),
      basis_{EdgeSpreadBasis::splines_within(options.core_px, options.knot_px), options.knot_px,
             options.light_order, options.prior.shapes ? EdgeShapes::count - 1 : 0},
      rows_(std::move(memory)) {
  options_.core_px = basis_.core_px();
  rows_.make(points, basis_);
  sums_ = rows_.products();
  fit(points);
}

void EdgeSpreadModel::take_light_to_order(int order, std::span<const EdgePoint> points) {
  if (order >= options_.light_order) return;
  options_.light_order = basis_.light_order = order;
  fit(points);
}

void EdgeSpreadModel::take_prior(const EdgePriorOptions& prior, std::span<const EdgePoint> points) {
  options_.prior = prior;
  options_.smoothing = -1;
  basis_.shapes = prior.shapes ? EdgeShapes::count - 1 : 0;
  fit(points);
}

void EdgeSpreadModel::fit(std::span<const EdgePoint> points) {
  double low = points.empty() ? 0 : points[0].value, high = low, square = 0;
  for (const EdgePoint& point : points) {
    low = std::min(low, point.value), high = std::max(high, point.value);
    square += point.value * point.value;
  }
  data_normal_ = normal_of(sums_);
  right_ = Eigen::VectorXd::Zero(basis_.size());
  const int lanes = rows_.fixed_lanes(), stride = EdgeRows::spline_lanes + lanes;
  for (int j = 0; j < basis_.splines; ++j)
    right_[j] = sums_.columns[static_cast<std::size_t>((margin + j + 1) * stride - 1)];
  for (int r = 0; r < basis_.fixed(); ++r)
    right_[basis_.place(r)] = sums_.corner[static_cast<std::size_t>((r + 1) * lanes - 1)];
  const EdgePrior prior(options_.prior, basis_, high - low);
  priors_ = BorderedBand(basis_.splines, basis_.border());
  prior.add_first_part(priors_);
  BorderedBand normal = data_normal_;
  normal.add(1, priors_);
  const double count = static_cast<double>(points.size());
  const double unit = count * options_.knot_px / (2 * options_.core_px);
  const BorderedBand rough = prior.roughness();
  const double rank = prior.rank(), unsettled = prior.unsettled();
  const auto solve = [&](double smoothing) {
    BorderedBand whole = normal;
    whole.add(smoothing * unit, rough);
    Solved solved;
    solved.factor = BorderedCholesky(std::move(whole));
    if (!solved.factor.good() || !right_.allFinite())
      throw InputError("the pixels do not determine the edge's profile; a larger ROI is needed");
    solved.halfway = solved.factor.solve_lower(right_);
    solved.rest = std::max(square - solved.halfway.squaredNorm(), 1e-14 * square);
    solved.of_rest = (count - unsettled) * std::log(solved.rest);
    solved.criterion = solved.of_rest + solved.factor.log_determinant() - rank * std::log(smoothing);
    solved.smoothing = smoothing;
    return solved;
  };
  Solved best;
  if (options_.smoothing < 0) {
    const EdgePrior::Weights weights = prior.weights(unit);
    constexpr double factor = 4;
    std::vector<double> choices;
    for (double smoothing = weights.least; smoothing < factor * weights.most; smoothing *= factor)
      choices.push_back(std::min(smoothing, weights.most));
    // With less smoothing the rest becomes smaller and the other terms larger. Those of a choice and the
    // smallest rest are therefore below what all choices of less smoothing come to.
    best = solve(choices.front());
    const double least_of_rest = best.of_rest;
    for (std::size_t i = choices.size() - 1; i > 0; --i) {
      Solved solved = solve(choices[i]);
      const double bound = least_of_rest + solved.criterion - solved.of_rest;
      if (solved.criterion < best.criterion) best = std::move(solved);
      if (bound > best.criterion) break;
    }
    options_.smoothing = best.smoothing;
  } else {
    options_.smoothing = std::max(options_.smoothing, EdgePrior::least_weight);
    best = solve(options_.smoothing);
  }
  priors_.add(options_.smoothing * unit, rough);
  coefficients_ = best.factor.solve_upper(best.halfway);
  factor_ = std::move(best.factor);
  noise_ = std::sqrt(best.rest / std::max(1.0, count - unsettled));
  criterion_ = best.criterion + prior.log_spread_of_shapes();
  dark_ = coefficients_[basis_.dark()];
  step_ = coefficients_[basis_.step()];
}

void EdgeSpreadModel::evaluate_points(std::span<const EdgePoint> points, std::vector<ValueAndSlope>& fitted,
                                      std::vector<double>& variations) const {
  std::vector<double> splines(static_cast<std::size_t>(rows_.padded() + EdgeRows::spline_lanes));
  std::vector<double> fixed(static_cast<std::size_t>(rows_.fixed_lanes()));
  std::copy_n(coefficients_.data(), basis_.splines, splines.begin() + margin);
  for (int r = 0; r < basis_.fixed(); ++r)
    fixed[static_cast<std::size_t>(r)] = coefficients_[basis_.place(r)];
  const EdgeRows::Sums sums = rows_.evaluate(splines, fixed);
  const double half_tail = 0.5 * (b / pi * fixed[1] + fixed[2]);
  fitted.resize(points.size());
  variations.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double* const row = rows_.fixed(i);
    double variation = half_tail * points[i].missing;
    for (int r = closed_forms; r < basis_.fixed(); ++r)
      variation += fixed[static_cast<std::size_t>(r)] * row[r];
    fitted[i] = {sums.values[i] - variation, sums.slopes[i]};
    variations[i] = variation;
  }
}

EdgeSpreadModel::ValueAndSlope EdgeSpreadModel::evaluate(double d) const {
  const double q = 1 / (d * d + b * b), dq = d * q;
  const double* const closed = coefficients_.data() + basis_.splines;
  ValueAndSlope at;
  at.value = closed[0] + closed[1] * (0.5 + std::atan(d / b) / pi) - closed[2] * dq - closed[3] * dq * q;
  at.slope = closed[1] * b * q / pi - closed[2] * (q - 2 * dq * dq) - closed[3] * q * (q - 4 * dq * dq);
  const double place = (d + options_.core_px) / options_.knot_px, cell = std::floor(place);
  if (!(cell >= 0) || cell >= basis_.splines + support - 1) return at;
  double values[support], slopes[support];
  evaluate_splines(place - cell, values, slopes);
  const int first = static_cast<int>(cell) - margin;
  for (int i = std::max(0, -first); i < std::min(support, basis_.splines - first); ++i) {
    at.value += coefficients_[first + i] * values[i];
    at.slope += coefficients_[first + i] * slopes[i] / options_.knot_px;
  }
  return at;
}

double EdgeSpreadModel::tail_px() const {
  return b / pi + coefficients_[basis_.tail1()] / step_;
}

double EdgeSpreadModel::variation_over(double reach_px) const {
  const double reach = reach_px / options_.core_px;
  const std::array<double, EdgeSpreadBasis::light_terms.back()> reaches{1, reach, 1, reach, reach * reach};
  double share = 0;
  for (int k = basis_.first_highest_light(); k < basis_.lights(); ++k)
    share = std::max(share, std::abs(coefficients_[basis_.place(closed_forms + k)] / step_) *
                                reaches[static_cast<std::size_t>(k)]);
  return share;
}

double EdgeSpreadModel::variation_significance(double noise) const {
  double significance = 0;
  for (int k = basis_.first_highest_light(); k < basis_.lights(); ++k) {
    const Eigen::Index at = basis_.place(closed_forms + k);
    const double spread = factor_.solve(Eigen::VectorXd::Unit(coefficients_.size(), at))[at];
    significance = std::max(significance, std::abs(coefficients_[at]) /
                                              std::max(1e-300, noise * std::sqrt(std::max(0.0, spread))));
  }
  return significance;
}

double EdgeSpreadModel::unknowns() const {
  return trace_of_product(factor_.inverse(), data_normal_);
}

template <int functions>
BorderedBand::Columns<functions> EdgeSpreadModel::right_sides(std::span<const double> values) const {
  const std::vector<double> projected = rows_.project(values, functions);
  const auto of_functions = Eigen::Map<const Eigen::MatrixXd>(
      projected.data(), static_cast<Eigen::Index>(rows_.projections()), functions);
  BorderedBand::Columns<functions> sums = decltype(sums)::Zero(basis_.size(), functions);
  sums.topRows(basis_.splines) = of_functions.middleRows(margin, basis_.splines);
  for (int r = 0; r < basis_.fixed(); ++r)
    sums.row(basis_.place(r)) = of_functions.row(rows_.padded() + EdgeRows::spline_lanes + r);
  return sums;
}

template <int functions>
Eigen::Matrix<double, functions, functions> EdgeSpreadModel::taken_of(std::span<const double> values) const {
  const BorderedBand::Columns<functions> sums = right_sides<functions>(values);
  BorderedBand::Columns<functions> solved = sums;
  factor_.solve_in_place(solved);
  return sums.transpose() * solved;
}

template BorderedBand::Block EdgeSpreadModel::right_sides<BorderedBand::lanes>(std::span<const double>) const;
template Eigen::Matrix<double, 2, 2> EdgeSpreadModel::taken_of<2>(std::span<const double>) const;
template Eigen::Matrix<double, 4, 4> EdgeSpreadModel::taken_of<4>(std::span<const double>) const;
template Eigen::Matrix<double, BorderedBand::lanes, BorderedBand::lanes>
    EdgeSpreadModel::taken_of<BorderedBand::lanes>(std::span<const double>) const;

}  // namespace petzval
