// SPDX-License-Identifier: BSD-3-Clause
// The Fourier transform of a fitted profile, and how sure it is.
#include <petzval/base/units.h>
#include <petzval/measure/sfr/edge_spread_model.h>

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

/// Calls `use` with cosine and sine of 2πf times the place of the first half of the splines, from the outside
/// in; the place of the others is the same with the opposite sign, and in the middle of an odd number there
/// is 0.
template <typename Use>
void for_spline_phases(double f, double knot_px, int splines, const Use& use) {
  const double turn = 2 * pi * f * knot_px, start = -0.5 * (splines - 1) * turn;
  const double turn_cos = std::cos(turn), turn_sin = std::sin(turn);
  double cosine = std::cos(start), sine = std::sin(start);
  for (int j = 0; j < (splines + 1) / 2; ++j) {
    use(j, cosine, sine);
    const double next = cosine * turn_cos - sine * turn_sin;
    sine = sine * turn_cos + cosine * turn_sin;
    cosine = next;
  }
}

}  // namespace

std::complex<double> EdgeSpreadModel::transform(double f) const {
  const FormTransforms forms(f, options_.knot_px);
  const double* const c = coefficients_.data();
  const double* const closed = c + basis_.splines;
  double even = 0, odd = 0;
  for_spline_phases(f, options_.knot_px, basis_.splines, [&](int j, double cosine, double sine) {
    const int other = basis_.splines - 1 - j;
    const double partner = other > j ? c[other] : 0;
    even += (c[j] + partner) * cosine;
    odd += (c[j] - partner) * sine;
  });
  // Σ c (cos − i sin) times i·spline.
  return std::complex<double>(
             closed[1] * forms.step + closed[2] * forms.tail1 + closed[3] * forms.tail3 + forms.spline * odd,
             forms.spline * even) /
         step_;
}

std::vector<std::complex<double>> EdgeSpreadModel::transforms(std::span<const double> frequencies_cpp) const {
  std::vector<std::complex<double>> values;
  for (const double f : frequencies_cpp) values.push_back(transform(f));
  return values;
}

EdgeSpreadModel::Deviation::Deviation(const EdgeSpreadModel& model, std::span<const double> variance,
                                      const QuantisationNoise& rounding)
    : model_(model), spread_(model.normal_of(variance)) {
  const int splines = model.basis_.splines, fixed = model.basis_.fixed();
  double mean = 0;
  for (const double each : variance) mean += each / static_cast<double>(variance.size());
  // What the priors say of the profile is as uncertain as they are weak.
  spread_.add(mean, model.priors_);
  if (rounding.none()) return;
  rounding_ = Eigen::MatrixXd::Zero(spread_.size(), spread_.size());
  rounding.add_spread(
      [&](std::size_t i, double weight, double* sum) {
        const Row& row = model.rows_[i];
        for (int p = 0; p < support && row.first >= 0; ++p)
          if (const int j = row.first + p - margin; j >= 0 && j < splines) sum[j] += weight * row.splines[p];
        for (int r = 0; r < fixed; ++r) sum[model.basis_.place(r)] += weight * row.fixed[r];
      },
      rounding_);
  rounding_.diagonal() *= 0.5;
}

void EdgeSpreadModel::Deviation::gradient_of_modulus(double f, std::complex<double> value, double* gradient,
                                                     int stride) const {
  const int splines = model_.basis_.splines;
  const double modulus = std::abs(value);
  const double real = modulus > 0 ? value.real() / modulus : 1,
               imaginary = modulus > 0 ? value.imag() / modulus : 0;
  const FormTransforms forms(f, model_.options_.knot_px);
  const double per_step = 1 / model_.step_;
  const auto set = [&](int unknown, double derivative) {
    gradient[unknown * stride] = derivative * per_step;
  };
  set(splines + 1, real * forms.step - modulus);
  set(splines + 2, real * forms.tail1);
  set(splines + 3, real * forms.tail3);
  for_spline_phases(f, model_.options_.knot_px, splines, [&](int j, double cosine, double sine) {
    const int other = splines - 1 - j;
    set(j, forms.spline * (imaginary * cosine + real * sine));
    set(other, forms.spline * (imaginary * cosine - (other > j ? real * sine : 0)));
  });
}

std::vector<double> EdgeSpreadModel::Deviation::of_moduli(
    std::span<const double> frequencies_cpp, std::span<const std::complex<double>> transforms) const {
  constexpr std::size_t lanes = BorderedBand::lanes;
  std::vector<double> deviations;
  for (std::size_t first = 0; first < frequencies_cpp.size(); first += lanes) {
    BorderedBand::Block x = BorderedBand::Block::Zero(spread_.size(), BorderedBand::lanes);
    const std::size_t count = std::min(lanes, frequencies_cpp.size() - first);
    for (std::size_t k = 0; k < count; ++k)
      gradient_of_modulus(frequencies_cpp[first + k], transforms[first + k], x.data() + k,
                          BorderedBand::lanes);
    model_.factor_.solve_in_place(x);
    const std::array<double, lanes> variance = variances(x);
    for (std::size_t k = 0; k < count; ++k) deviations.push_back(std::sqrt(std::max(0.0, variance[k])));
  }
  return deviations;
}

std::array<double, BorderedBand::lanes> EdgeSpreadModel::Deviation::variances(
    const BorderedBand::Block& x) const {
  std::array<double, BorderedBand::lanes> result = spread_.quadratic(x);
  if (rounding_.size() == 0) return result;
  const BorderedBand::Block of_half = rounding_.triangularView<Eigen::Lower>() * x;
  Eigen::Map<Eigen::Array<double, 1, BorderedBand::lanes>>(result.data()) +=
      2 * (x.array() * of_half.array()).colwise().sum();
  return result;
}

std::array<double, 3> EdgeSpreadModel::Deviation::correlations(const std::array<double, 3>& f) const {
  BorderedBand::Block x = BorderedBand::Block::Zero(spread_.size(), BorderedBand::lanes);
  for (std::size_t k = 0; k < f.size(); ++k)
    gradient_of_modulus(f[k], model_.transform(f[k]), x.data() + k, BorderedBand::lanes);
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
