// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/measure/sfr/edge_fit.h>
#include <petzval/measure/sfr/sample_comb.h>
#include <petzval/measure/sfr/smooth_about_edge.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

namespace petzval {

EdgeNoise noise_about(const EdgeProfile& profile, const EdgeSpreadModel& model, double unknowns) {
  const double middle = model.dark() + 0.5 * model.step();
  double sum_dark = 0, sum_bright = 0;
  std::size_t bright = 0;
  for (std::size_t i = 0; i < profile.points.size(); ++i) {
    const double expected = profile.fitted[i].value;
    const double residual = profile.points[i].value - expected - profile.variation[i];
    const double square = residual * residual;
    const bool is_bright = expected > middle;
    sum_dark += is_bright ? 0 : square;
    sum_bright += is_bright ? square : 0;
    bright += is_bright ? 1 : 0;
  }
  // The unknowns of the profile take their share of the residuals.
  const double n = static_cast<double>(profile.points.size());
  const double freedom = std::max(0.1, 1 - unknowns / n);
  const double n_bright = static_cast<double>(bright);
  return {sum_dark / std::max(1.0, n - n_bright) / freedom, sum_bright / std::max(1.0, n_bright) / freedom,
          (sum_dark + sum_bright) / n / freedom};
}

namespace {

constexpr double significant = 5, least_bend_px = 2e-3, least_variation = 4e-3, least_curvature = 1e-3;

/// Where samples leave gaps like this in the profile, it is known in rows only.
constexpr double plain_gap_px = 0.2;
/// How far from where a smooth profile puts it a line may settle near the pixel grid.
constexpr double free_to_move_px = 0.015;

/// The largest distance of two lines of about the same place along the shorter.
double farthest_apart_px(const EdgeLine& a, const EdgeLine& b) {
  double farthest = 0;
  const EdgeFrame frame(a);
  for (int i = -4; i <= 4; ++i) {
    const double along = 0.25 * i;
    double offset = 0, power = 1;
    for (const double bend : b.bend) offset += bend * (power *= along);
    const double c = std::cos(b.normal_rad), s = std::sin(b.normal_rad), way = along * b.half_length;
    farthest = std::max(
        farthest,
        std::abs(frame.at(b.centre_x + offset * c - way * s, b.centre_y + offset * s + way * c).distance));
  }
  return farthest;
}

bool at_rest(const EdgeAlignment& change) {
  // A hundred-thousandth of a pixel changes no SFR by 1e-6. Nor do steps count that are small beside their
  // own uncertainty, as along the pixel grid, where a bend and the profile are hard to tell apart.
  constexpr double at_rest_px = 2e-5, at_rest_deviations = 0.03;
  double significance = 0;
  for (int k = 1; k <= change.order; ++k) significance = std::max(significance, change.significance(k));
  return shift_of(change) < at_rest_px || significance < at_rest_deviations;
}

/// The part of a step that repeats an earlier one.
double likeness(const EdgeAlignment& step, const EdgeAlignment& earlier) {
  double product = 0, square = 0;
  for (int k = 1; k <= step.order; ++k) {
    product += step.change[k] * earlier.change[k];
    square += earlier.change[k] * earlier.change[k];
  }
  return std::min(0.9, product / std::max(1e-300, square));
}

/// How far the profile passes the levels of its sides.
double overshoot(const EdgeSpreadModel& model) {
  constexpr double step_px = 0.1;
  double farthest = 0;
  for (double d = step_px; d < model.core_px(); d += step_px)
    farthest =
        std::max({farthest, model.dark() - model.value(-d), model.value(d) - model.dark() - model.step()});
  return farthest;
}

/// The lowest frequency of half the contrast, to a hundredth; 0 if there is none up to 1.
double mtf50_cpp(const EdgeSpreadModel& model) {
  constexpr double step = 0.01;
  constexpr int together = BorderedBand::lanes;
  double before = 1;
  for (int first = 1; first * step < 1; first += together) {
    std::vector<double> frequencies;
    for (int i = first; i < first + together && i * step < 1; ++i) frequencies.push_back(i * step);
    for (std::size_t i = 0; const std::complex<double>& value : model.transforms(frequencies)) {
      const double contrast = std::abs(value), f = frequencies[i++];
      if (contrast < 0.5) return f - step * (0.5 - contrast) / (before - contrast);
      before = contrast;
    }
  }
  return 0;
}

}  // namespace

EdgeFit::EdgeFit(const std::vector<EdgeSample>& samples, const EdgeGuess& guess, const SfrOptions& options)
    : samples_(samples),
      guess_(guess),
      line_(guess.line),
      noise_(1e-4 * (guess.bright - guess.dark)),
      corners_(options.corners) {
  line_.bend.assign(static_cast<std::size_t>(std::max(1, options.edge_order)), 0);
  if (options.missing_target) find_missing(options.missing_target);
}

void EdgeFit::run(const SfrOptions& options) {
  bend_by_guess(options);
  // The first profile is rough, and tells the noise.
  fit_placed();
  align(line_, line_alignment(), 1);
  turn_by_bend(line_);
  light_order_ = options.varying_light ? 1 : 0;
  in_rows_ = widest_gap_px(profile_.points) > plain_gap_px;
  if (in_rows_)
    settle_in_rows(options);
  else
    settle_by_evidence(options);
  comb_px_ = sample_comb_px(profile_.points);
  if (comb_px_ > 0) {
    join_rows(profile_.points);
    smoothing_ = -1;
    fit_profile();
  }
  keep_clear_of_corners();
  if (!quiet() && !in_rows_ && comb_px_ == 0) fit_to_shapes();
}

/// Samples that say all themselves.
bool EdgeFit::quiet() const {
  constexpr double share = 1e-3;
  return noise_ < share * model_->step();
}

/// What is left of samples that finer splines would not take for noise.
bool EdgeFit::without_noise() const {
  constexpr double share = 1e-4;
  return noise_ < share * model_->step();
}

/// Once more with what edges look like, now that the line rests and the noise is known, unless smoothness
/// alone explains the samples better. Light makes no profile that passes its levels, sharpening does.
void EdgeFit::fit_to_shapes() {
  compare_with({});
  constexpr double plain_deviations = 4, least_share = 5e-3;
  const double deviation = noise_ * std::sqrt(unknowns_ / static_cast<double>(profile_.points.size()));
  const bool sharpened =
      overshoot(*model_) > std::max(plain_deviations * deviation, least_share * model_->step());
  const double smooth = model_->criterion();
  constexpr int rounds = 2;
  constexpr double alike = 0.02;  // a tenth of how well shapes expect the width to be known
  double before = 0;
  for (int round = 0; round < rounds && !sharpened; ++round) {
    const double mtf50 = mtf50_cpp(*model_);
    if (!EdgeShapes::possible(mtf50, line_.normal_rad) || std::abs(mtf50 - before) < alike * mtf50) break;
    compare_with(EdgeShapes(mtf50, line_.normal_rad));
    before = mtf50;
  }
  if (model_->options().prior.shapes && model_->criterion() >= smooth) compare_with({});
  smoothing_ = -1;
  take_profile();
}

void EdgeFit::compare_with(const std::optional<EdgeShapes>& shapes) {
  EdgePriorOptions prior = model_->options().prior;
  prior.noise = noise_, prior.shapes = shapes;
  model_->take_prior(prior, profile_.points);
}

void EdgeFit::settle_by_evidence(const SfrOptions& options) {
  settle();
  if (options.edge_order == 0) bend_by_evidence();
  if (light_order_ > 0) judge_light();
}

/// Close to the pixel grid a profile in steps that stand between the rows of samples fits along a tilted line
/// as well as a smooth one along the right line, and takes up whatever else the model lacks. Splines as far
/// apart as the rows cannot make such steps: they settle the line, and free ones may move it by little.
void EdgeFit::settle_in_rows(const SfrOptions& options) {
  coarse_ = true;
  settle_by_evidence(options);
  coarse_ = false;
  const EdgeLine smooth = line_;
  const double light = light_variation_;
  settle();
  if (farthest_apart_px(line_, smooth) < free_to_move_px) return;
  line_ = smooth;
  smoothing_ = -1;
  fit_placed();
  light_variation_ = light;
}

void EdgeFit::find_missing(const std::function<double(double, double)>& missing_target) {
  double low = 0, high = 0;
  const EdgeFrame frame(line_);
  for (const EdgeSample& s : samples_) {
    const double d = frame.at(s.x, s.y).distance;
    low = std::min(low, d), high = std::max(high, d);
  }
  const SmoothAboutEdge smooth(missing_target, line_, {low, high}, {13, 11});
  missing_ = smooth.at(samples_);
}

void EdgeFit::place_samples() {
  profile_ = profile_along(samples_, line_);
  if (most_along_ < 1) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < profile_.points.size(); ++i) {
      if (std::abs(profile_.points[i].along) > most_along_) continue;
      profile_.points[kept] = profile_.points[i];
      profile_.sample[kept++] = profile_.sample[i];
    }
    profile_.points.resize(kept), profile_.sample.resize(kept), profile_.variation.resize(kept);
  }
  for (std::size_t i = 0; i < profile_.points.size(); ++i) {
    EdgePoint& point = profile_.points[i];
    const std::size_t sample = profile_.sample[i];
    if (!missing_.empty()) point.missing = missing_[sample];
    if (light_order_ > 0) point.light = light_[sample];
  }
}

/// Of each sample, as the last profile has it.
void EdgeFit::expect_light() {
  const double dark = model_->dark(), step = model_->step(), bright = dark + step;
  const double per_bright = 1 / std::max(bright, 1e-3 * step);
  light_.resize(samples_.size());
  for (std::size_t i = 0; i < profile_.points.size(); ++i)
    light_[profile_.sample[i]] = std::clamp(profile_.fitted[i].value, dark, bright) * per_bright;
}

void EdgeFit::fit_placed() {
  place_samples();
  fit_profile();
}

void EdgeFit::fit_profile() {
  // Beyond five times the rise a profile has nothing but its tail; the tail needs a third of the range.
  const double rise = 4.39 * guess_.scale_px;
  EdgeSpreadOptions options;
  options.core_px = std::min(8 + 4 * rise, 0.7 * std::min(-profile_.low, profile_.high));
  options.prior.blur_px = std::max(1.0, 0.5 * rise);
  options.prior.noise = noise_;
  // Quarters of a pixel carry frequencies up to 1.5 cycles/pixel; a wide blur has little beyond 0.7.
  options.knot_px = coarse_ ? 0.7 : options.core_px > 45 ? 0.5 : 0.25;
  options.light_order = light_order_;
  options.smoothing = smoothing_;
  if (in_rows_) options.prior.least_smoothing_share = 0.03;
  model_.emplace(profile_.points, options, model_ ? model_->release() : EdgeRows());
  if (light_order_ == 1 && smoothing_ < 0) leave_out_even_light();
  take_profile();
}

/// Light that plainly does not matter, or cannot be told from noise, need not be fitted until the line rests.
void EdgeFit::leave_out_even_light() {
  constexpr double plainly = 0.5;
  const double reach = std::min(-profile_.low, profile_.high);
  if (model_->variation_over(reach) > plainly * least_variation &&
      model_->variation_significance(model_->likely_noise()) > plainly * significant)
    return;
  light_order_ = 0;
  model_->take_light_to_order(light_order_, profile_.points);
}

void EdgeFit::take_profile() {
  if (!(model_->step() > 0)) throw InputError("no edge stands out: its two sides are equally bright");
  model_->evaluate_points(profile_.points, profile_.fitted, profile_.variation);
  expect_light();
  // Of the first, rough profile the data settle nearly all.
  if (smoothing_ < 0)
    unknowns_ = model_->unknowns();
  else if (unknowns_ == 0)
    unknowns_ = model_->most_unknowns();
  noise_ = std::sqrt(noise_about(profile_, *model_, unknowns_).all);
}

EdgeAlignment EdgeFit::line_alignment() const {
  return alignment(profile_, *model_, static_cast<int>(line_.bend.size()), noise_);
}

/// A bend comes from the smooth profile of the guess first: a free profile would follow what a bend
/// scatters.
void EdgeFit::bend_by_guess(const SfrOptions& options) {
  const int asked = options.edge_order;
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
    fit_logistic(profile, guess_, reach);
    change = alignment(profile, static_cast<int>(bent.bend.size()), reach, guess_.rms_residual);
    if (align(bent, change, 1) < 1e-3) break;
  }
  // Noise can hide from an outline that it is an arc, but not from all samples together.
  constexpr double arc_deviations = 3;
  if (bent.radius_px() < options.least_radius_px &&
      std::abs(bent.bend[1]) > arc_deviations * change.deviation[2])
    throw InputError(
        fmt::format("an arc with a radius of {:.0f} pixels, where straight edges have at least {:.0f}",
                    bent.radius_px(), options.least_radius_px));
  constexpr double plainly_bent_px = 0.1;
  bool plainly = asked > 1;
  for (int k = 2; k <= change.order; ++k) {
    const double bend = std::abs(bent.bend[static_cast<std::size_t>(k - 1)]);
    plainly = plainly || (bend > plainly_bent_px && bend > significant * change.deviation[k]);
  }
  if (plainly) line_ = bent;
}

void EdgeFit::settle() {
  smoothing_ = -1;
  move_to_rest();
}

void EdgeFit::move_to_rest() {
  constexpr int most_rounds = 40;
  EdgeAlignment before;
  double length = 1;  // of a step, over the one that a linear problem needs
  for (int round = 0; round < most_rounds; ++round) {
    fit_placed();
    smoothing_ = model_->smoothing();
    const EdgeAlignment change = line_alignment();
    if (at_rest(change)) break;
    // A step that repeats the one before was too short, one that takes it back too long (J. Barzilai & J.
    // M. Borwein, IMA J. Numer. Anal. 8, 141, 1988).
    if (round > 0) length = std::clamp(length / (1 - likeness(change, before)), 0.3, 3.0);
    before = change;
    align(line_, change, length);
    turn_by_bend(line_);
  }
}

void EdgeFit::bend_by_evidence() {
  if (line_.bend.size() > 1) return;  // it is bent already
  const EdgeAlignment bends = alignment(profile_, *model_, 3, noise_);
  const auto shown = [&](int k) {
    return bends.significance(k) > significant && std::abs(bends.change[k]) > least_bend_px;
  };
  if (!shown(2) && !shown(3)) return;
  line_.bend.assign(shown(3) ? 3 : 2, 0);
  settle();
}

bool EdgeFit::light_varies(double least_share) const {
  const double reach = std::min(-profile_.low, profile_.high);
  return model_->variation_over(reach) > least_share && model_->variation_significance(noise_) > significant;
}

/// Keeps the light that varies as far as the samples show it, and tries a parabola where they do.
void EdgeFit::judge_light() {
  const double reach = std::min(-profile_.low, profile_.high);
  const double linear = 2 * model_->variation_over(reach);
  if (light_varies(least_variation)) {
    light_variation_ = linear;
    light_order_ = 2;
    settle();
    if (light_varies(least_curvature)) return;
    light_order_ = 1;
  } else {
    light_order_ = 0;
  }
  model_->take_light_to_order(light_order_, profile_.points);
  take_profile();
  const EdgeAlignment change = line_alignment();
  if (at_rest(change)) return;
  align(line_, change, 1);
  turn_by_bend(line_);
  move_to_rest();
}

}  // namespace petzval
