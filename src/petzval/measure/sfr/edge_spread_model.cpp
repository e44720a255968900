// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/measure/sfr/edge_spread_model.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace petzval {

namespace {

constexpr double b = EdgeSpreadBasis::scale_px;
static_assert(EdgeSpreadBasis::closed_forms + EdgeSpreadBasis::light_terms.back() + EdgeShapes::count - 1 <=
              BorderedBand::most_border);

/// Values and slopes [1/knot] of the six quintic cardinal B-splines that cover an interval between knots, at
/// a share 0 ≤ t < 1 of it.
void quintic(double t, double* values, double* slopes) {
  const double u = 1 - t;
  const auto p4 = [](double x) { return x * x * x * x; };
  // Σ_k (−1)^k C(6, k) (x − k)^5/120 from either end.
  const double u0 = p4(u), u1 = p4(u + 1), u2 = p4(u + 2), t0 = p4(t), t1 = p4(t + 1), t2 = p4(t + 2);
  const double v0 = u * u0, v1 = (u + 1) * u1, v2 = (u + 2) * u2;
  const double w0 = t * t0, w1 = (t + 1) * t1, w2 = (t + 2) * t2;
  values[0] = v0 / 120;
  values[1] = (v1 - 6 * v0) / 120;
  values[2] = (v2 - 6 * v1 + 15 * v0) / 120;
  values[3] = (w2 - 6 * w1 + 15 * w0) / 120;
  values[4] = (w1 - 6 * w0) / 120;
  values[5] = w0 / 120;
  slopes[0] = -u0 / 24;
  slopes[1] = -(u1 - 6 * u0) / 24;
  slopes[2] = -(u2 - 6 * u1 + 15 * u0) / 24;
  slopes[3] = (t2 - 6 * t1 + 15 * t0) / 24;
  slopes[4] = (t1 - 6 * t0) / 24;
  slopes[5] = t0 / 24;
}

/// One choice of the smoothing.
struct Solved {
  double criterion = HUGE_VAL;  ///< −2 log of the restricted likelihood, but for a constant
  double of_rest = 0;           ///< what the rest of the samples adds to it
  double smoothing = 0;
  BorderedCholesky factor;
  Eigen::VectorXd solution;
};

}  // namespace

template <typename Use>
auto EdgeSpreadModel::with_fixed(const Use& use) const {
  if (options_.light_order == 2)
    return use(std::integral_constant<int, closed_forms + EdgeSpreadBasis::light_terms[2]>());
  if (options_.light_order == 1)
    return use(std::integral_constant<int, closed_forms + EdgeSpreadBasis::light_terms[1]>());
  return use(std::integral_constant<int, closed_forms>());
}

template <int fixed>
void EdgeSpreadModel::add_products(const Row& row, double weight, BorderedBand& normal,
                                   Corner<fixed>& corner) {
  const auto& f = row.fixed;
  for (std::size_t r = 0; r < fixed; ++r) {
    const double value = weight * f[r];
    for (std::size_t s = 0; s <= r; ++s) corner[r][s] += value * f[s];
  }
  for (int p = 0; p < support && row.first >= 0; ++p) {
    double* const column = normal.column(row.first + p);
    const double value = weight * row.splines[p];
    for (int i = p; i < support; ++i) column[i - p] += value * row.splines[i];
    for (int r = 0; r < fixed; ++r) column[support + r] += value * f[r];
  }
}

template <int fixed>
void EdgeSpreadModel::add_corner(const Corner<fixed>& corner, BorderedBand& normal) const {
  for (int r = 0; r < fixed; ++r)
    for (int s = 0; s <= r; ++s) normal.at(padded() + r, padded() + s) += corner[r][s];
}

template <int fixed>
BorderedBand EdgeSpreadModel::weighted_normal(std::span<const double> weights) const {
  BorderedBand normal(padded(), fixed);
  Corner<fixed> corner{};
  for (std::size_t i = 0; i < weights.size(); ++i) add_products<fixed>(rows_[i], weights[i], normal, corner);
  add_corner<fixed>(corner, normal);
  return normal;
}

BorderedBand EdgeSpreadModel::normal_of(std::span<const double> weights) const {
  return trimmed(with_fixed([&](auto fixed) { return weighted_normal<fixed()>(weights); }));
}

template <int fixed>
void EdgeSpreadModel::add_points(std::span<const EdgePoint> points) {
  Eigen::VectorXd& right = padded_right_;
  Corner<fixed> corner{};
  double corner_right[fixed] = {};
  const double cells = basis_.splines + support - 1;
  for (const EdgePoint& point : points) {
    Row& row = rows_.emplace_back();
    const double d = point.distance, q = 1 / (d * d + b * b);
    auto& f = row.fixed;
    f[0] = 1;
    f[1] = 0.5 + std::atan(d / b) / pi + 0.5 * b / pi * point.missing;
    f[2] = -d * q + 0.5 * point.missing;
    f[3] = -d * q * q;
    if constexpr (fixed > closed_forms) {
      f[4] = point.light * point.along;
      f[5] = point.light * d / options_.core_px;
    }
    if constexpr (fixed > closed_forms + EdgeSpreadBasis::light_terms[1]) {
      f[6] = f[4] * point.along;
      f[7] = f[5] * point.along;
      f[8] = f[5] * d / options_.core_px;
    }
    for (int r = 0; r < fixed; ++r) corner_right[r] += f[r] * point.value;
    // Knots lie at −core + i·knot; an interval between them is covered by six splines.
    const double at = (d + options_.core_px) / options_.knot_px, cell = std::floor(at);
    if (cell >= 0 && cell < cells) {
      row.first = static_cast<int>(cell);
      quintic(at - cell, row.splines.data(), row.slopes.data());
      for (int p = 0; p < support; ++p) right[row.first + p] += row.splines[p] * point.value;
    }
    add_products<fixed>(row, 1, padded_normal_, corner);
  }
  add_corner<fixed>(corner, padded_normal_);
  for (int r = 0; r < fixed; ++r) right[padded() + r] += corner_right[r];
}

BorderedBand EdgeSpreadModel::trimmed(const BorderedBand& all) const {
  BorderedBand result(basis_.splines, basis_.border());
  for (int j = 0; j < basis_.splines; ++j) {
    for (int i = j; i < std::min(basis_.splines, j + support); ++i)
      result.at(i, j) = all.at(margin + i, margin + j);
    for (int r = 0; r < basis_.fixed(); ++r) result.at(basis_.place(r), j) = all.at(padded() + r, margin + j);
  }
  for (int r = 0; r < basis_.fixed(); ++r)
    for (int s = 0; s <= r; ++s)
      result.at(basis_.place(r), basis_.place(s)) = all.at(padded() + r, padded() + s);
  return result;
}

EdgeSpreadModel::EdgeSpreadModel(std::span<const EdgePoint> points, const EdgeSpreadOptions& options)
    : options_(options),
      basis_{EdgeSpreadBasis::splines_within(options.core_px, options.knot_px), options.knot_px,
             options.light_order, options.prior.shapes ? EdgeShapes::count - 1 : 0} {
  options_.core_px = basis_.core_px();
  rows_.reserve(points.size());
  padded_normal_ = BorderedBand(padded(), basis_.fixed());
  padded_right_ = Eigen::VectorXd::Zero(padded_normal_.size());
  with_fixed([&](auto fixed) { add_points<fixed()>(points); });
  fit(points);
}

void EdgeSpreadModel::take_light_to_order(int order, std::span<const EdgePoint> points) {
  if (order >= options_.light_order) return;
  const int before = basis_.lights();
  options_.light_order = basis_.light_order = order;
  padded_normal_.drop_border(before - basis_.lights());
  padded_right_.conservativeResize(padded_normal_.size());
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
  data_normal_ = trimmed(padded_normal_);
  right_ = Eigen::VectorXd::Zero(basis_.size());
  right_.head(basis_.splines) = padded_right_.segment(margin, basis_.splines);
  for (int r = 0; r < basis_.fixed(); ++r) right_[basis_.place(r)] = padded_right_[padded() + r];
  const EdgePrior prior(options_.prior, basis_, high - low);
  BorderedBand normal = data_normal_;
  prior.add_first_part(normal);
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
    solved.solution = solved.factor.solve(right_);
    const double rest = std::max(square - right_.dot(solved.solution), 1e-14 * square);
    solved.of_rest = (count - unsettled) * std::log(rest);
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
  priors_ = std::move(normal);
  priors_.add(-1, data_normal_);
  priors_.add(options_.smoothing * unit, rough);
  coefficients_ = best.solution;
  factor_ = std::move(best.factor);
  criterion_ = best.criterion + prior.log_spread_of_shapes();
  dark_ = coefficients_[basis_.dark()];
  step_ = coefficients_[basis_.step()];
}

void EdgeSpreadModel::evaluate_points(std::span<const EdgePoint> points, std::vector<ValueAndSlope>& fitted,
                                      std::vector<double>& variations) const {
  fitted.resize(points.size());
  variations.resize(points.size());
  Eigen::VectorXd c = Eigen::VectorXd::Zero(padded() + basis_.fixed());
  c.segment(margin, basis_.splines) = coefficients_.head(basis_.splines);
  const double* const closed = coefficients_.data() + basis_.splines;
  const double half_tail = 0.5 * (b / pi * closed[1] + closed[2]), per_px = 1 / options_.knot_px;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Row& row = rows_[i];
    const double d = points[i].distance, q = 1 / (d * d + b * b), dq = d * q;
    ValueAndSlope at;
    double variation = half_tail * points[i].missing;
    at.value = closed[0] + closed[1] * row.fixed[1] + closed[2] * row.fixed[2] + closed[3] * row.fixed[3] -
               variation;
    at.slope = closed[1] * b * q / pi - closed[2] * (q - 2 * dq * dq) - closed[3] * q * (q - 4 * dq * dq);
    for (std::size_t k = closed_forms; k < static_cast<std::size_t>(basis_.fixed()); ++k)
      variation += coefficients_[basis_.place(static_cast<int>(k))] * row.fixed[k];
    if (row.first >= 0) {
      double slope = 0;
      for (int p = 0; p < support; ++p) {
        at.value += c[row.first + p] * row.splines[p];
        slope += c[row.first + p] * row.slopes[p];
      }
      at.slope += slope * per_px;
    }
    fitted[i] = at;
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
  quintic(place - cell, values, slopes);
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

EdgeSpreadModel::Variation EdgeSpreadModel::variation_over(double reach_px, double noise) const {
  Variation result;
  if (options_.light_order == 0) return result;
  const double reach = reach_px / options_.core_px;
  const std::array<double, EdgeSpreadBasis::light_terms.back()> reaches{1, reach, 1, reach, reach * reach};
  for (int k = EdgeSpreadBasis::light_terms[static_cast<std::size_t>(options_.light_order - 1)];
       k < basis_.lights(); ++k) {
    const Eigen::Index at = basis_.place(closed_forms + k);
    const double spread = factor_.solve(Eigen::VectorXd::Unit(coefficients_.size(), at))[at];
    const double coefficient = std::abs(coefficients_[at]);
    result.significance = std::max(result.significance,
                                   coefficient / std::max(1e-300, noise * std::sqrt(std::max(0.0, spread))));
    result.share =
        std::max(result.share, coefficient * reaches[static_cast<std::size_t>(k)] / std::abs(step_));
  }
  return result;
}

double EdgeSpreadModel::unknowns() const {
  return trace_of_product(factor_.inverse(), data_normal_);
}

template <int functions>
EdgeSpreadModel::Projection<functions>::Projection(const EdgeSpreadModel& model)
    : model_(model), sums_(decltype(sums_)::Zero(model.padded() + model.basis_.fixed(), functions)) {}

template <int functions>
void EdgeSpreadModel::Projection<functions>::add(std::size_t point,
                                                 const std::array<double, functions>& values) {
  const Row& row = model_.rows_[point];
  const auto add_to = [&](int unknown, double weight) {
    double* const sum = sums_.data() + static_cast<std::ptrdiff_t>(unknown) * functions;
    for (std::size_t k = 0; k < values.size(); ++k) sum[k] += weight * values[k];
  };
  for (int p = 0; p < support && row.first >= 0; ++p)
    add_to(row.first + p, row.splines[static_cast<std::size_t>(p)]);
  for (int r = 0; r < model_.basis_.fixed(); ++r)
    add_to(model_.padded() + r, row.fixed[static_cast<std::size_t>(r)]);
}

template <int functions>
typename EdgeSpreadModel::Projection<functions>::Matrix EdgeSpreadModel::Projection<functions>::taken()
    const {
  const EdgeSpreadBasis& basis = model_.basis_;
  BorderedBand::Columns<functions> sums = decltype(sums)::Zero(basis.size(), functions);
  sums.topRows(basis.splines) = sums_.middleRows(margin, basis.splines);
  for (int r = 0; r < basis.fixed(); ++r) sums.row(basis.place(r)) = sums_.row(model_.padded() + r);
  BorderedBand::Columns<functions> solved = sums;
  model_.factor_.solve_in_place(solved);
  return sums.transpose() * solved;
}

template class EdgeSpreadModel::Projection<2>;
template class EdgeSpreadModel::Projection<4>;
template class EdgeSpreadModel::Projection<BorderedBand::lanes>;

}  // namespace petzval
