// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/measure/sfr/edge_alignment.h>
#include <petzval/measure/sfr/edge_spread_model.h>
#include <petzval/measure/sfr/measure_edge.h>
#include <petzval/measure/sfr/sample_comb.h>
#include <petzval/measure/sfr/smooth_about_edge.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace petzval {

namespace {

/// Variance of the samples about a profile, as a function of the value: one near each level, linear between.
struct Noise {
  double dark = 0, bright = 0;  ///< variances
  double all = 0;
};

/// \param unknowns  of the profile, that the data settle.
Noise noise_about(const EdgeProfile& profile, const EdgeSpreadModel& model, double unknowns) {
  double sum[2] = {0, 0}, weight[2] = {0, 0};
  for (std::size_t i = 0; i < profile.points.size(); ++i) {
    const double expected = profile.fitted[i].value;
    const double residual = profile.points[i].value - expected - profile.variation[i];
    const int side = expected > model.dark() + 0.5 * model.step() ? 1 : 0;
    sum[side] += residual * residual;
    weight[side] += 1;
  }
  // The unknowns of the profile take their share of the residuals.
  const double n = static_cast<double>(profile.points.size());
  const double freedom = std::max(0.1, 1 - unknowns / n);
  return {sum[0] / std::max(1.0, weight[0]) / freedom, sum[1] / std::max(1.0, weight[1]) / freedom,
          (sum[0] + sum[1]) / n / freedom};
}

void refuse_clipped(const EdgeProfile& profile, const std::vector<EdgeSample>& samples,
                    const SfrOptions& options, double rise_px) {
  // A level that is reached exactly within one rise of the edge, before a profile can have come to rest.
  for (const bool high : {false, true}) {
    const std::optional<double> clip = high ? options.clip_high : options.clip_low;
    if (!clip) continue;
    std::size_t near = 0, clipped = 0;
    for (std::size_t i = 0; i < profile.points.size(); ++i) {
      const double distance = profile.points[i].distance, outward = high ? distance : -distance;
      if (outward < 0.5 * rise_px || outward > 1.0 * rise_px) continue;
      ++near;
      const double value = samples[profile.sample[i]].value;  // as it was recorded
      if (high ? value >= *clip : value <= *clip) ++clipped;
    }
    if (near > 0 && clipped * 2 > near)
      throw InputError(
          fmt::format("the edge is clipped: its {} side has reached the limit of the pixel values within the "
                      "transition; expose or scale the picture so that both levels lie inside the range",
                      high ? "bright" : "dark"));
  }
}

/// Distance between the places where the profile first passes 10 % and last passes 90 %.
double rise_of(const EdgeSpreadModel& model, double low, double high) {
  const double from = model.dark() + 0.1 * model.step(), to = model.dark() + 0.9 * model.step();
  double start = low, end = high;
  constexpr double h = 0.02;
  for (double d = 0; d > low; d -= h)
    if (model.value(d) < from) {
      start = d;
      break;
    }
  for (double d = 0; d < high; d += h)
    if (model.value(d) > to) {
      end = d;
      break;
    }
  return end - start;
}

/// Where the profile passes one half nearest to the line, by bisection in a range that holds the passage.
double middle_of(const EdgeSpreadModel& model, double low, double high) {
  const double half = model.dark() + 0.5 * model.step();
  double from = low, to = high;
  for (double reach = 0.25; reach < std::min(-low, high); reach *= 2)
    if (model.value(-reach) < half && model.value(reach) > half) {
      from = -reach, to = reach;
      break;
    }
  for (int i = 0; i < 60; ++i) {
    const double at = 0.5 * (from + to);
    (model.value(at) < half ? from : to) = at;
  }
  return 0.5 * (from + to);
}

/// Where contrast falls below a level for the first time, from values `step_cpp` apart.
MtfLevel find_level(const EdgeSpreadModel& model, double level, const std::vector<double>& contrast,
                    double step_cpp) {
  MtfLevel result{level, NAN, NAN};
  const auto below = std::find_if(contrast.begin(), contrast.end(), [&](double c) { return c < level; });
  if (below == contrast.begin() || below == contrast.end()) return result;
  double high = step_cpp * static_cast<double>(below - contrast.begin()), low = high - step_cpp;
  double high_rest = *below - level, low_rest = *(below - 1) - level;
  for (int i = 0; i < 20 && high - low > 1e-12; ++i) {
    // Alternately where a chord passes and in the middle, so that both ends close in.
    double at = i % 3 == 2 ? 0.5 * (low + high) : low + (high - low) * low_rest / (low_rest - high_rest);
    at = std::clamp(at, low, high);
    const double rest = std::abs(model.transform(at)) - level;
    if (std::abs(rest) < 1e-14) {
      low = high = at;
      break;
    }
    (rest < 0 ? high : low) = at;
    (rest < 0 ? high_rest : low_rest) = rest;
  }
  result.frequency_cpp = 0.5 * (low + high);
  return result;
}

void fill_curves(EdgeMeasurement& result, const EdgeSpreadModel& model, const EdgeProfile& profile) {
  constexpr double spacing = 0.125;
  const double low = std::ceil(profile.low / spacing) * spacing;
  double least = 0, most = 1;
  for (double d = low; d <= profile.high; d += spacing) {
    const auto at = model.evaluate(d);
    const double value = (at.value - model.dark()) / model.step();
    result.distance_px.push_back(d);
    result.esf.push_back(value);
    result.lsf.push_back(at.slope / model.step());
    least = std::min(least, value), most = std::max(most, value);
  }
  result.overshoot = most - 1;
  result.undershoot = -least;
}

/// A value far from the edge as diffraction has it. Where rounding has flattened a tail, the profile does not
/// tell through how much of a step the light still runs.
double usual_tail_at(double distance, const EdgeMeasurement& edge) {
  const double missing = usual_tail_px * (edge.bright - edge.dark) / distance;
  return (distance > 0 ? edge.bright : edge.dark) - missing;
}

std::vector<double> usual_frequencies() {
  std::vector<double> frequencies;
  for (int i = 0; i <= 100; ++i) frequencies.push_back(i / 100.0);
  return frequencies;
}

/// Line and profile of one edge, fitted in turn.
class EdgeFit {
 public:
  EdgeFit(const std::vector<EdgeSample>& samples, const EdgeGuess& guess, const SfrOptions& options)
      : samples_(samples), guess_(guess), line_(guess.line), noise_(1e-4 * (guess.bright - guess.dark)) {
    line_.bend.assign(static_cast<std::size_t>(std::max(1, options.edge_order)), 0);
    if (options.missing_target) find_missing(options.missing_target);
  }

  void run(const SfrOptions& options) {
    bend_by_guess(options.edge_order);
    // The first profile is rough, and tells the noise.
    fit_placed();
    align(line_, alignment_of(static_cast<int>(line_.bend.size())), 1);
    turn_by_bend(line_);
    varying_light_ = options.varying_light;
    settle();
    if (options.edge_order == 0) bend_by_evidence();
    if (options.varying_light) judge_light();
    comb_px_ = sample_comb_px(profile_.points);
    if (comb_px_ > 0) {
      join_rows(profile_.points);
      smoothing_ = -1;
      fit_profile();
    }
  }

  /// The same profile by other splines: finer ones, which end nearer.
  EdgeSpreadModel variant() const {
    EdgeSpreadOptions options = model_->options();
    options.core_px *= 0.85, options.knot_px *= 0.8;
    options.noise = noise_, options.smoothing = 0;
    return EdgeSpreadModel(profile_.points, options);
  }
  double noise() const { return noise_; }

  const EdgeLine& line() const { return line_; }
  const EdgeProfile& profile() const { return profile_; }
  const EdgeSpreadModel& model() const { return *model_; }
  double unknowns() const { return unknowns_; }
  double comb_px() const { return comb_px_; }
  double light_variation() const { return light_variation_; }

 private:
  static constexpr double significant = 5, least_bend_px = 2e-3, least_variation = 4e-3;

  void find_missing(const std::function<double(double, double)>& missing_target) {
    double low = 0, high = 0;
    const EdgeFrame frame(line_);
    for (const EdgeSample& s : samples_) {
      const double d = frame.at(s.x, s.y).distance;
      low = std::min(low, d), high = std::max(high, d);
    }
    const SmoothAboutEdge smooth(missing_target, line_, {low, high}, {13, 11});
    for (const EdgeSample& s : samples_) missing_.push_back(smooth(s.x, s.y));
  }

  void place_samples() {
    profile_ = profile_along(samples_, line_);
    for (std::size_t i = 0; i < profile_.points.size(); ++i) {
      EdgePoint& point = profile_.points[i];
      const std::size_t sample = profile_.sample[i];
      if (!missing_.empty()) point.missing = missing_[sample];
      if (varying_light_) point.light = light_[sample];
    }
  }

  /// Of each sample, as the last profile has it.
  void expect_light() {
    const double dark = model_->dark(), step = model_->step(), bright = dark + step;
    const double per_bright = 1 / std::max(bright, 1e-3 * step);
    light_.resize(samples_.size());
    for (std::size_t i = 0; i < profile_.points.size(); ++i)
      light_[profile_.sample[i]] = std::clamp(profile_.fitted[i].value, dark, bright) * per_bright;
  }

  void fit_placed() {
    place_samples();
    fit_profile();
  }

  void fit_profile() {
    // Beyond five times the rise a profile has nothing but its tail; the tail needs a third of the range.
    const double rise = 4.39 * guess_.scale_px;
    EdgeSpreadOptions options;
    options.core_px = std::min(8 + 4 * rise, 0.7 * std::min(-profile_.low, profile_.high));
    options.blur_px = std::max(1.0, 0.5 * rise);
    options.noise = noise_;
    // Quarters of a pixel carry frequencies up to 1.5 cycles/pixel; a wide blur has little beyond 0.7.
    options.knot_px = options.core_px > 45 ? 0.5 : 0.25;
    options.varying_light = varying_light_;
    options.smoothing = smoothing_;
    model_.emplace(profile_.points, options);
    take_profile();
  }

  void take_profile() {
    if (!(model_->step() > 0)) throw InputError("no edge stands out: its two sides are equally bright");
    profile_.variation = model_->variation();
    profile_.fitted = model_->fitted();
    expect_light();
    if (smoothing_ < 0 || unknowns_ == 0) unknowns_ = model_->unknowns();
    noise_ = std::sqrt(noise_about(profile_, *model_, unknowns_).all);
  }

  EdgeAlignment alignment_of(int order) const { return alignment(profile_, *model_, order, noise_); }

  /// A bend comes from the smooth profile of the guess first: a free profile would follow what a bend
  /// scatters.
  void bend_by_guess(int asked) {
    if (asked == 1) return;
    EdgeLine bent = line_;
    bent.bend.assign(static_cast<std::size_t>(asked == 0 ? 3 : asked), 0);
    const double reach = 6 * guess_.scale_px + 1;
    constexpr double most_bent_px = 10;
    std::vector<EdgeSample> near;
    const EdgeFrame frame(line_);
    for (const EdgeSample& s : samples_)
      if (std::abs(frame.at(s.x, s.y).distance) < reach + most_bent_px) near.push_back(s);
    constexpr int rounds = 12;
    EdgeAlignment change;
    for (int round = 0; round < rounds; ++round) {
      EdgeProfile profile = profile_along(near, bent);
      fit_logistic(profile, guess_);
      change = alignment(profile, static_cast<int>(bent.bend.size()), reach, guess_.rms_residual);
      if (align(bent, change, 1) < 1e-3) break;
    }
    constexpr double plainly_bent_px = 0.1;
    bool plainly = asked > 1;
    for (int k = 2; k <= change.order; ++k) {
      const double bend = std::abs(bent.bend[static_cast<std::size_t>(k - 1)]);
      plainly = plainly || (bend > plainly_bent_px && bend > significant * change.deviation[k]);
    }
    if (plainly) line_ = bent;
  }

  void settle() {
    constexpr int most_rounds = 40;
    EdgeAlignment before;
    double length = 1;  // of a step, over the one that a linear problem needs
    for (int round = 0; round < most_rounds; ++round) {
      if (round == 0) smoothing_ = -1;
      fit_placed();
      smoothing_ = model_->smoothing();
      const EdgeAlignment change = alignment_of(static_cast<int>(line_.bend.size()));
      if (at_rest(change)) break;
      // A step that repeats the one before was too short, one that takes it back too long (J. Barzilai & J.
      // M. Borwein, IMA J. Numer. Anal. 8, 141, 1988).
      if (round > 0) length = std::clamp(length / (1 - likeness(change, before)), 0.3, 3.0);
      before = change;
      align(line_, change, length);
      turn_by_bend(line_);
    }
  }

  static bool at_rest(const EdgeAlignment& change) {
    // A hundred-thousandth of a pixel changes no SFR by 1e-6. Nor do steps count that are small beside their
    // own uncertainty, as along the pixel grid, where a bend and the profile are hard to tell apart.
    constexpr double at_rest_px = 2e-5, at_rest_deviations = 0.03;
    double significance = 0;
    for (int k = 1; k <= change.order; ++k) significance = std::max(significance, change.significance(k));
    return shift_of(change) < at_rest_px || significance < at_rest_deviations;
  }

  /// The part of a step that repeats an earlier one.
  static double likeness(const EdgeAlignment& step, const EdgeAlignment& earlier) {
    double product = 0, square = 0;
    for (int k = 1; k <= step.order; ++k) {
      product += step.change[k] * earlier.change[k];
      square += earlier.change[k] * earlier.change[k];
    }
    return std::min(0.9, product / std::max(1e-300, square));
  }

  void bend_by_evidence() {
    if (line_.bend.size() > 1) return;  // it is bent already
    const EdgeAlignment bends = alignment_of(3);
    const auto shown = [&](int k) {
      return bends.significance(k) > significant && std::abs(bends.change[k]) > least_bend_px;
    };
    if (!shown(2) && !shown(3)) return;
    line_.bend.assign(shown(3) ? 3 : 2, 0);
    settle();
  }

  void judge_light() {
    const double reach = std::min(-profile_.low, profile_.high);
    const EdgeSpreadModel::Variation variation = model_->variation_over(reach, noise_);
    varying_light_ = variation.significance > significant && variation.share > least_variation;
    if (varying_light_) {
      light_variation_ = 2 * variation.share;
    } else {
      model_->take_light_for_even(profile_.points);
      take_profile();
      const EdgeAlignment change = alignment_of(static_cast<int>(line_.bend.size()));
      if (at_rest(change)) return;
      align(line_, change, 1);
      turn_by_bend(line_);
      settle();
    }
  }

  const std::vector<EdgeSample>& samples_;
  const EdgeGuess& guess_;
  EdgeLine line_;
  EdgeProfile profile_;
  std::optional<EdgeSpreadModel> model_;
  std::vector<double> missing_, light_;  ///< of each sample
  double noise_, smoothing_ = 0, unknowns_ = 0, comb_px_ = 0, light_variation_ = 0;
  bool varying_light_ = false;
};

/// What |transform| may be off by, for all reasons together.
class Uncertainty {
 public:
  Uncertainty(const EdgeFit& fit, const EdgeSpreadModel::Deviation& noise) : fit_(fit), noise_(noise) {
    // What a model of splines and a tail cannot follow shows where there is next to no noise: in what other
    // splines make of the same samples, and in how far the tail is extrapolated.
    constexpr double quiet = 1e-3;
    if (fit.noise() < quiet * fit.model().step() && fit.comb_px() == 0) variant_.emplace(fit.variant());
    constexpr double extrapolated = 7e-4;  // of the step, for samples up to a pixel from the edge
    tail_ = extrapolated / std::min(-fit.profile().low, fit.profile().high);
  }
  std::vector<double> of_moduli(const std::vector<double>& frequencies_cpp) const {
    std::vector<double> deviations = noise_.of_moduli(frequencies_cpp);
    for (std::size_t i = 0; i < deviations.size(); ++i) {
      const double f = frequencies_cpp[i];
      const double other =
          variant_ ? std::abs(variant_->transform(f)) - std::abs(fit_.model().transform(f)) : 0;
      constexpr double all_of_it_cpp = 0.02;
      const double model = std::hypot(other, tail_ * std::min(1.0, std::abs(f) / all_of_it_cpp));
      deviations[i] = std::hypot(deviations[i], model, alias_deviation(fit_.model(), fit_.comb_px(), f));
    }
    return deviations;
  }

 private:
  const EdgeFit& fit_;
  const EdgeSpreadModel::Deviation& noise_;
  std::optional<EdgeSpreadModel> variant_;
  double tail_;
};

void fill_levels(EdgeMeasurement& result, const EdgeSpreadModel& model, const Uncertainty& uncertainty) {
  // A transform of what lies within ±core changes over 1/(2 core).
  const double step = 1 / (8 * model.core_px());
  const double highest = std::max(1.0, result.frequencies_cpp.back());
  std::vector<double> contrast{1};
  // Until the last level is passed, and no farther.
  for (double f = step; f <= highest + 1e-9 && contrast.back() >= 0.1; f += step)
    contrast.push_back(std::abs(model.transform(f)));
  std::vector<double> passed;
  for (int percent = 90; percent >= 10; percent -= 10) {
    result.mtf.push_back(find_level(model, percent / 100.0, contrast, step));
    if (std::isfinite(result.mtf.back().frequency_cpp)) passed.push_back(result.mtf.back().frequency_cpp);
  }
  const std::vector<double> deviations = uncertainty.of_moduli(passed);
  auto of_modulus = deviations.begin();
  for (MtfLevel& level : result.mtf) {
    if (!std::isfinite(level.frequency_cpp)) continue;
    const double spread = *of_modulus++;
    // Over as much as the deviation covers: at a point the slope is noisy, too.
    const double reach = std::clamp(2 * spread, 1e-4, 0.8 * std::min(level.level, 1 - level.level));
    const double before = find_level(model, level.level + reach, contrast, step).frequency_cpp;
    const double after = find_level(model, level.level - reach, contrast, step).frequency_cpp;
    const double run = std::isfinite(after) ? (after - before) / 2 : level.frequency_cpp - before;
    level.deviation_cpp = spread * run / reach;
  }
}

}  // namespace

EdgeMeasurement measure_edge(const std::vector<EdgeSample>& samples, double lattice_step,
                             const SfrOptions& options) {
  if (options.edge_order < 0 || options.edge_order > 5)
    throw InputError(fmt::format("an edge of order {}: 1 (straight) to 5, or 0 (by the evidence) is right",
                                 options.edge_order));
  const EdgeGuess guess =
      options.start ? guess_edge(samples, *options.start) : guess_edge(samples, lattice_step);
  EdgeFit fit(samples, guess, options);
  fit.run(options);
  const EdgeSpreadModel& model = fit.model();
  const EdgeProfile& profile = fit.profile();

  EdgeMeasurement result;
  result.line = fit.line();
  result.samples = profile.points.size();
  result.dark = model.dark();
  result.bright = model.dark() + model.step();
  result.tail_px = model.tail_px();
  result.light_variation = fit.light_variation();
  result.middle_px = middle_of(model, profile.low, profile.high);
  result.rise_px = rise_of(model, profile.low, profile.high);
  refuse_clipped(profile, samples, options, result.rise_px);
  const Noise spread = noise_about(profile, model, fit.unknowns());
  result.noise_dark = std::sqrt(spread.dark);
  result.noise_bright = std::sqrt(spread.bright);
  std::vector<double> variance, unrounded;
  for (std::size_t i = 0; i < profile.points.size(); ++i) {
    const EdgePoint& point = profile.points[i];
    const double value = profile.fitted[i].value;
    const double share = std::clamp((value - model.dark()) / model.step(), 0.0, 1.0);
    unrounded.push_back(
        std::abs(point.distance) > 1.5 * result.rise_px ? usual_tail_at(point.distance, result) : value);
    variance.push_back(spread.dark + share * (spread.bright - spread.dark));
  }
  const QuantisationNoise rounding(options.code_levels, unrounded, variance);
  const EdgeSpreadModel::Deviation deviation(model, variance, rounding);
  result.frequencies_cpp = options.frequencies_cpp.empty() ? usual_frequencies() : options.frequencies_cpp;
  const Uncertainty uncertainty(fit, deviation);
  result.sfr_deviation = uncertainty.of_moduli(result.frequencies_cpp);
  for (std::size_t i = 0; i < result.frequencies_cpp.size(); ++i) {
    const double f = result.frequencies_cpp[i];
    const std::complex<double> value = model.transform(f);
    result.sfr.push_back(std::abs(value));
    result.phase_rad.push_back(std::arg(value));
    result.sfr_deviation[i] = std::hypot(result.sfr_deviation[i], alias_deviation(model, fit.comb_px(), f));
  }
  // With rows half a pixel apart the alias of Nyquist's frequency lies beyond what lenses and pixels
  // pass.
  if (constexpr double harmless_px = 0.5; fit.comb_px() > harmless_px)
    result.notes.push_back(
        fmt::format("the edge runs along the pixel grid or its diagonal, so that its profile is known only "
                    "every {:.2f} pixels; a tilt "
                    "by half a degree is enough to tell what lies between",
                    fit.comb_px()));
  fill_levels(result, model, uncertainty);
  fill_curves(result, model, profile);
  return result;
}

}  // namespace petzval
