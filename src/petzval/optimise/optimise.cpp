// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_rows.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/stop.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/ray_transfer.h>
#include <petzval/numeric/random.h>
#include <petzval/optimise/glass_choice.h>
#include <petzval/optimise/lens_objective.h>
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
/// A round that improves less than by this share is the last. Steps of one round at most.
constexpr double worth_a_round = 1e-4;
constexpr int most_steps = 25, most_rounds = 1000, most_starts = 1000, most_glasses = 100;
/// A glass that improves the squares by less than this share is not worth a change. Rounds by which a glass
/// is judged.
constexpr double worth_a_glass = 1e-3;
constexpr int rounds_for_glass = 5;
/// A lens on its way.
struct Descent {
  Lens lens;
  double cost = 0;
  std::vector<double> by_round;
};

double merit_of(const LensObjective& objective, const Lens& lens) {
  const auto residuals = objective.rays().residuals(lens, nullptr);
  return residuals ? objective.rays().merit(*residuals) : lost_ray;
}

Descent descend(Lens lens, const OptimiseRequest& request, const LensObjective::Targets& targets,
                const std::function<void()>& check_stop, const std::function<void(int)>& round_done) {
  const VariableMapping mapping(lens, request.variables);
  Descent descent{std::move(lens), 0, {}};
  std::optional<LensObjective> objective(std::in_place, descent.lens, request, mapping, targets, check_stop);
  descent.cost = objective->start_cost();
  descent.by_round.push_back(merit_of(*objective, descent.lens));
  for (int round = 0; round < request.rounds; ++round) {
    Eigen::VectorXd x = mapping.at(descent.lens);
    Eigen::LevenbergMarquardt<LensObjective> search(*objective);
    search.setMaxfev(most_steps);
    search.minimize(x);
    round_done(round + 1);
    try {
      Lens next = mapping.lens_at(descent.lens, x);
      LensObjective fresh(next, request, mapping, targets, check_stop);
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
                                          const LensObjective::Targets& targets,
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
void choose_glasses(Descent& best, const OptimiseRequest& request, const LensObjective::Targets& targets,
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
  const VariableMapping mapping(lens, request.variables);
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
  LensObjective::Targets targets{request.efl_mm.value_or(efl_of(lens)), {}};
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
