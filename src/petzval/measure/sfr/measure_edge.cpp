// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/measure/sfr/edge_spread_model.h>
#include <petzval/measure/sfr/measure_edge.h>
#include <petzval/measure/sfr/sample_comb.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// Samples by distance from a line; those beyond the range in which every distance is well covered are left
/// out.
struct Profile {
  std::vector<EdgePoint> points;
  std::vector<std::size_t> sample;  ///< of each point
  double low = 0, high = 0;
};

/// From the edge outwards as long as a pixel's width of distances holds a quarter of what it holds at the
/// edge.
Profile profile_along(const std::vector<EdgeSample>& samples, const EdgeLine& line) {
  std::vector<double> distance;
  double reach = 0;
  for (const EdgeSample& s : samples) {
    distance.push_back(line.distance(s.x, s.y));
    reach = std::max(reach, std::abs(distance.back()));
  }
  const int half = static_cast<int>(reach / 2) + 1;
  std::vector<int> count(2 * static_cast<std::size_t>(half) + 1);  // of cells two pixels wide
  const auto cell = [&](double d) {
    return static_cast<std::size_t>(half + static_cast<int>(std::lround(d / 2)));
  };
  for (const double d : distance) ++count[cell(d)];
  const auto middle = static_cast<std::size_t>(half);
  const int enough = std::max(4, count[middle] / 4);
  std::size_t first = middle, last = middle;
  while (first > 0 && count[first - 1] >= enough) --first;
  while (last + 1 < count.size() && count[last + 1] >= enough) ++last;
  Profile profile;
  profile.low = 2 * (static_cast<double>(first) - half) - 1;
  profile.high = 2 * (static_cast<double>(last) - half) + 1;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (distance[i] >= profile.low && distance[i] <= profile.high) {
      profile.points.push_back({distance[i], samples[i].value});
      profile.sample.push_back(i);
    }
  return profile;
}

/// Variance of the samples about a profile, as a function of the value: one near each level, linear between.
struct Noise {
  double dark = 0, bright = 0;  ///< variances
  double all = 0;
};

Noise noise_about(const Profile& profile, const EdgeSpreadModel& model) {
  double sum[2] = {0, 0}, weight[2] = {0, 0};
  for (const EdgePoint& point : profile.points) {
    const double expected = model.value(point.distance);
    const double residual = point.value - expected;
    const int side = expected > model.dark() + 0.5 * model.step() ? 1 : 0;
    sum[side] += residual * residual;
    weight[side] += 1;
  }
  // The unknowns of the profile take their share of the residuals.
  const double n = static_cast<double>(profile.points.size());
  const double freedom = std::max(0.1, 1 - static_cast<double>(model.unknowns()) / n);
  return {sum[0] / std::max(1.0, weight[0]) / freedom, sum[1] / std::max(1.0, weight[1]) / freedom,
          (sum[0] + sum[1]) / n / freedom};
}

EdgeSpreadOptions model_options(const Profile& profile, double scale_px, double noise) {
  // Beyond five times the rise a profile has nothing but its tail; the tail needs a third of the range.
  const double rise = 4.39 * scale_px;
  EdgeSpreadOptions options;
  options.core_px = std::min(8 + 4 * rise, 0.7 * std::min(-profile.low, profile.high));
  options.blur_px = std::max(1.0, 0.5 * rise);
  options.noise = noise;
  // Quarters of a pixel carry frequencies up to 1.5 cycles/pixel; a wide blur has little beyond 0.7.
  options.knot_px = options.core_px > 45 ? 0.5 : 0.25;
  return options;
}

/// A profile as alignment sees it.
struct Spread {
  std::function<double(double)> value, slope;
};

Spread logistic(const EdgeGuess& guess) {
  const double step = guess.bright - guess.dark, scale = guess.scale_px;
  const auto share = [=](double d) { return 1 / (1 + std::exp(-d / scale)); };
  return {[=](double d) { return guess.dark + step * share(d); },
          [=](double d) { return step / scale * share(d) * (1 - share(d)); }};
}

/// One Gauss-Newton step for direction and bends: residual ≈ −E′(d) ∂d/∂p δp. An offset is left to the
/// profile. \returns the largest shift of the line anywhere [pixels].
double align(EdgeLine& line, const Profile& profile, const std::vector<EdgeSample>& samples,
             const Spread& spread) {
  const auto unknowns = static_cast<Eigen::Index>(line.bend.size());
  const Eigen::Index n = unknowns + 1;  // bend[0] … and an offset, which the profile takes
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  for (std::size_t i = 0; i < profile.points.size(); ++i) {
    const EdgePoint& point = profile.points[i];
    const double slope = spread.slope(point.distance);
    const EdgeSample& sample = samples[profile.sample[i]];
    const double t = line.along(sample.x, sample.y);
    Eigen::VectorXd row(n);
    double power = 1;
    for (Eigen::Index k = 0; k < n; ++k, power *= t) row[k] = -slope * power;
    normal.selfadjointView<Eigen::Lower>().rankUpdate(row);
    right += row * (point.value - spread.value(point.distance));
  }
  normal = normal.selfadjointView<Eigen::Lower>();
  normal.diagonal() *= 1 + 1e-12;
  const Eigen::VectorXd change = normal.ldlt().solve(right);
  if (!change.allFinite()) throw InputError("the edge is too short to tell its direction");
  double shift = 0;
  for (Eigen::Index k = 1; k < n; ++k) {
    line.bend[static_cast<std::size_t>(k - 1)] += change[k];
    shift += std::abs(change[k]);
  }
  return shift;
}

/// A straight bend belongs to the direction, so that distances are exact.
void turn_by_bend(EdgeLine& line) {
  if (line.bend.size() != 1) return;
  line.normal_rad -= std::atan(line.bend[0] / line.half_length);
  line.bend[0] = 0;
}

void refuse_clipped(const Profile& profile, const std::vector<EdgeSample>& samples, const SfrOptions& options,
                    double rise_px) {
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

MtfLevel find_level(const EdgeSpreadModel& model, double level, double highest_cpp) {
  MtfLevel result{level, NAN, NAN};
  constexpr double step = 1.0 / 512;
  for (double f = step; f <= highest_cpp + 1e-9; f += step) {
    const double here = std::abs(model.transform(f));
    if (here < level) {
      double low = f - step, high = f;
      for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (low + high);
        (std::abs(model.transform(middle)) < level ? high : low) = middle;
      }
      result.frequency_cpp = 0.5 * (low + high);
      break;
    }
  }
  return result;
}

void fill_levels(EdgeMeasurement& result, const EdgeSpreadModel& model, const Profile& profile,
                 const std::vector<double>& variance, const QuantisationNoise& rounding, double comb_px) {
  for (int percent = 90; percent >= 10; percent -= 10)
    result.mtf.push_back(find_level(model, percent / 100.0, std::max(1.0, result.frequencies_cpp.back())));
  std::vector<double> at;
  for (const MtfLevel& level : result.mtf)
    if (std::isfinite(level.frequency_cpp)) at.push_back(level.frequency_cpp);
  const std::vector<double> deviation = model.modulus_deviation(at, profile.points, variance, rounding);
  std::size_t i = 0;
  for (MtfLevel& level : result.mtf) {
    if (!std::isfinite(level.frequency_cpp)) continue;
    constexpr double h = 1e-4;
    const double slope = (std::abs(model.transform(level.frequency_cpp + h)) -
                          std::abs(model.transform(level.frequency_cpp - h))) /
                         (2 * h);
    level.deviation_cpp = std::hypot(deviation[i++], alias_deviation(model, comb_px, level.frequency_cpp)) /
                          std::max(1e-9, std::abs(slope));
  }
}

void fill_curves(EdgeMeasurement& result, const EdgeSpreadModel& model, const Profile& profile) {
  constexpr double spacing = 0.125;
  const double low = std::ceil(profile.low / spacing) * spacing;
  double least = 0, most = 1;
  for (double d = low; d <= profile.high; d += spacing) {
    const double value = (model.value(d) - model.dark()) / model.step();
    result.distance_px.push_back(d);
    result.esf.push_back(value);
    result.lsf.push_back(model.slope(d) / model.step());
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

}  // namespace

EdgeMeasurement measure_edge(std::vector<EdgeSample> samples, double lattice_step,
                             const SfrOptions& options) {
  if (options.edge_order < 1 || options.edge_order > 5)
    throw InputError(fmt::format("an edge of order {}: 1 (straight) to 5 is right", options.edge_order));
  const EdgeGuess guess = guess_edge(samples, lattice_step);
  EdgeLine line = guess.line;
  line.bend.assign(static_cast<std::size_t>(options.edge_order), 0);

  std::optional<EdgeSpreadModel> model;
  Profile profile;
  // A bend comes from the smooth profile of the guess first: a free profile would follow what a bend
  // scatters.
  constexpr int rounds_of_guess = 12;
  for (int round = 0; round < rounds_of_guess && options.edge_order > 1; ++round)
    align(line, profile_along(samples, line), samples, logistic(guess));
  double noise = 1e-4 * (guess.bright - guess.dark), missing_scale = 0;
  constexpr int most_rounds = 40;
  // Half a thousandth of a pixel over the length of an edge changes no SFR by 1e-6; noise-free edges get
  // there at once.
  constexpr double at_rest_px = 1e-6;
  for (int round = 0; round < most_rounds; ++round) {
    profile = profile_along(samples, line);
    if (options.missing_target && missing_scale != 0)
      for (std::size_t i = 0; i < profile.points.size(); ++i) {
        const EdgeSample& s = samples[profile.sample[i]];
        profile.points[i].value -= missing_scale * options.missing_target(s.x, s.y);
      }
    model.emplace(profile.points, model_options(profile, guess.scale_px, noise));
    if (!(model->step() > 0)) throw InputError("no edge stands out: its two sides are equally bright");
    noise = std::sqrt(noise_about(profile, *model).all);
    // K₃ of the PSF is half the edge's tail.
    missing_scale = options.missing_target ? 0.5 * model->tail_px() * model->step() : 0;
    const double shift =
        align(line, profile, samples,
              {[&](double d) { return model->value(d); }, [&](double d) { return model->slope(d); }});
    turn_by_bend(line);
    if (round > 2 && shift < std::max(at_rest_px, 1e-3 * noise / model->step())) break;
  }

  const double comb_px = sample_comb_px(profile.points);
  if (comb_px > 0) {
    join_rows(profile.points);
    model.emplace(profile.points, model_options(profile, guess.scale_px, noise));
  }

  EdgeMeasurement result;
  result.line = line;
  result.samples = profile.points.size();
  result.dark = model->dark();
  result.bright = model->dark() + model->step();
  result.tail_px = model->tail_px();
  result.middle_px = middle_of(*model, profile.low, profile.high);
  result.rise_px = rise_of(*model, profile.low, profile.high);
  refuse_clipped(profile, samples, options, result.rise_px);
  const Noise spread = noise_about(profile, *model);
  result.noise_dark = std::sqrt(spread.dark);
  result.noise_bright = std::sqrt(spread.bright);
  std::vector<double> variance, unrounded;
  for (const EdgePoint& point : profile.points) {
    const double value = model->value(point.distance);
    const double share = std::clamp((value - model->dark()) / model->step(), 0.0, 1.0);
    unrounded.push_back(
        std::abs(point.distance) > 1.5 * result.rise_px ? usual_tail_at(point.distance, result) : value);
    variance.push_back(spread.dark + share * (spread.bright - spread.dark));
  }
  const QuantisationNoise rounding(options.code_levels, unrounded, variance);
  result.frequencies_cpp = options.frequencies_cpp.empty() ? usual_frequencies() : options.frequencies_cpp;
  for (const double f : result.frequencies_cpp) {
    const std::complex<double> value = model->transform(f);
    result.sfr.push_back(std::abs(value));
    result.phase_rad.push_back(std::arg(value));
  }
  result.sfr_deviation = model->modulus_deviation(result.frequencies_cpp, profile.points, variance, rounding);
  for (std::size_t i = 0; i < result.sfr.size(); ++i)
    result.sfr_deviation[i] =
        std::hypot(result.sfr_deviation[i], alias_deviation(*model, comb_px, result.frequencies_cpp[i]));
  // With rows half a pixel apart the alias of Nyquist's frequency lies beyond what lenses and pixels
  // pass.
  if (constexpr double harmless_px = 0.5; comb_px > harmless_px)
    result.notes.push_back(
        fmt::format("the edge runs along the pixel grid or its diagonal, so that its profile is known only "
                    "every {:.2f} pixels; a tilt "
                    "by half a degree is enough to tell what lies between",
                    comb_px));
  fill_levels(result, *model, profile, variance, rounding, comb_px);
  fill_curves(result, *model, profile);
  return result;
}

}  // namespace petzval
