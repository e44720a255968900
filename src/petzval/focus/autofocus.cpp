// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/focus/autofocus.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace petzval {

namespace {

/// 2 − the golden ratio: where golden section places its next point.
constexpr double golden = 0.3819660112501051;

/// How far from the peak its flanks are asked, in widths of the curve: where its slope is steep.
constexpr double flank_widths = 0.5;

/// Asks for pictures and keeps the account.
class Judge {
 public:
  Judge(const PicturesAt& pictures_at, const std::vector<FocusZone>& zones,
        const FocusMeasureOptions& measure)
      : pictures_at_(pictures_at), zones_(zones), measure_(measure) {
    if (zones.empty()) throw InputError("autofocus needs at least one zone");
  }

  double at(double film_distance_mm, const char* stage) {
    const std::vector<ZonePicture> pictures = pictures_at_(film_distance_mm);
    if (pictures.size() != zones_.size())
      throw InputError(fmt::format("{} pictures for {} zones", pictures.size(), zones_.size()));
    double sum = 0, area = 0;
    for (std::size_t i = 0; i < zones_.size(); ++i) {
      sum += zones_[i].area() * focus_measure(pictures[i], measure_);
      area += zones_[i].area();
    }
    const double value = sum / area;
    if (!std::isfinite(value)) throw InputError("a picture holds a value that is not finite");
    result.evaluations.push_back({film_distance_mm, value, stage});
    if (value > result.measure) {
      result.measure = value;
      result.film_distance_mm = film_distance_mm;
    }
    return value;
  }

  int count() const { return static_cast<int>(result.evaluations.size()); }

  FocusResult result;

 private:
  const PicturesAt& pictures_at_;
  const std::vector<FocusZone>& zones_;
  const FocusMeasureOptions& measure_;
};

void check_range(double nearest_mm, double farthest_mm) {
  if (!(nearest_mm >= 0 && nearest_mm < farthest_mm) || !std::isfinite(farthest_mm))
    throw InputError(fmt::format("film distances from {} to {} mm are no range", nearest_mm, farthest_mm));
}

void require_contrast(const FocusResult& result) {
  if (!(result.measure > 0))
    throw InputError("no picture has any contrast in the zones; zones with some detail would be right");
}

/// What is made as small as possible. No contrast at all is worse than any.
double cost_of(double measure) {
  return measure > 0 ? -std::log(measure) : std::numeric_limits<double>::max();
}

/// A place and its cost.
struct Tried {
  double x, cost;
};

/// Brent's search between two ends, starting from three places already tried: the best, and the ends of its
/// bracket.
class BrentSearch {
 public:
  BrentSearch(Tried low, Tried best, Tried high)
      : low_(low.x),
        high_(high.x),
        best_(best),
        second_(low.cost < high.cost ? low : high),
        third_(low.cost < high.cost ? high : low),
        last_step_(high.x - low.x),
        step_before_(high.x - low.x) {}

  double best() const { return best_.x; }
  /// The next place worth trying; nothing when the best is known to `tolerance`.
  std::optional<double> next(double tolerance) {
    const double middle = (low_ + high_) / 2;
    if (std::abs(best_.x - middle) <= 2 * tolerance - (high_ - low_) / 2) return {};
    double step = 0;
    if (!parabola(step) || std::abs(step) >= std::abs(step_before_) / 2 || best_.x + step <= low_ ||
        best_.x + step >= high_) {
      step_before_ = best_.x < middle ? high_ - best_.x : low_ - best_.x;
      step = golden * step_before_;
    } else {
      step_before_ = last_step_;
      // Never at a bracket's end, nor where something has been tried.
      if (best_.x + step - low_ < 2 * tolerance || high_ - best_.x - step < 2 * tolerance)
        step = std::copysign(tolerance, middle - best_.x);
    }
    last_step_ = step;
    return best_.x + (std::abs(step) >= tolerance ? step : std::copysign(tolerance, step));
  }

  void add(Tried tried) {
    if (tried.cost <= best_.cost) {
      (tried.x < best_.x ? high_ : low_) = best_.x;
      third_ = second_, second_ = best_, best_ = tried;
      return;
    }
    (tried.x < best_.x ? low_ : high_) = tried.x;
    if (tried.cost <= second_.cost || second_.x == best_.x) {
      third_ = second_, second_ = tried;
    } else if (tried.cost <= third_.cost || third_.x == best_.x || third_.x == second_.x) {
      third_ = tried;
    }
  }

  /// From the best to the vertex of the parabola through the best three; false if it has none.
  bool parabola(double& step) const {
    const double r = (best_.x - second_.x) * (best_.cost - third_.cost);
    const double q = (best_.x - third_.x) * (best_.cost - second_.cost);
    const double denominator = 2 * (q - r);
    if (denominator == 0 || !std::isfinite(denominator)) return false;
    step = -((best_.x - third_.x) * q - (best_.x - second_.x) * r) / denominator;
    return std::isfinite(step);
  }
  bool brackets(double x) const { return x > low_ && x < high_; }
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  double low_, high_;
  Tried best_, second_, third_;
  double last_step_, step_before_;
};

/// log measure = height − power · log((x − peak)² + width²), fitted to evaluations.
struct DefocusCurve {
  double peak = 0, width = 0, height = 0, power = 0, residual = std::numeric_limits<double>::infinity();
};

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

/// The best curve whose peak lies in (low, high), by search on ever finer grids.
std::optional<DefocusCurve> fit_curve(const FocusResult& result, double low, double high, double tolerance) {
  constexpr int places = 41, widths = 24, rounds = 6;
  DefocusCurve best;
  double least_width = std::max(tolerance / 4, 1e-12), greatest_width = high - low;
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
    least_width = std::max(best.width / ratio, 1e-12), greatest_width = best.width * ratio;
  }
  return best;
}

/// The vertex of the parabola that fits the logarithm of the measure best within `reach` of the peak; nothing
/// without three places there or a maximum. Near the peak this holds for any blur, lopsided ones too.
std::optional<double> local_vertex(const FocusResult& result, double peak, double reach) {
  // Sums of powers of x, and of y with them, x = (place − peak)/reach.
  double p[5] = {}, q[3] = {};
  int count = 0;
  for (const FocusEvaluation& each : result.evaluations) {
    const double x = (each.film_distance_mm - peak) / reach;
    if (std::abs(x) > 1 || !(each.measure > 0)) continue;
    const double y = std::log(each.measure / result.measure);
    ++count;
    double power = 1;
    for (int k = 0; k < 5; ++k, power *= x) {
      p[k] += power;
      if (k < 3) q[k] += power * y;
    }
  }
  if (count < 3) return {};
  const double determinant = p[0] * (p[2] * p[4] - p[3] * p[3]) - p[1] * (p[1] * p[4] - p[2] * p[3]) +
                             p[2] * (p[1] * p[3] - p[2] * p[2]);
  const double slope = p[0] * (q[1] * p[4] - q[2] * p[3]) - q[0] * (p[1] * p[4] - p[2] * p[3]) +
                       p[2] * (p[1] * q[2] - p[2] * q[1]);
  const double bend = p[0] * (p[2] * q[2] - p[3] * q[1]) - p[1] * (p[1] * q[2] - p[2] * q[1]) +
                      q[0] * (p[1] * p[3] - p[2] * p[2]);
  if (!(std::abs(determinant) > 1e-9) || !(bend / determinant < 0)) return {};
  const double vertex = -slope / (2 * bend);
  return std::abs(vertex) <= 1 ? std::optional(peak + reach * vertex) : std::nullopt;
}

/// How far the nearest place that has been tried is.
double nearest_tried(const FocusResult& result, double x) {
  double least = std::numeric_limits<double>::infinity();
  for (const FocusEvaluation& each : result.evaluations)
    least = std::min(least, std::abs(each.film_distance_mm - x));
  return least;
}

}  // namespace

FocusResult find_focus(const PicturesAt& pictures_at, const std::vector<FocusZone>& zones,
                       const FocusSearchOptions& options) {
  check_range(options.nearest_mm, options.farthest_mm);
  if (options.coarse < 3 || options.most_evaluations < options.coarse)
    throw InputError("a search for focus takes at least 3 coarse evaluations, and no fewer in all");
  const double range = options.farthest_mm - options.nearest_mm;
  const double tolerance = options.tolerance_mm > 0 ? options.tolerance_mm : range / 1000;
  Judge judge(pictures_at, zones, options.measure);
  std::vector<Tried> coarse;
  for (int i = 0; i < options.coarse; ++i) {
    const double x = options.nearest_mm + range * i / (options.coarse - 1);
    coarse.push_back({x, cost_of(judge.at(x, "coarse"))});
  }
  require_contrast(judge.result);
  auto best =
      std::min_element(coarse.begin(), coarse.end(), [](Tried a, Tried b) { return a.cost < b.cost; });
  // At an end, the bracket is the last interval, with its middle.
  Tried middle = *best;
  std::ptrdiff_t at = best - coarse.begin();
  Tried low = coarse[static_cast<std::size_t>(std::max<std::ptrdiff_t>(at - 1, 0))];
  Tried high = coarse[static_cast<std::size_t>(std::min<std::ptrdiff_t>(at + 1, options.coarse - 1))];
  while ((low.x == middle.x || high.x == middle.x) && judge.count() < options.most_evaluations &&
         high.x - low.x > tolerance) {
    const double x =
        low.x == middle.x ? low.x + golden * (high.x - low.x) : high.x - golden * (high.x - low.x);
    const Tried inside{x, cost_of(judge.at(x, "fine"))};
    if (inside.cost < middle.cost) {
      middle = inside;
    } else {
      (low.x == middle.x ? high : low) = inside;
    }
  }
  BrentSearch search(low, middle, high);
  std::optional<DefocusCurve> curve;
  int settled = 0;
  while (judge.count() < options.most_evaluations && settled < 2) {
    curve = fit_curve(judge.result, search.low(), search.high(), tolerance);
    std::optional<double> x = curve ? std::optional(curve->peak) : search.next(tolerance);
    if (!x) break;
    if (nearest_tried(judge.result, *x) < tolerance) {
      // Known there; the flanks of the peak say more about where it is.
      const double flank = std::max(2 * tolerance, curve ? flank_widths * curve->width : 0);
      // A flank inside of the bracket, however wide the peak is.
      const double up = std::min(flank, 0.7 * (search.high() - *x)),
                   down = std::min(flank, 0.7 * (*x - search.low()));
      x = *x + (settled == 0 ? up : -down);
      ++settled;
      if (!search.brackets(*x) || nearest_tried(judge.result, *x) < tolerance) continue;
    }
    search.add({*x, cost_of(judge.at(*x, "fine"))});
  }
  curve = fit_curve(judge.result, options.nearest_mm, options.farthest_mm, tolerance);
  FocusResult result = std::move(judge.result);
  if (curve && std::abs(curve->peak - result.film_distance_mm) < range / (options.coarse - 1))
    result.film_distance_mm =
        local_vertex(result, curve->peak, std::max(3 * tolerance, 1.2 * flank_widths * curve->width))
            .value_or(curve->peak);
  result.at_the_end = std::min(result.film_distance_mm - options.nearest_mm,
                               options.farthest_mm - result.film_distance_mm) < 2 * tolerance;
  return result;
}

FocusResult find_focus_2006(const PicturesAt& pictures_at, const std::vector<FocusZone>& zones,
                            const GoldenSearchOptions& options) {
  check_range(options.nearest_mm, options.farthest_mm);
  if (!(options.tolerance_mm > 0 && options.first_interval_mm > 0 && options.growth >= 1))
    throw InputError("golden section needs a positive tolerance and intervals that do not shrink");
  Judge judge(pictures_at, zones, options.measure);
  double width = options.first_interval_mm;
  for (double from = options.nearest_mm; from < options.farthest_mm; width *= options.growth) {
    double low = from, high = std::min(from + width, options.farthest_mm);
    from = high;
    int weak = 0;
    const auto ask = [&](double x) {
      const double before = judge.result.measure, value = judge.at(x, "golden");
      weak = value < options.weak_share * before ? weak + 1 : 0;
      return value;
    };
    double a = low + golden * (high - low), b = high - golden * (high - low);
    double at_a = ask(a), at_b = ask(b);
    while (high - low > options.tolerance_mm && weak < options.weak_in_a_row) {
      if (at_a > at_b) {
        high = b, b = a, at_b = at_a;
        a = low + golden * (high - low);
        at_a = ask(a);
      } else {
        low = a, a = b, at_a = at_b;
        b = high - golden * (high - low);
        at_b = ask(b);
      }
    }
  }
  require_contrast(judge.result);
  return std::move(judge.result);
}

}  // namespace petzval
