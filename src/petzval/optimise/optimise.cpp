// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_rows.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/stop.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/ray_transfer.h>
#include <petzval/lens/surface_shape.h>
#include <petzval/numeric/random.h>
#include <petzval/optimise/glass_choice.h>
#include <petzval/optimise/optimise.h>
#include <petzval/optimise/ray_merit.h>

#include <Eigen/Dense>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <unsupported/Eigen/LevenbergMarquardt>

namespace petzval {

namespace {

/// The purpose of the random numbers.
constexpr std::uint32_t optimiser_starts = 0x0b71;
/// What a relative error of the focal length of 1, and a rim that is 1 mm too thin, cost in units of the
/// merit [µm]; of wavefronts [nm] fifty times as much, about as spots of a slow lens compare with its waves.
constexpr double efl_cost_um = 5e3, rim_cost_um = 1e3, nm_of_wave_per_um = 50;
/// A per cent of distortion too much costs as much as so many µm of spot, or per cent of MTF.
constexpr double distortion_cost_um = 100;
/// Stands for a lens through which a ray does not get: no step leads there.
constexpr double lost_ray = 1e6;
/// A round that improves less than by this share is the last. Steps of one round at most.
constexpr double worth_a_round = 1e-4;
constexpr int most_steps = 25, most_rounds = 1000, most_starts = 1000, most_glasses = 100;
/// A glass that improves the squares by less than this share is not worth a change. Rounds by which a glass
/// is judged.
constexpr double worth_a_glass = 1e-3;
constexpr int rounds_for_glass = 5;
/// Of differences that are smooth and cost nothing: a third of the digits.
constexpr double difference_share = 1e-6;

double efl_of(const Lens& lens) {
  return first_order(lens, lens.reference_wavelength_nm).efl_mm;
}

double sag_mm(const Surface& surface, double height_mm) {
  return surface_point(shape_of(surface), 0, height_mm).sag;
}

/// How thick the glass behind a surface is at the clear aperture [mm]; nothing for air or without a rim.
std::optional<double> glass_rim_mm(const Lens& lens, std::size_t surface) {
  const Surface& front = lens.surfaces[surface];
  if (front.material.is_air() || surface + 1 >= lens.surfaces.size()) return {};
  const Surface& back = lens.surfaces[surface + 1];
  if (!front.semi_diameter_mm || !back.semi_diameter_mm) return {};
  const double height = std::min(*front.semi_diameter_mm, *back.semi_diameter_mm);
  return front.thickness_mm + sag_mm(back, height) - sag_mm(front, height);
}

/// Of the largest of its azimuths; of a lens that is not round about where field 0 lands, along the field.
double distortion_percent(const Lens& lens, double object_field, const std::vector<double>& azimuths_deg) {
  const double nm = lens.reference_wavelength_nm, ideal = ideal_image_height_mm(lens, object_field, nm);
  double largest = 0;
  for (const double azimuth : azimuths_deg) {
    FieldTracer tracer(lens, nm, Tracer::Clip::none, azimuth);
    const std::optional<ChiefRay> chief = tracer.chief_ray(object_field);
    const bool centred = tracer.tracer().is_centred();
    const std::optional<ChiefRay> middle = centred ? std::nullopt : tracer.chief_ray(0);
    if (!chief || (!centred && !middle)) return lost_ray;
    const double height = chief->image_height_mm - (middle ? middle->image_height_mm : 0);
    largest = std::max(largest, 100 * std::abs(height / ideal - 1));
  }
  return largest;
}

/// Numbers that run without limits, mapped into those of the variables.
class Mapping {
 public:
  Mapping(const Lens& lens, const std::vector<LensVariable>& variables) : variables_(variables) {
    for (const LensVariable& variable : variables) {
      const double value = value_of(lens, variable.number);
      double scale = std::abs(value);
      if (variable.number.kind == LensNumber::Kind::curvature_per_mm)
        scale = std::max(scale, 1 / efl_of(lens));
      if (variable.number.kind == LensNumber::Kind::conic) scale = 1;
      if (variable.number.kind == LensNumber::Kind::power) scale = power_scale(lens, variable.number);
      if (variable.number.is_pose()) scale = 1;  // a mm or a degree
      scales_.push_back(scale > 0 && std::isfinite(scale) ? scale : 1);
    }
  }

  Lens lens_at(Lens lens, const Eigen::VectorXd& x) const {
    for (std::size_t i = 0; i < variables_.size(); ++i)
      lens = with_value(std::move(lens), variables_[i].number, value(i, x[static_cast<Eigen::Index>(i)]));
    return lens;
  }
  Eigen::VectorXd at(const Lens& lens) const {
    Eigen::VectorXd x(static_cast<Eigen::Index>(variables_.size()));
    for (std::size_t i = 0; i < variables_.size(); ++i) {
      const LensVariable& variable = variables_[i];
      const double now = value_of(lens, variable.number);
      // Off the limits themselves, where the sine stands still.
      constexpr double edge = 1 - 1e-3;
      x[static_cast<Eigen::Index>(i)] =
          variable.is_bounded()
              ? std::asin(std::clamp((now - middle(variable)) / half(variable), -edge, edge))
              : now / scales_[i];
    }
    return x;
  }
  /// Of the variable's number by x.
  double slope(std::size_t i, double x) const {
    return variables_[i].is_bounded() ? half(variables_[i]) * std::cos(x) : scales_[i];
  }
  const std::vector<LensVariable>& variables() const { return variables_; }

 private:
  static double middle(const LensVariable& variable) { return 0.5 * (variable.low + variable.high); }
  static double half(const LensVariable& variable) { return 0.5 * (variable.high - variable.low); }
  double value(std::size_t i, double x) const {
    return variables_[i].is_bounded() ? middle(variables_[i]) + half(variables_[i]) * std::sin(x)
                                      : scales_[i] * x;
  }
  /// A coefficient that bends the rim by a hundredth of a millimetre.
  static double power_scale(const Lens& lens, const LensNumber& number) {
    const double rim = lens.surfaces[number.surface].semi_diameter_mm.value_or(0.1 * std::abs(efl_of(lens)));
    return 0.01 / std::pow(rim, number.power);
  }

  const std::vector<LensVariable>& variables_;
  std::vector<double> scales_;
};

/// Everything that is made small in one round.
class Objective : public Eigen::DenseFunctor<double> {
 public:
  struct Targets {
    double efl_mm;
    std::vector<std::pair<std::size_t, double>> rims;  ///< surface, and how thick its glass is to stay
    std::vector<double> fields = {};                   ///< object fields at which distortion counts
    double most_distortion_percent = 0;
    std::vector<double> azimuths_deg = {};  ///< of these fields

    std::size_t count() const { return 1 + rims.size() + fields.size(); }
  };

  Objective(const Lens& lens, const OptimiseRequest& request, const Mapping& mapping, const Targets& targets,
            const std::function<void()>& check_stop)
      : Objective(RayMerit(lens, request), lens, request, mapping, targets, check_stop) {}

  int operator()(const InputType& x, ValueType& values) const {
    evaluate(mapping_.lens_at(lens_, x), values, nullptr);
    return 0;
  }
  int df(const InputType& x, JacobianType& slopes) const {
    ValueType values(this->values());
    evaluate(mapping_.lens_at(lens_, x), values, &slopes);
    for (Eigen::Index i = 0; i < x.size(); ++i)
      slopes.col(i) *= mapping_.slope(static_cast<std::size_t>(i), x[i]);
    return 0;
  }

  const RayMerit& rays() const { return rays_; }
  /// Of the lens that this round began with.
  double start_cost() const {
    ValueType values(this->values());
    evaluate(lens_, values, nullptr);
    return values.squaredNorm();
  }

 private:
  Objective(RayMerit rays, const Lens& lens, const OptimiseRequest& request, const Mapping& mapping,
            const Targets& targets, const std::function<void()>& check_stop)
      : DenseFunctor<double>(static_cast<int>(request.variables.size()),
                             static_cast<int>(rays.rows()) + static_cast<int>(targets.count())),
        rays_(std::move(rays)),
        lens_(lens),
        mapping_(mapping),
        targets_(targets),
        check_stop_(check_stop),
        cost_(request.merit == OptimiseMerit::wavefront ? nm_of_wave_per_um : 1) {}

  /// Focal length, rims, distortion.
  Eigen::VectorXd others(const Lens& lens) const {
    Eigen::VectorXd values(static_cast<Eigen::Index>(targets_.count()));
    values[0] = cost_ * efl_cost_um * (efl_of(lens) / targets_.efl_mm - 1);
    for (std::size_t i = 0; i < targets_.rims.size(); ++i) {
      const auto& [surface, least] = targets_.rims[i];
      const double rim = glass_rim_mm(lens, surface).value_or(least);
      values[1 + static_cast<Eigen::Index>(i)] = cost_ * rim_cost_um * std::max(0.0, least - rim);
    }
    if (targets_.fields.empty()) return values;
    for (std::size_t i = 0; i < targets_.fields.size(); ++i)
      values[1 + static_cast<Eigen::Index>(targets_.rims.size() + i)] =
          cost_ * distortion_cost_um *
          std::max(0.0, distortion_percent(lens, targets_.fields[i], targets_.azimuths_deg) -
                            targets_.most_distortion_percent);
    return values;
  }

  void evaluate(const Lens& lens, ValueType& values, JacobianType* slopes) const {
    check_stop_();
    Eigen::MatrixXd ray_slopes;
    const auto rows = rays_.rows();
    const auto residuals = rays_.residuals(lens, slopes ? &ray_slopes : nullptr);
    const Eigen::VectorXd rest = others(lens);
    if (!residuals || !rest.allFinite()) {
      values.setConstant(lost_ray);
      if (slopes) slopes->setZero();
      return;
    }
    values << *residuals, rest;
    if (!slopes) return;
    slopes->topRows(rows) = ray_slopes;
    for (std::size_t i = 0; i < mapping_.variables().size(); ++i) {
      const LensNumber& number = mapping_.variables()[i].number;
      const double now = value_of(lens, number);
      const double step = difference_share * std::max(std::abs(now), std::abs(mapping_.slope(i, 0)));
      slopes->col(static_cast<Eigen::Index>(i)).tail(rest.size()) =
          (others(with_value(lens, number, now + step)) - others(with_value(lens, number, now - step))) /
          (2 * step);
    }
  }

  RayMerit rays_;
  Lens lens_;
  const Mapping& mapping_;
  const Targets& targets_;
  const std::function<void()>& check_stop_;
  double cost_;
};

/// A lens on its way.
struct Descent {
  Lens lens;
  double cost = 0;
  std::vector<double> by_round;
};

double merit_of(const Objective& objective, const Lens& lens) {
  const auto residuals = objective.rays().residuals(lens, nullptr);
  return residuals ? objective.rays().merit(*residuals) : lost_ray;
}

Descent descend(Lens lens, const OptimiseRequest& request, const Objective::Targets& targets,
                const std::function<void()>& check_stop, const std::function<void(int)>& round_done) {
  const Mapping mapping(lens, request.variables);
  Descent descent{std::move(lens), 0, {}};
  std::optional<Objective> objective(std::in_place, descent.lens, request, mapping, targets, check_stop);
  descent.cost = objective->start_cost();
  descent.by_round.push_back(merit_of(*objective, descent.lens));
  for (int round = 0; round < request.rounds; ++round) {
    Eigen::VectorXd x = mapping.at(descent.lens);
    Eigen::LevenbergMarquardt<Objective> search(*objective);
    search.setMaxfev(most_steps);
    search.minimize(x);
    round_done(round + 1);
    try {
      Lens next = mapping.lens_at(descent.lens, x);
      Objective fresh(next, request, mapping, targets, check_stop);
      const double cost = fresh.start_cost();
      if (!(cost < descent.cost)) break;
      const bool last = cost > descent.cost * (1 - worth_a_round);
      descent.lens = std::move(next);
      descent.cost = cost;
      descent.by_round.push_back(merit_of(fresh, descent.lens));
      if (last) break;
      objective.emplace(std::move(fresh));
    } catch (const InputError&) {
      break;  // no light gets through what the search came to
    }
  }
  return descent;
}

/// Of an MTF, from where the spots are least.
std::optional<Descent> descend_from_spots(const Lens& lens, const OptimiseRequest& request,
                                          const Objective::Targets& targets,
                                          const std::function<void()>& check_stop) {
  OptimiseRequest spots = request;
  spots.merit = OptimiseMerit::rms_spot;
  try {
    const Descent small = descend(lens, spots, targets, check_stop, [](int) {});
    return descend(small.lens, request, targets, check_stop, [](int) {});
  } catch (const InputError&) {
    return {};
  }
}

void keep_better(std::optional<Descent> other, Descent& best) {
  if (!other || !(other->cost < best.cost)) return;
  other->by_round.insert(other->by_round.begin(), best.by_round.front());
  best = *std::move(other);
}

/// A glass in the place of another, and the numbers as far as they have followed.
struct GlassTrial {
  std::size_t surface;
  std::shared_ptr<const Glass> glass;
  std::optional<Descent> descent;  ///< nothing if no light gets through
};

std::vector<GlassTrial> glass_trials(const Lens& lens, const OptimiseRequest& request) {
  std::vector<GlassTrial> trials;
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
    if (const std::shared_ptr<const Glass> glass = catalogue_glass(lens, i))
      for (auto& near :
           nearest_glasses(*glass, static_cast<std::size_t>(request.glasses), request.at.wavelengths_nm))
        trials.push_back({i, std::move(near), {}});
  return trials;
}

/// Changes one glass after another, each time the one that pays most, until none does.
void choose_glasses(Descent& best, const OptimiseRequest& request, const Objective::Targets& targets,
                    const std::function<void()>& check_stop, const ProgressCallback& progress) {
  OptimiseRequest brief = request;
  brief.rounds = std::min(request.rounds, rounds_for_glass);
  for (;;) {
    std::vector<GlassTrial> trials = glass_trials(best.lens, request);
    std::atomic<std::size_t> done = 0;
    parallel_tasks(trials.size(), [&](std::size_t i) {
      Lens lens = best.lens;
      lens.surfaces[trials[i].surface].material = Material(trials[i].glass);
      try {
        trials[i].descent = descend(std::move(lens), brief, targets, check_stop, [](int) {});
      } catch (const InputError&) {
      }
      if (progress) progress(static_cast<double>(++done) / static_cast<double>(trials.size()), "glasses");
    });
    const Descent* winner = nullptr;
    for (const GlassTrial& trial : trials)
      if (trial.descent && (!winner || trial.descent->cost < winner->cost)) winner = &*trial.descent;
    if (!winner || winner->cost > best.cost * (1 - worth_a_glass)) return;
    Descent next = descend(winner->lens, request, targets, check_stop, [](int) {});
    best.by_round.insert(best.by_round.end(), next.by_round.begin(), next.by_round.end());
    best.lens = std::move(next.lens);
    best.cost = next.cost;
  }
}

/// A lens beside the given one, within the limits of the variables.
Lens beside(const Lens& lens, const OptimiseRequest& request, std::uint64_t seed, std::size_t start) {
  const Mapping mapping(lens, request.variables);
  RandomStream random(seed, optimiser_starts, start);
  Lens result = lens;
  for (std::size_t i = 0; i < request.variables.size(); ++i) {
    const LensVariable& variable = request.variables[i];
    const double now = value_of(lens, variable.number);
    const double size = now != 0 ? std::abs(now) : std::abs(mapping.slope(i, 0));
    const double moved = now + request.start_spread * size * random.normal();
    result = with_value(std::move(result), variable.number, std::clamp(moved, variable.low, variable.high));
  }
  return result;
}

std::vector<LensVariable> usual_variables(const Lens& lens) {
  std::vector<LensVariable> variables = parse_lens_variables(lens, "radii");
  variables.push_back(parse_lens_variables(lens, "image").front());
  return variables;
}

void check(const Lens& lens, const OptimiseRequest& request) {
  require_glass(lens, "optimising needs");
  require_no_bends(lens, "optimising needs");
  lens.validate();
  for (std::size_t i = 0; i < request.variables.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const LensNumber& number = request.variables[i].number;
      if (number == request.variables[k].number)
        throw InputError(fmt::format("{} is a variable twice; once would be right", name_of(number)));
    }
  for (const double azimuth : request.azimuths_deg)
    if (!std::isfinite(azimuth)) throw InputError("an azimuth is not finite; degrees would be right");
  if (!request.field_weights.empty() && request.field_weights.size() != request.at.fields.size())
    throw InputError(fmt::format("{} weights for {} fields; one a field would be right",
                                 request.field_weights.size(), request.at.fields.size()));
  for (const double weight : request.field_weights)
    if (!(weight > 0) || !std::isfinite(weight))
      throw InputError(fmt::format("a field's weight of {:g}; a positive number would be right", weight));
  if (request.efl_mm && !(std::isfinite(*request.efl_mm) && *request.efl_mm != 0))
    throw InputError("a focal length that is not finite, or 0; a length in mm would be right");
  if (request.merit == OptimiseMerit::mtf &&
      !(request.mtf_frequency_cpmm > 0 && std::isfinite(request.mtf_frequency_cpmm)))
    throw InputError("an MTF without a frequency; cycles/mm above 0 would be right");
  if (request.most_distortion_percent && !(*request.most_distortion_percent >= 0))
    throw InputError("a largest distortion that is negative; 0 or more per cent would be right");
  if (request.rounds < 1 || request.rounds > most_rounds)
    throw InputError(fmt::format("{} rounds; 1 to {} would be right", request.rounds, most_rounds));
  if (request.starts < 1 || request.starts > most_starts)
    throw InputError(fmt::format("{} starts; 1 to {} would be right", request.starts, most_starts));
  if (!(request.start_spread > 0 && request.start_spread < 1))
    throw InputError(
        fmt::format("starts spread by {:g}; a share between 0 and 1 would be right", request.start_spread));
  if (request.glasses < 0 || request.glasses > most_glasses)
    throw InputError(fmt::format("{} glasses to try; 0 to {} would be right", request.glasses, most_glasses));
  bool any_glass = request.glasses == 0;
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i) any_glass = any_glass || catalogue_glass(lens, i);
  if (!any_glass)
    throw InputError(
        "no glass of this lens is from a catalogue, so none has neighbours; `glasses` 0 would be "
        "right");
  if (!(request.least_rim_mm >= 0))
    throw InputError(fmt::format("a rim of {:g} mm; 0 or more would be right", request.least_rim_mm));
}

OptimiseResult report(const Lens& lens, const OptimiseRequest& request, const Descent& best) {
  OptimiseResult result;
  const RayMerit before(lens, request), after(best.lens, request);
  const Eigen::VectorXd old_rows = *before.residuals(lens, nullptr),
                        new_rows = *after.residuals(best.lens, nullptr);
  result.before = before.merit(old_rows);
  result.after = after.merit(new_rows);
  result.fields_before = before.by_field(old_rows);
  result.fields_after = after.by_field(new_rows);
  result.efl_before_mm = efl_of(lens);
  result.efl_after_mm = efl_of(best.lens);
  for (const LensVariable& variable : request.variables)
    result.numbers.push_back(
        {variable.number, shown_value(lens, variable.number), shown_value(best.lens, variable.number)});
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
    if (const auto old = catalogue_glass(lens, i), now = catalogue_glass(best.lens, i); old != now)
      result.glasses.push_back({i, old->full_name(), now->full_name()});
  result.by_round = best.by_round;
  result.lens = best.lens;
  result.lens.name += ", optimised";
  return result;
}

OptimiseResult work(const Lens& lens, const OptimiseRequest& request, std::uint64_t seed,
                    const ProgressCallback& progress) {
  Objective::Targets targets{request.efl_mm.value_or(efl_of(lens)), {}};
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
    if (const std::optional<double> rim = glass_rim_mm(lens, i))
      targets.rims.emplace_back(i, std::min(*rim, request.least_rim_mm));
  if (request.most_distortion_percent) {
    targets.most_distortion_percent = *request.most_distortion_percent;
    targets.azimuths_deg = azimuths_of(lens, request);
    for (const double field : request.at.fields)
      if (const double object = object_field(lens, request.at.field_kind, field); object != 0)
        targets.fields.push_back(object);
  }
  const auto starts = static_cast<std::size_t>(request.starts);
  std::vector<std::optional<Descent>> descents(starts);
  std::atomic<int> rounds = 0;
  const auto round_done = [&](int) {
    if (progress)
      progress(std::min(1.0, ++rounds / static_cast<double>(request.rounds * request.starts)), "rounds");
  };
  const std::function<void()> look_up = [] { check_stop(); };
  parallel_tasks(starts, [&](std::size_t start) {
    try {
      const Lens from = start == 0 ? lens : beside(lens, request, seed, start);
      descents[start] = descend(from, request, targets, look_up, round_done);
      if (request.merit == OptimiseMerit::mtf)
        keep_better(descend_from_spots(from, request, targets, look_up), *descents[start]);
    } catch (const InputError&) {
      if (start == 0) throw;  // a start through which no light gets is one less
    }
  });
  std::size_t best = 0;
  for (std::size_t i = 1; i < starts; ++i)
    if (descents[i] && descents[i]->cost < descents[best]->cost) best = i;
  if (request.glasses > 0) choose_glasses(*descents[best], request, targets, look_up, progress);
  OptimiseResult result = report(lens, request, *descents[best]);
  result.start = static_cast<int>(best);
  return result;
}

}  // namespace

OptimiseResult optimise(const Lens& lens, const OptimiseRequest& asked, const Context& context) {
  OptimiseRequest request = asked;
  request.at = with_own_lists(request.at, lens);
  check(lens, request);
  if (request.variables.empty()) request.variables = usual_variables(lens);
  return result_within(
      context, [&](const ProgressCallback& progress) { return work(lens, request, context.seed, progress); });
}

}  // namespace petzval
