// SPDX-License-Identifier: BSD-3-Clause
// What tolerances do to a lens: which of them matter, and what comes off the line.
#pragma once

#include <petzval/base/context.h>
#include <petzval/lens/lens.h>
#include <petzval/tolerance/build_merit.h>

#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// How errors lie within their limits. Those with a direction are drawn in the disc of radius `limit`.
enum class ErrorDistribution {
  normal,   ///< of standard deviation limit/2, cut off at the limit
  uniform,  ///< alike everywhere within the limit
  at_limit  ///< at the limit, either side or any direction: the worst that a maker delivers
};

struct ToleranceRequest {
  std::vector<Tolerance> tolerances = {};  ///< none: the lens's own, else those of `grade`
  std::string grade = "precision";
  JudgeRequest judge = {};
  int builds = 200;  ///< 0: sensitivities alone
  ErrorDistribution distribution = ErrorDistribution::normal;
  /// What the worst point of a build must keep for it to count as good: at least of MTF, at most of spots.
  std::optional<double> accept = {};
  bool sensitivities = true;
  /// A file that keeps every build as it is finished, and from which the same request goes on; empty: none.
  /// More builds may be asked for then, or fewer.
  std::string record = {};
  /// Also the limit at which each tolerance alone costs so much of the overall merit; absent: not sought.
  std::optional<double> inverse_change = {};
};

/// One tolerance at its limit, the rest of the lens as designed.
struct Sensitivity {
  Tolerance tolerance;
  double best_change = 0, worst_change = 0;  ///< of the overall merit, over both signs or four directions
  double mean_change = 0;                    ///< of those, what a random sign or direction gives
  std::optional<double> inverse_limit = {};  ///< nothing: the change is not reached at 20 times the limit
};

/// One lens off the line.
struct Build {
  std::vector<double> errors_x, errors_y;  ///< one a tolerance, in its unit; y is 0 without a direction
  Judgement judgement;
};

struct ToleranceReport {
  std::vector<Tolerance> tolerances;
  std::vector<FieldPoint> points;
  Judgement designed;
  std::vector<Sensitivity> sensitivities;  ///< those that do most harm first
  /// By the sensitivities alone: the mean change summed, and the half-differences in quadrature. Errors at
  /// their limits; it leaves out what two errors do together.
  double expected_change = 0, rss_change = 0;
  std::vector<Build> builds;
  double yield = 0, yield_low = 0, yield_high = 0;  ///< share that is good, and its 95 % interval
};

/// The lens with the errors of one build. The same seed and number give the same lens whatever else is built.
Lens built_lens(const Lens& lens, const std::vector<Tolerance>& tolerances, const Build& build);
/// Draws the errors of build number `index`.
Build draw_build(const std::vector<Tolerance>& tolerances, ErrorDistribution distribution, std::uint64_t seed,
                 std::size_t index);

/// Build number `index` of a lens as it leaves the line: with its errors, and its sensor focused as judge()
/// does (unless `request.judge` leaves it). What tolerance_lens() judges under that number, as a lens of its
/// own. \throws InputError as tolerance_lens().
Lens build_off_the_line(const Lens& lens, const ToleranceRequest& request, std::uint64_t seed,
                        std::size_t index);

/// The tolerances that a request stands for on a lens. \throws InputError as check() and graded_tolerances().
std::vector<Tolerance> tolerances_of(const Lens& lens, const ToleranceRequest& request);

/// Sensitivities by real rays through the altered lens, refocused as every build is; Monte Carlo over
/// `builds` lenses, whose errors depend on context.seed and their number alone. The interval of the yield is
/// Clopper and Pearson's. \throws InputError for tolerances that do not fit the lens, for a `record` of other
/// builds, and as judge(); Failure where it cannot be written; Cancelled.
ToleranceReport tolerance_lens(const Lens& lens, const ToleranceRequest& request = {},
                               const Context& context = {});

}  // namespace petzval
