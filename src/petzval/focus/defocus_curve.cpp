// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/focus/defocus_curve.h>
#include <petzval/numeric/interpolation.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// Height and power by weighted least squares for a given peak and width; the best evaluations count most.
DefocusCurve fitted(const std::vector<FocusEvaluation>& evaluations, double largest, double peak,
                    double width) {
  double s = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
  for (const FocusEvaluation& each : evaluations) {
    if (!(each.measure > 0)) continue;
    const double weight = std::sqrt(each.measure / largest), off = each.film_distance_mm - peak;
    const double x = -std::log(off * off + width * width), y = std::log(each.measure);
    s += weight, sx += weight * x, sy += weight * y, sxx += weight * x * x, sxy += weight * x * y,
        syy += weight * y * y;
  }
  DefocusCurve curve{peak, width};
  const double determinant = s * sxx - sx * sx;
  if (!(determinant > 1e-12 * s * sxx)) return curve;
  curve.power = (s * sxy - sx * sy) / determinant;
  curve.height = (sy - curve.power * sx) / s;
  if (curve.power > 0) curve.residual = syy - curve.height * sy - curve.power * sxy;
  return curve;
}

}  // namespace

std::optional<DefocusCurve> fit_curve(const FocusResult& result, double low, double high, double least) {
  constexpr int places = 41, widths = 24, rounds = 6;
  DefocusCurve best;
  double least_width = least, greatest_width = std::max(high - low, least);
  for (int round = 0; round < rounds; ++round) {
    for (int i = 0; i < places; ++i)
      for (int j = 0; j < widths; ++j) {
        const double width = least_width * std::pow(greatest_width / least_width, j / (widths - 1.0));
        const DefocusCurve curve =
            fitted(result.evaluations, result.measure, low + (high - low) * (i + 0.5) / places, width);
        if (curve.residual < best.residual) best = curve;
      }
    if (!std::isfinite(best.residual)) return {};
    const double reach = 3 * (high - low) / places,
                 ratio = std::pow(greatest_width / least_width, 3.0 / widths);
    low = std::max(low, best.peak - reach), high = std::min(high, best.peak + reach);
    least_width = std::max(best.width / ratio, least), greatest_width = best.width * ratio;
  }
  return best;
}

std::optional<double> local_peak(const FocusResult& result, double about, double reach) {
  std::vector<double> x, y;
  for (const FocusEvaluation& each : result.evaluations) {
    const double off = (each.film_distance_mm - about) / reach;
    if (std::abs(off) <= 1 && each.measure > 0)
      x.push_back(off), y.push_back(std::log(each.measure / result.measure));
  }
  if (x.size() < 3) return {};
  constexpr std::size_t enough_for_a_cubic = 5;
  const PolynomialFit fit = fit_polynomial(x, y, x.size() < enough_for_a_cubic ? 2 : 3);
  const auto [first, last] = std::minmax_element(x.begin(), x.end());
  // Where the slope changes from up to down, the highest such place.
  constexpr int steps = 400;
  std::optional<double> peak;
  for (int i = 0; i < steps; ++i) {
    double low = *first + (*last - *first) * i / steps, high = *first + (*last - *first) * (i + 1) / steps;
    if (!(fit.derivative(low) >= 0 && fit.derivative(high) < 0)) continue;
    for (int halving = 0; halving < 40; ++halving)
      (fit.derivative((low + high) / 2) >= 0 ? low : high) = (low + high) / 2;
    if (!peak || fit(low) > fit(*peak)) peak = low;
  }
  if (peak) peak = about + reach * *peak;
  return peak;
}

}  // namespace petzval
