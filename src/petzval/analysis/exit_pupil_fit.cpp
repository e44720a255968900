// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/exit_pupil_fit.h>
#include <petzval/analysis/wavefront.h>
#include <petzval/base/units.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>

namespace petzval {

namespace {

constexpr std::array<int, 3> degrees_tried = {10, 16, 24};
constexpr int largest_degree = degrees_tried.back();

/// T_0 … T_n at x.
std::array<double, largest_degree + 1> chebyshev(double x, int n) {
  std::array<double, largest_degree + 1> values{1, x};
  for (int k = 2; k <= n; ++k)
    values[static_cast<std::size_t>(k)] =
        2 * x * values[static_cast<std::size_t>(k - 1)] - values[static_cast<std::size_t>(k - 2)];
  return values;
}

/// Calls term(index, value) for each T_i(2a² − 1) T_j(b) with 2i + j ≤ degree.
template <class Term>
void over_terms(int degree, double a, double b, Term&& term) {
  const auto in_a = chebyshev(2 * a * a - 1, degree / 2), in_b = chebyshev(b, degree);
  std::size_t index = 0;
  for (int i = 0; 2 * i <= degree; ++i)
    for (int j = 0; j <= degree - 2 * i; ++j)
      term(index++, in_a[static_cast<std::size_t>(i)] * in_b[static_cast<std::size_t>(j)]);
}

Eigen::Index term_count(int degree) {
  Eigen::Index count = 0;
  for (int i = 0; 2 * i <= degree; ++i) count += degree - 2 * i + 1;
  return count;
}

}  // namespace

std::optional<ExitPupilFit> ExitPupilFit::of(const ExitPupil& pupil, const PupilModel& model,
                                             double sensor_shift_mm) {
  const std::vector<ExitPupil::Sample> samples = pupil.samples(model, sensor_shift_mm);
  const auto rows = static_cast<Eigen::Index>(samples.size());
  ExitPupilFit smooth;
  smooth.alpha_scale_ = pupil.alpha_max();
  smooth.beta_middle_ = 0.5 * (pupil.beta_range().low + pupil.beta_range().high);
  smooth.beta_scale_ = 0.5 * pupil.beta_range().length();
  const bool uniform = model.amplitude == PupilModel::Amplitude::uniform;
  Eigen::MatrixXd right(rows, uniform ? 1 : 2);
  double brightest = 0;
  for (Eigen::Index i = 0; i < rows; ++i) {
    const ExitPupil::Sample& sample = samples[static_cast<std::size_t>(i)];
    right(i, 0) = sample.phase_waves;
    if (!uniform) right(i, 1) = sample.amplitude;
    brightest = std::max(brightest, sample.amplitude);
    smooth.transverse_mm_ = std::max(smooth.transverse_mm_, std::hypot(sample.x_mm, sample.y_mm));
  }
  for (const int degree : degrees_tried) {
    const Eigen::Index terms = term_count(degree);
    if (rows < 2 * terms) return {};
    Eigen::MatrixXd design(rows, terms);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const ExitPupil::Sample& sample = samples[static_cast<std::size_t>(i)];
      over_terms(degree, sample.alpha / smooth.alpha_scale_,
                 (sample.beta - smooth.beta_middle_) / smooth.beta_scale_,
                 [&](std::size_t t, double value) { design(i, static_cast<Eigen::Index>(t)) = value; });
    }
    const Eigen::MatrixXd solution = design.householderQr().solve(right);
    const Eigen::MatrixXd miss = design * solution - right;
    if (!(miss.col(0).cwiseAbs().maxCoeff() < tolerance)) continue;
    if (!uniform && !(miss.col(1).cwiseAbs().maxCoeff() < tolerance * brightest)) continue;
    smooth.degree_ = degree;
    smooth.phase_.assign(solution.col(0).data(), solution.col(0).data() + terms);
    if (!uniform) smooth.amplitude_.assign(solution.col(1).data(), solution.col(1).data() + terms);
    return smooth;
  }
  return {};
}

double ExitPupilFit::sum(const std::vector<double>& coefficients, double alpha, double beta) const {
  double total = 0;
  over_terms(degree_, alpha / alpha_scale_, (beta - beta_middle_) / beta_scale_,
             [&](std::size_t t, double value) { total += coefficients[t] * value; });
  return total;
}

std::complex<double> ExitPupilFit::wave(double alpha, double beta) const {
  return std::polar(amplitude_.empty() ? 1.0 : std::max(sum(amplitude_, alpha, beta), 0.0),
                    2 * pi * sum(phase_, alpha, beta));
}

}  // namespace petzval
