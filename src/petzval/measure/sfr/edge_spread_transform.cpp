// SPDX-License-Identifier: BSD-3-Clause
// The Fourier transform of a fitted profile, and how sure it is.
#include <petzval/base/units.h>
#include <petzval/measure/sfr/edge_spread_model.h>
#include <petzval/measure/sfr/transform_lanes.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

double knot_sinc(double x) {
  return x == 0 ? 1 : std::sin(pi * x) / (pi * x);
}

/// Transforms of the closed forms and of the middle spline, at a frequency.
struct FormTransforms {
  double step, tail1, tail3;
  double spline;  ///< over i
  FormTransforms(double f, double knot_px) {
    constexpr double b = EdgeSpreadBasis::scale_px;
    const double fade = std::exp(-2 * pi * b * std::abs(f));
    step = fade;
    tail1 = -2 * pi * pi * std::abs(f) * fade;
    tail3 = -2 * pi * pi * pi / b * f * f * fade;
    const double sinc = knot_sinc(f * knot_px), cube = sinc * sinc * sinc;
    spline = 2 * pi * f * cube * cube * knot_px;
  }
};

using Frequencies = std::span<const double>;

/// Of up to eight frequencies; the others are 0.
SplinePhases phases_of(Frequencies frequencies_cpp, double knot_px, int splines) {
  SplinePhases phases{};
  for (std::size_t k = 0; k < frequencies_cpp.size(); ++k) {
    const double turn = 2 * pi * frequencies_cpp[k] * knot_px, start = -0.5 * (splines - 1) * turn;
    phases.cosine[k] = std::cos(start), phases.sine[k] = std::sin(start);
    phases.turn_cosine[k] = std::cos(turn), phases.turn_sine[k] = std::sin(turn);
  }
  return phases;
}

/// Calls `use` with the first of up to eight frequencies at a time, and with these.
template <typename Use>
void for_eight(Frequencies frequencies_cpp, const Use& use) {
  constexpr std::size_t eight = SplinePhases::count;
  static_assert(SplinePhases::count == BorderedBand::lanes);
  for (std::size_t first = 0; first < frequencies_cpp.size(); first += eight)
    use(first, frequencies_cpp.subspan(first, std::min(eight, frequencies_cpp.size() - first)));
}

}  // namespace

std::complex<double> EdgeSpreadModel::transform(double f) const {
  return transforms({&f, 1}).front();
}

std::vector<std::complex<double>> EdgeSpreadModel::transforms(Frequencies frequencies_cpp) const {
  const double* const closed = coefficients_.data() + basis_.splines;
  std::vector<std::complex<double>> values;
  values.reserve(frequencies_cpp.size());
  for_eight(frequencies_cpp, [&](std::size_t, Frequencies some) {
    const SplineSums sums =
        spline_sums(phases_of(some, options_.knot_px, basis_.splines), coefficients_.data(), basis_.splines);
    for (std::size_t k = 0; k < some.size(); ++k) {
      const FormTransforms forms(some[k], options_.knot_px);
      // Σ c (cos − i sin) times i·spline.
      const std::complex<double> value(closed[1] * forms.step + closed[2] * forms.tail1 +
                                           closed[3] * forms.tail3 + forms.spline * sums.odd[k],
                                       forms.spline * sums.even[k]);
      values.push_back(value / step_);
    }
  });
  return values;
}

EdgeSpreadModel::Deviation::Deviation(const EdgeSpreadModel& model, std::span<const double> variance,
                                      const QuantisationNoise& rounding, std::span<const double> changes)
    : model_(model), spread_(model.normal_of(model.rows_.products(variance))) {
  const int splines = model.basis_.splines, fixed = model.basis_.fixed();
  double mean = 0;
  for (const double each : variance) mean += each / static_cast<double>(variance.size());
  // What the priors say of the profile is as uncertain as they are weak.
  spread_.add(mean, model.priors_);
  if (!changes.empty()) changes_ = model.right_sides<BorderedBand::lanes>(changes);
  if (rounding.none()) return;
  rounding_ = Eigen::MatrixXd::Zero(spread_.size(), spread_.size());
  rounding.add_spread(
      [&](std::size_t i, double weight, double* sum) {
        const int first = model.rows_.first(i) - margin;
        for (int p = 0; p < support && first >= -margin; ++p)
          if (const int j = first + p; j >= 0 && j < splines) sum[j] += weight * model.rows_.splines(i)[p];
        for (int r = 0; r < fixed; ++r) sum[model.basis_.place(r)] += weight * model.rows_.fixed(i)[r];
      },
      rounding_);
  rounding_.diagonal() *= 0.5;
}

BorderedBand::Block EdgeSpreadModel::Deviation::gradients_of_moduli(
    Frequencies frequencies_cpp, std::span<const std::complex<double>> transforms) const {
  const EdgeSpreadBasis& basis = model_.basis_;
  BorderedBand::Block gradients = BorderedBand::Block::Zero(spread_.size(), BorderedBand::lanes);
  SplineSums factors{};
  for (std::size_t k = 0; k < frequencies_cpp.size(); ++k) {
    const double modulus = std::abs(transforms[k]);
    const double real = modulus > 0 ? transforms[k].real() / modulus : 1,
                 imaginary = modulus > 0 ? transforms[k].imag() / modulus : 0;
    const FormTransforms forms(frequencies_cpp[k], model_.options_.knot_px);
    const auto column = static_cast<Eigen::Index>(k);
    gradients(basis.step(), column) = (real * forms.step - modulus) / model_.step_;
    gradients(basis.tail1(), column) = real * forms.tail1 / model_.step_;
    gradients(basis.tail3(), column) = real * forms.tail3 / model_.step_;
    factors.even[k] = forms.spline * imaginary / model_.step_;
    factors.odd[k] = forms.spline * real / model_.step_;
  }
  spline_waves(phases_of(frequencies_cpp, model_.options_.knot_px, basis.splines), factors, basis.splines,
               gradients.data());
  return gradients;
}

std::vector<double> EdgeSpreadModel::Deviation::of_moduli(
    Frequencies frequencies_cpp, std::span<const std::complex<double>> transforms) const {
  std::vector<double> deviations;
  deviations.reserve(frequencies_cpp.size());
  for_eight(frequencies_cpp, [&](std::size_t first, Frequencies some) {
    BorderedBand::Block x = gradients_of_moduli(some, transforms.subspan(first, some.size()));
    model_.factor_.solve_in_place(x);
    const std::array<double, BorderedBand::lanes> variance = variances(x);
    for (std::size_t k = 0; k < some.size(); ++k) deviations.push_back(std::sqrt(std::max(0.0, variance[k])));
  });
  return deviations;
}

std::array<double, BorderedBand::lanes> EdgeSpreadModel::Deviation::variances(
    const BorderedBand::Block& x) const {
  std::array<double, BorderedBand::lanes> result = spread_.quadratic(x);
  if (changes_.size() > 0)
    Eigen::Map<Eigen::Array<double, BorderedBand::lanes, 1>>(result.data()) +=
        (x.transpose() * changes_).array().square().rowwise().mean();
  if (rounding_.size() == 0) return result;
  const BorderedBand::Block of_half = rounding_.triangularView<Eigen::Lower>() * x;
  Eigen::Map<Eigen::Array<double, 1, BorderedBand::lanes>>(result.data()) +=
      2 * (x.array() * of_half.array()).colwise().sum();
  return result;
}

std::array<double, 3> EdgeSpreadModel::Deviation::correlations(const std::array<double, 3>& f) const {
  BorderedBand::Block x = gradients_of_moduli(f, model_.transforms(f));
  model_.factor_.solve_in_place(x);
  // (a + b)² = a² + b² + 2ab
  constexpr int pairs[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  for (int k = 0; k < 3; ++k) x.col(3 + k) = x.col(pairs[k][0]) + x.col(pairs[k][1]);
  const std::array<double, BorderedBand::lanes> squares = variances(x);
  std::array<double, 3> result{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = squares[static_cast<std::size_t>(pairs[k][0])],
                 b = squares[static_cast<std::size_t>(pairs[k][1])];
    if (a > 0 && b > 0) result[k] = std::clamp(0.5 * (squares[3 + k] - a - b) / std::sqrt(a * b), -1.0, 1.0);
  }
  return result;
}

}  // namespace petzval
