// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/measure/sfr/edge_evidence.h>
#include <petzval/measure/sfr/edge_fit.h>
#include <petzval/measure/sfr/edge_spread_model.h>
#include <petzval/measure/sfr/measure_edge.h>
#include <petzval/measure/sfr/sample_comb.h>
#include <petzval/measure/sfr/stated_deviations.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace petzval {

namespace {

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

void refuse_smooth_light(const EdgeFit& fit, const std::vector<EdgeSample>& samples, double lattice_step,
                         double places) {
  // The unknowns of the line besides: where it runs and how it is bent.
  const double unknowns = fit.unknowns() + 1 + static_cast<double>(fit.line().bend.size());
  const double enough = 2 * std::log(places);
  if (edge_evidence(fit.profile(), samples, static_cast<int>(lattice_step), unknowns, enough) < enough)
    throw InputError("no edge stands out: light that changes smoothly explains the pixels as well");
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

/// Where contrast falls below a level for the first time, straight between values `step_cpp` apart; NaN where
/// it does not.
double level_between(double level, const std::vector<double>& contrast, double step_cpp) {
  const auto below = std::find_if(contrast.begin(), contrast.end(), [&](double c) { return c < level; });
  if (below == contrast.begin() || below == contrast.end()) return NAN;
  const double before = *(below - 1);
  return step_cpp *
         (static_cast<double>(below - contrast.begin()) - 1 + (before - level) / (before - *below));
}

/// A level between two frequencies.
class LevelSearch {
 public:
  LevelSearch(double level, const std::vector<double>& contrast, double step_cpp) : level_(level) {
    const auto below = std::find_if(contrast.begin(), contrast.end(), [&](double c) { return c < level; });
    if (below == contrast.begin() || below == contrast.end()) return;
    high_ = step_cpp * static_cast<double>(below - contrast.begin()), low_ = high_ - step_cpp;
    high_rest_ = *below - level, low_rest_ = *(below - 1) - level;
    found_ = true;
  }
  bool open() const { return found_ && high_ - low_ > 1e-12; }
  /// Where to look in the next round.
  double next(int round) const {
    // Alternately where a chord passes and in the middle, so that both ends close in.
    const double at =
        round % 3 == 2 ? 0.5 * (low_ + high_) : low_ + (high_ - low_) * low_rest_ / (low_rest_ - high_rest_);
    return std::clamp(at, low_, high_);
  }
  void take(double at, double contrast) {
    const double rest = contrast - level_;
    if (std::abs(rest) < 1e-12) {
      low_ = high_ = at;
      return;
    }
    (rest < 0 ? high_ : low_) = at;
    (rest < 0 ? high_rest_ : low_rest_) = rest;
  }
  MtfLevel result() const { return {level_, found_ ? 0.5 * (low_ + high_) : NAN, NAN}; }

 private:
  double level_, low_ = 0, high_ = 0, low_rest_ = 0, high_rest_ = 0;
  bool found_ = false;
};

/// The levels of the model itself, all at once. \param contrast  between values of which each lies.
std::vector<MtfLevel> find_levels(const EdgeSpreadModel& model, const std::vector<double>& contrast,
                                  double step_cpp) {
  std::vector<LevelSearch> searches;
  for (int percent = 90; percent >= 10; percent -= 10)
    searches.emplace_back(percent / 100.0, contrast, step_cpp);
  constexpr int most_rounds = 20;
  for (int round = 0; round < most_rounds; ++round) {
    std::vector<LevelSearch*> open;
    std::vector<double> places;
    for (LevelSearch& search : searches)
      if (search.open()) open.push_back(&search), places.push_back(search.next(round));
    if (open.empty()) break;
    const std::vector<std::complex<double>> transforms = model.transforms(places);
    for (std::size_t i = 0; i < open.size(); ++i) open[i]->take(places[i], std::abs(transforms[i]));
  }
  std::vector<MtfLevel> levels;
  for (const LevelSearch& search : searches) levels.push_back(search.result());
  return levels;
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

/// By how much each sample of the profile would change, were the edge recorded in the blocks of a JPEG again,
/// at `BorderedBand::lanes` places in them: what rounding does to their coefficients is much the same all
/// along an edge, so that it does not average out. Where in their steps the levels of both sides lay before
/// is not known, so they run through them.
std::vector<double> changes_by_recording(const EdgeFit& fit, const std::vector<EdgeSample>& samples,
                                         const RoundedBlocks& blocks, double rise_px) {
  constexpr std::array<RoundedBlocks::Offset, BorderedBand::lanes> offsets{
      {{0, 0}, {3, 1}, {6, 2}, {1, 3}, {4, 4}, {7, 5}, {2, 6}, {5, 7}}};
  const auto part_of_step = [&](std::size_t i) {
    return (static_cast<double>(i % offsets.size()) + 0.5) / offsets.size() - 0.5;
  };
  const double dark = fit.model().dark(), step = fit.model().step();
  const double room_dark = blocks.room_of_means(dark), room_bright = blocks.room_of_means(dark + step);
  std::mt19937 generator;  // of noise that is the same whatever the thread
  const double per_draw = fit.noise() * std::sqrt(12.0) / 0x1p32;
  // Blocks that touch the transition, and their neighbours; in others there is next to nothing but their
  // means.
  const EdgeProfile& profile = fit.profile();
  const double reach = 2 * (RoundedBlocks::side + rise_px);
  std::vector<std::size_t> near;
  std::vector<EdgeSample> near_samples;
  std::vector<double> expected;
  for (std::size_t point = 0; point < profile.points.size(); ++point) {
    if (std::abs(profile.points[point].distance) > reach) continue;
    near.push_back(point);
    near_samples.push_back(samples[profile.sample[point]]);
    expected.push_back(profile.fitted[point].value + profile.variation[point]);
  }
  std::vector<double> result(profile.points.size() * offsets.size());
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const double off_dark = part_of_step(i) * room_dark, off_bright = part_of_step(3 * i + 1) * room_bright;
    std::vector<double> light = expected;
    for (double& value : light) {
      const double share = std::clamp((value - dark) / step, 0.0, 1.0);
      value += off_dark + share * (off_bright - off_dark);
      value += per_draw * (static_cast<double>(generator()) - 0x1p31);
    }
    const std::vector<double> changes = blocks.changes(near_samples, light, offsets[i]);
    for (std::size_t k = 0; k < near.size(); ++k) result[near[k] * offsets.size() + i] = changes[k];
  }
  return result;
}

/// What |transform| may be off by.
class Uncertainty {
 public:
  Uncertainty(const EdgeFit& fit, const EdgeSpreadModel::Deviation& noise)
      : fit_(fit), noise_(noise), variants_(fit.variants()) {
    constexpr double extrapolated = 6e-3;  // of the tail, for samples up to a pixel from the edge
    const double reach = std::min(-fit.profile().low, fit.profile().high);
    tail_ = extrapolated * std::abs(fit.model().tail_px()) / reach;
  }
  /// Appends what there is at these frequencies. \param transforms  of the model there.
  void add_moduli(const std::vector<double>& frequencies_cpp,
                  const std::vector<std::complex<double>>& transforms, DeviationParts& parts) const {
    const std::vector<double> noise = noise_.of_moduli(frequencies_cpp, transforms);
    const std::size_t before = parts.of_samples.size(), count = frequencies_cpp.size();
    for (std::size_t i = 0; i < count; ++i) {
      const double f = frequencies_cpp[i];
      constexpr double all_of_it_cpp = 0.02;
      const double tail = tail_ * std::min(1.0, std::abs(f) / all_of_it_cpp);
      parts.of_samples.push_back(
          std::hypot(noise[i], tail, alias_deviation(fit_.model(), fit_.comb_px(), f)));
    }
    parts.model_square.resize(before + count), parts.square_variance.resize(before + count);
    for (const EdgeFit::Variant& variant : variants_) {
      const std::vector<std::complex<double>> others = variant.model.transforms(frequencies_cpp);
      const double told = std::max(0.1, std::abs(1 - variant.corners_left));  // of what corners add
      for (std::size_t i = 0; i < count; ++i) {
        const double difference = (std::abs(others[i]) - std::abs(transforms[i])) / told;
        const double of_noise = std::abs(1 / variant.share - 1) * noise[i] * noise[i] / (told * told);
        parts.model_square[before + i] += difference * difference - of_noise;
        parts.square_variance[before + i] += 2 * of_noise * of_noise;
      }
    }
  }
  /// Whether a comparison of profiles tells what corners add.
  bool tells_of_corners() const {
    return std::ranges::any_of(variants_, [](const EdgeFit::Variant& v) { return v.corners_left > 0; });
  }

 private:
  const EdgeFit& fit_;
  const EdgeSpreadModel::Deviation& noise_;
  std::vector<EdgeFit::Variant> variants_;
  double tail_;
};

void fill_levels(EdgeMeasurement& result, const EdgeSpreadModel& model, const Uncertainty& uncertainty) {
  // A transform of what lies within ±core changes over 1/(2 core).
  const double step = 1 / (8 * model.core_px());
  const double highest = std::max(1.0, result.frequencies_cpp.back());
  std::vector<double> contrast{1};
  // Until the last level is passed, and no farther.
  constexpr int together = 8;
  while (contrast.back() >= 0.1) {
    std::vector<double> places;
    for (std::size_t i = contrast.size(); i < contrast.size() + together; ++i)
      if (const double f = step * static_cast<double>(i); f <= highest + 1e-9) places.push_back(f);
    if (places.empty()) break;
    for (const std::complex<double>& value : model.transforms(places)) contrast.push_back(std::abs(value));
  }
  const auto last = std::ranges::find_if(contrast, [](double c) { return c < 0.1; });
  if (last != contrast.end()) contrast.erase(last + 1, contrast.end());
  result.mtf = find_levels(model, contrast, step);
  std::vector<double> passed;
  for (const MtfLevel& level : result.mtf)
    if (std::isfinite(level.frequency_cpp)) passed.push_back(level.frequency_cpp);
  std::size_t part = result.parts.of_samples.size();
  uncertainty.add_moduli(passed, model.transforms(passed), result.parts);
  for (const MtfLevel& level : result.mtf) {
    if (!std::isfinite(level.frequency_cpp)) continue;
    const double spread = result.parts.of_samples[part++];
    // Over as much as the deviation covers: at a point the slope is noisy, too.
    const double reach = std::clamp(2 * spread, 1e-4, 0.8 * std::min(level.level, 1 - level.level));
    const double before = level_between(level.level + reach, contrast, step);
    const double after = level_between(level.level - reach, contrast, step);
    const double run = std::isfinite(after) ? (after - before) / 2 : level.frequency_cpp - before;
    result.parts.level_run.push_back(run / reach);
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
  if (options.places > 0) refuse_smooth_light(fit, samples, lattice_step, options.places);
  const EdgeNoise spread = noise_about(profile, model, fit.unknowns());
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
  const std::vector<double> changes =
      options.blocks != nullptr ? changes_by_recording(fit, samples, *options.blocks, result.rise_px)
                                : std::vector<double>();
  const EdgeSpreadModel::Deviation deviation(model, variance, rounding, changes);
  result.frequencies_cpp = options.frequencies_cpp.empty() ? usual_frequencies() : options.frequencies_cpp;
  const Uncertainty uncertainty(fit, deviation);
  const std::vector<std::complex<double>> transforms = model.transforms(result.frequencies_cpp);
  uncertainty.add_moduli(result.frequencies_cpp, transforms, result.parts);
  for (const std::complex<double>& value : transforms) {
    result.sfr.push_back(std::abs(value));
    result.phase_rad.push_back(std::arg(value));
  }
  // With rows half a pixel apart the alias of Nyquist's frequency lies beyond what lenses and pixels
  // pass.
  if (constexpr double harmless_px = 0.5; fit.comb_px() > harmless_px)
    result.notes.push_back(
        "the edge runs along the pixel grid or its diagonal, so that its profile is known in rows only; a "
        "tilt "
        "by half a degree is enough to tell what lies between");
  fill_levels(result, model, uncertainty);
  const std::array<double, 3> levels{result.mtf[1].frequency_cpp, result.mtf[4].frequency_cpp,
                                     result.mtf[7].frequency_cpp};
  if (std::ranges::all_of(levels, [](double f) { return std::isfinite(f); }))
    result.level_correlations = deviation.correlations(levels);
  fill_curves(result, model, profile);
  result.parts.corners = uncertainty.tells_of_corners() ? fit.added_by_corners() : 0;
  result.parts.without_noise = fit.without_noise();
  EdgeMeasurement* const alone = &result;
  state_deviations({&alone, 1});
  return result;
}

}  // namespace petzval
