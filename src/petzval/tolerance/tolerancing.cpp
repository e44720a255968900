// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/numeric/random.h>
#include <petzval/tolerance/build_record.h>
#include <petzval/tolerance/tolerancing.h>
#include <petzval/tolerance/yield.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

namespace petzval {

namespace {

/// The purpose of the random numbers.
constexpr std::uint32_t build_errors = 0x70b5;
/// Standard deviation over limit of normal errors.
constexpr double deviation_per_limit = 0.5;
/// Inverse limits are sought up to so many times the limit, to this share of them.
constexpr double widest_inverse = 20, inverse_tolerance = 1e-3;
constexpr int most_builds = 1'000'000;

struct Direction {
  double x, y;
};

std::vector<Direction> directions_of(const Tolerance& tolerance) {
  if (find_tolerance_kind(tolerance.kind)->has_direction) return {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  return {{1, 0}, {-1, 0}};
}

/// Within the unit disc, or in [−1, 1].
Direction draw(RandomStream& random, bool has_direction, ErrorDistribution distribution) {
  for (;;) {
    Direction at{0, 0};
    switch (distribution) {
      case ErrorDistribution::normal:
        at = {deviation_per_limit * random.normal(),
              has_direction ? deviation_per_limit * random.normal() : 0};
        break;
      case ErrorDistribution::uniform:
        at = {2 * random.uniform() - 1, has_direction ? 2 * random.uniform() - 1 : 0};
        break;
      case ErrorDistribution::at_limit: {
        const double turn = has_direction ? 2 * pi * random.uniform() : random.uniform() < 0.5 ? 0 : pi;
        return {std::cos(turn), has_direction ? std::sin(turn) : 0};
      }
    }
    if (std::hypot(at.x, at.y) <= 1) return at;
  }
}

/// How much worse than the design: positive is harm.
double harm(const Merit& merit, double designed, double built) {
  return merit.more_is_better() ? designed - built : built - designed;
}

Sensitivity sensitivity(const Lens& lens, const Tolerance& tolerance, const JudgeRequest& request,
                        double designed) {
  Sensitivity result{tolerance, 0, 0, 0, {}};
  const std::vector<Direction> directions = directions_of(tolerance);
  std::vector<double> changes;
  for (const auto& [x, y] : directions) {
    const Lens off = with_error(lens, tolerance, x * tolerance.limit, y * tolerance.limit);
    changes.push_back(judge(off, request).overall - designed);
  }
  const auto [low, high] = std::ranges::minmax(changes);
  const bool more = request.merit.more_is_better();
  result.best_change = more ? high : low;
  result.worst_change = more ? low : high;
  for (const double change : changes) result.mean_change += change / static_cast<double>(changes.size());
  return result;
}

/// The limit at which the worst direction does so much harm: bisection on the logarithm, since harm grows
/// with the limit.
std::optional<double> inverse_limit(const Lens& lens, const Tolerance& tolerance, const JudgeRequest& request,
                                    double designed, double change) {
  const auto harm_at = [&](double limit) {
    double worst = 0;
    for (const auto& [x, y] : directions_of(tolerance)) {
      const Lens off = with_error(lens, tolerance, x * limit, y * limit);
      worst = std::max(worst, harm(request.merit, designed, judge(off, request).overall));
    }
    return worst;
  };
  double low = tolerance.limit / widest_inverse, high = tolerance.limit * widest_inverse;
  if (harm_at(high) < change) return {};
  while (harm_at(low) >= change && low > 1e-9 * tolerance.limit) high = low, low /= widest_inverse;
  while (high / low > 1 + inverse_tolerance) {
    const double middle = std::sqrt(low * high);
    (harm_at(middle) < change ? low : high) = middle;
  }
  return low;
}

void check(const ToleranceRequest& request) {
  const Merit& merit = request.judge.merit;
  if (request.builds < 0 || request.builds > most_builds)
    throw InputError(fmt::format("{} builds; 0 to {} would be right", request.builds, most_builds));
  if (merit.kind == Merit::Kind::mtf && !(merit.frequency_cpmm > 0 && std::isfinite(merit.frequency_cpmm)))
    throw InputError(
        fmt::format("an MTF at {:g} cycles/mm; a positive frequency would be right", merit.frequency_cpmm));
  if (request.accept && !(*request.accept > 0 && std::isfinite(*request.accept)))
    throw InputError(
        fmt::format("`accept` {:g}; a positive {} would be right", *request.accept, merit.name()));
  if (request.inverse_change && !(*request.inverse_change > 0 && std::isfinite(*request.inverse_change)))
    throw InputError(fmt::format("`inverse` {:g}; a positive change of the {} would be right",
                                 *request.inverse_change, merit.name()));
}

/// Tells how far all the work is.
class Counter {
 public:
  Counter(const ProgressCallback& progress, std::size_t all) : progress_(progress), all_(all) {}
  void one_done(const char* what) {
    const std::size_t done = ++done_;
    if (progress_) progress_(static_cast<double>(done) / static_cast<double>(all_), what);
  }

 private:
  const ProgressCallback& progress_;
  std::size_t all_;
  std::atomic<std::size_t> done_ = 0;
};

ToleranceReport work(const Lens& lens, const ToleranceRequest& request, std::uint64_t seed,
                     const ProgressCallback& progress) {
  ToleranceReport report;
  report.tolerances = tolerances_of(lens, request);
  report.points = points_of(lens, request.judge);
  std::optional<BuildRecord> record;
  if (!request.record.empty()) record.emplace(request.record, lens, request, seed);
  report.designed = judge(lens, request.judge);
  const double designed = report.designed.overall;
  const std::size_t kinds = request.sensitivities ? report.tolerances.size() : 0;
  const auto builds = static_cast<std::size_t>(request.builds);
  Counter counter(progress, kinds + builds);

  report.sensitivities.resize(kinds);
  parallel_tasks(kinds, [&](std::size_t i) {
    Sensitivity& row = report.sensitivities[i];
    row = sensitivity(lens, report.tolerances[i], request.judge, designed);
    if (request.inverse_change)
      row.inverse_limit =
          inverse_limit(lens, report.tolerances[i], request.judge, designed, *request.inverse_change);
    counter.one_done("sensitivities");
  });
  double squares = 0;
  for (const Sensitivity& row : report.sensitivities) {
    report.expected_change += row.mean_change;
    squares += std::pow(0.5 * (row.worst_change - row.best_change), 2);
  }
  report.rss_change = std::sqrt(squares);
  const Merit& merit = request.judge.merit;
  std::ranges::stable_sort(report.sensitivities, [&](const Sensitivity& a, const Sensitivity& b) {
    return harm(merit, 0, a.worst_change) > harm(merit, 0, b.worst_change);
  });

  report.builds.resize(builds);
  parallel_tasks(builds, [&](std::size_t i) {
    Build build = draw_build(report.tolerances, request.distribution, seed, i);
    if (const Judgement* known = record ? record->find(i) : nullptr) {
      build.judgement = *known;
    } else {
      build.judgement = judge(built_lens(lens, report.tolerances, build), request.judge);
      if (record) record->add(i, build.judgement);
    }
    report.builds[i] = std::move(build);
    counter.one_done("builds");
  });
  if (request.accept && builds > 0) {
    const auto good = std::ranges::count_if(report.builds, [&](const Build& build) {
      return harm(merit, *request.accept, build.judgement.worst) <= 0;
    });
    const Yield yield = yield_of(static_cast<std::size_t>(good), builds);
    report.yield = yield.share, report.yield_low = yield.low, report.yield_high = yield.high;
  }
  return report;
}

}  // namespace

Build draw_build(const std::vector<Tolerance>& tolerances, ErrorDistribution distribution, std::uint64_t seed,
                 std::size_t index) {
  RandomStream random(seed, build_errors, index);
  Build build;
  for (const Tolerance& tolerance : tolerances) {
    const auto [x, y] = draw(random, find_tolerance_kind(tolerance.kind)->has_direction, distribution);
    build.errors_x.push_back(x * tolerance.limit);
    build.errors_y.push_back(y * tolerance.limit);
  }
  return build;
}

Lens built_lens(const Lens& lens, const std::vector<Tolerance>& tolerances, const Build& build) {
  Lens built = lens;
  for (std::size_t i = 0; i < tolerances.size(); ++i)
    built = with_error(std::move(built), tolerances[i], build.errors_x.at(i), build.errors_y.at(i));
  return built;
}

std::vector<Tolerance> tolerances_of(const Lens& lens, const ToleranceRequest& request) {
  const std::vector<Tolerance>& own = request.tolerances.empty() ? lens.tolerances : request.tolerances;
  const std::vector<Tolerance> tolerances = own.empty() ? graded_tolerances(lens, request.grade) : own;
  if (tolerances.empty()) throw InputError(lens.name + " has nothing to which a tolerance applies");
  for (const Tolerance& tolerance : tolerances) check(lens, tolerance);
  return tolerances;
}

Lens build_off_the_line(const Lens& lens, const ToleranceRequest& request, std::uint64_t seed,
                        std::size_t index) {
  lens.validate();
  const std::vector<Tolerance> tolerances = tolerances_of(lens, request);
  Lens built = built_lens(lens, tolerances, draw_build(tolerances, request.distribution, seed, index));
  JudgeRequest spots = request.judge;
  spots.merit = {};
  built.set_image_distance_mm(built.image_distance_mm() + judge(built, spots).refocus_mm);
  built.name += fmt::format(", build {}", index);
  built.tolerances.clear();
  return built;
}

ToleranceReport tolerance_lens(const Lens& lens, const ToleranceRequest& request, const Context& context) {
  lens.validate();
  check(request);
  return result_within(
      context, [&](const ProgressCallback& progress) { return work(lens, request, context.seed, progress); });
}

}  // namespace petzval
