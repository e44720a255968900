// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/stop.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/ray_transfer.h>
#include <petzval/optimise/build_objective.h>
#include <petzval/optimise/fit_build.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/LevenbergMarquardt>

namespace petzval {

namespace {

constexpr int first_evaluations = 4, quick_evaluations = 12, fine_evaluations = 25;
/// Descents end where chi² or steps change by less than these shares: hundreds of times less than deviations.
constexpr double enough_of_chi_squared = 1e-6, enough_of_steps = 1e-4;
/// So many of the builds that the first steps lead to are followed further.
constexpr std::size_t followed = 2;
/// The sensor is sought so many depths of focus, λN², on both sides.
constexpr int depths_sought = 12;
/// Two builds are one if no number differs by more than so many of its deviations.
constexpr double same_build = 1;
/// Of chi², scaled: what fits within two standard deviations.
constexpr double as_good = 4;
/// Correlations beyond it are named; eigenvalues of the normal matrix, scaled to a diagonal of 1, below it
/// mean that nothing is known.
constexpr double hardly_apart = 0.95, nothing_known = 1e-9;

/// As Eigen's Levenberg and Marquardt ask.
class Functor : public Eigen::DenseFunctor<double> {
 public:
  explicit Functor(const BuildObjective& of)
      : DenseFunctor(static_cast<int>(of.unknowns()), static_cast<int>(of.rows())), of_(of) {}
  int operator()(const InputType& x, ValueType& values) const {
    Eigen::VectorXd residuals;
    of_.evaluate(x, residuals, nullptr);
    values = residuals;
    return 0;
  }
  int df(const InputType& x, JacobianType& slopes) const {
    Eigen::VectorXd residuals;
    Eigen::MatrixXd of_residuals;
    of_.evaluate(x, residuals, &of_residuals);
    slopes = of_residuals;
    return 0;
  }

 private:
  const BuildObjective& of_;
};

struct Candidate {
  Eigen::VectorXd steps;
  double chi_squared = HUGE_VAL;
};

double chi_squared(const BuildObjective& of, const Eigen::VectorXd& steps) {
  Eigen::VectorXd residuals;
  of.evaluate(steps, residuals, nullptr);
  return residuals.squaredNorm();
}

Candidate descend_from(const BuildObjective& of, Eigen::VectorXd steps, int evaluations) {
  Functor functor(of);
  Eigen::LevenbergMarquardt<Functor> search(functor);
  search.setMaxfev(evaluations);
  search.setFtol(enough_of_chi_squared), search.setXtol(enough_of_steps), search.setFactor(1);
  search.minimize(steps);
  return {steps, chi_squared(of, steps)};
}

bool is_defocus(const BuildNumber& number) {
  return number.kind == BuildNumber::Kind::defocus_mm;
}

/// λN² [mm]: the Rayleigh depth of focus is four of them, end to end.
double depth_mm(const Lens& lens) {
  const FirstOrder data = first_order(lens);
  const double n = std::isfinite(data.working_f_number) ? data.working_f_number : 5;
  return lens.reference_wavelength_nm * mm_per_nm * n * n;
}

/// Where the sensor may have stood, all else as designed: the two best minima of a scan, one if there is one.
std::vector<Eigen::VectorXd> sensors_to_start_at(const BuildObjective& of, const Lens& lens) {
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(of.unknowns());
  for (Eigen::Index k = 0; k < of.unknowns(); ++k)
    if (const BuildNumber& number = of.numbers()[static_cast<std::size_t>(k)]; is_defocus(number))
      direction[k] = 1.5 * depth_mm(lens) / number.scale();
  if (direction.isZero()) return {direction};
  std::vector<double> costs;
  for (int i = -depths_sought; i <= depths_sought; ++i) costs.push_back(chi_squared(of, i * direction));
  std::vector<std::pair<double, int>> minima;
  for (int i = 0; i < static_cast<int>(costs.size()); ++i) {
    const auto at = [&](int k) {
      return k < 0 || k >= static_cast<int>(costs.size()) ? HUGE_VAL : costs[static_cast<std::size_t>(k)];
    };
    if (at(i) <= at(i - 1) && at(i) <= at(i + 1)) minima.emplace_back(at(i), i - depths_sought);
  }
  std::ranges::sort(minima);
  std::vector<Eigen::VectorXd> starts;
  for (const auto& [cost, i] : minima)
    if (starts.size() < 2) starts.push_back(i * direction);
  return starts;
}

/// Pairs of numbers that are one thing's x and y, and numbers of their own.
std::vector<std::vector<Eigen::Index>> things_of(const BuildObjective& of) {
  std::vector<std::vector<Eigen::Index>> things;
  for (Eigen::Index k = 0; k < of.unknowns(); ++k) {
    if (of.numbers()[static_cast<std::size_t>(k)].axis == 'y')
      things.back().push_back(k);
    else
      things.push_back({k});
  }
  return things;
}

/// Beside each place of the sensor the first thing with a direction off by both signs in x and in y: where a
/// lens stands in its best focus, slopes with a tilt are zero.
std::vector<Eigen::VectorXd> starts_of(const BuildObjective& of, const Lens& lens) {
  std::vector<Eigen::VectorXd> starts;
  const auto things = things_of(of);
  const auto pair = std::ranges::find_if(things, [](const auto& thing) { return thing.size() == 2; });
  for (const Eigen::VectorXd& sensor : sensors_to_start_at(of, lens)) {
    if (pair == things.end()) {
      starts.push_back(sensor);
      continue;
    }
    for (const double x : {-1.0, 1.0})
      for (const double y : {-1.0, 1.0}) {
        starts.push_back(sensor);
        starts.back()[(*pair)[0]] += x, starts.back()[(*pair)[1]] += y;
      }
  }
  return starts;
}

/// What is reached from each start, best first.
std::vector<Candidate> descend_from_all(const BuildObjective& of, const std::vector<Eigen::VectorXd>& starts,
                                        int evaluations, const std::function<void()>& done) {
  std::vector<Candidate> reached;
  for (const Eigen::VectorXd& start : starts) {
    reached.push_back(descend_from(of, start, evaluations));
    done();
  }
  std::ranges::stable_sort(reached, {}, &Candidate::chi_squared);
  return reached;
}

/// The build turned round: every thing for itself, and all of them.
std::vector<Eigen::VectorXd> turned_round(const BuildObjective& of, const Eigen::VectorXd& steps) {
  std::vector<Eigen::VectorXd> starts{-steps};
  const auto things = things_of(of);
  for (const auto& thing : things) {
    if (things.size() == 1 || is_defocus(of.numbers()[static_cast<std::size_t>(thing[0])])) continue;
    Eigen::VectorXd turned = steps;
    for (const Eigen::Index k : thing) turned[k] = -turned[k];
    starts.push_back(turned);
    for (const Eigen::Index k : thing) {
      if (thing.size() < 2) break;
      Eigen::VectorXd half = steps;
      half[k] = -half[k];
      starts.push_back(half);
    }
  }
  return starts;
}

struct Covariance {
  Eigen::MatrixXd of_steps;
  double scaled_by = 1;
};

Covariance covariance_at(const BuildObjective& of, const Candidate& best) {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd slopes;
  of.evaluate(best.steps, residuals, &slopes);
  const Eigen::MatrixXd normal = slopes.transpose() * slopes;
  const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt();
  for (Eigen::Index k = 0; k < scale.size(); ++k)
    if (!(scale[k] > 0))
      throw InputError(fmt::format("the edges say nothing of {}; fewer free numbers would be right",
                                   of.numbers()[static_cast<std::size_t>(k)].name()));
  const Eigen::VectorXd per_scale = scale.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(
      Eigen::MatrixXd(per_scale.asDiagonal() * normal * per_scale.asDiagonal()));
  if (!(solved.eigenvalues()[0] > nothing_known)) {
    Eigen::Index most = 0;
    solved.eigenvectors().col(0).cwiseAbs().maxCoeff(&most);
    throw InputError(fmt::format(
        "{} cannot be told from the other free numbers; without it, or with its =LIMIT, would be right",
        of.numbers()[static_cast<std::size_t>(most)].name()));
  }
  const Eigen::MatrixXd inverse = solved.eigenvectors() * solved.eigenvalues().cwiseInverse().asDiagonal() *
                                  solved.eigenvectors().transpose();
  Covariance covariance{per_scale.asDiagonal() * inverse * per_scale.asDiagonal()};
  const double freedom = static_cast<double>(of.rows() - of.unknowns());
  covariance.scaled_by = std::sqrt(std::max(1.0, best.chi_squared / freedom));
  covariance.of_steps *= covariance.scaled_by * covariance.scaled_by;
  return covariance;
}

double value_in_unit(const BuildObjective& of, const Eigen::VectorXd& steps, Eigen::Index k) {
  return steps[k] * of.numbers()[static_cast<std::size_t>(k)].scale();
}

std::string shown_number(const BuildNumber& number, double value) {
  constexpr double minutes = 60;
  if (number.unit() == "deg") return fmt::format("{} {:+.2f} arcmin", number.name(), minutes * value);
  return fmt::format("{} {:+.4g} {}", number.name(), value, number.unit());
}

void name_correlated(FitBuildResult& result) {
  const std::size_t n = result.numbers.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (const double r = result.correlation[i * n + k]; std::abs(r) > hardly_apart)
        result.remarks.push_back(
            fmt::format("{} and {} are hardly told apart (correlation {:+.3f}): the one is well known only "
                        "if the other is",
                        result.numbers[k].number.name(), result.numbers[i].number.name(), r));
}

void name_others(FitBuildResult& result, std::size_t photographs, bool shifts_known) {
  for (const OtherBuild& other : result.others) {
    std::string differs;
    bool signs = false;
    for (std::size_t k = 0; k < result.numbers.size(); ++k) {
      const FittedNumber& number = result.numbers[k];
      if (std::abs(other.values[k] - number.value) < 2 * number.deviation) continue;
      differs += (differs.empty() ? "" : ", ") + shown_number(number.number, other.values[k]);
      signs = signs || other.values[k] * number.value < 0;
    }
    const char* remedy = photographs == 1 ? "a photograph at a second focus setting tells"
                         : !shifts_known  ? "how far apart the focus settings are, `focus_shifts_mm`, tells"
                                          : "sharper photographs may tell";
    result.remarks.push_back(fmt::format("{} as well (chi2 {:.1f}): {}; {}",
                                         signs ? "the sign is not told: this fits" : "another build fits",
                                         other.chi_squared, differs, remedy));
  }
}

bool is_same(const Eigen::VectorXd& a, const Eigen::VectorXd& b, const Covariance& covariance) {
  const Eigen::VectorXd deviations = covariance.of_steps.diagonal().cwiseSqrt();
  return ((a - b).cwiseAbs().array() <= same_build * deviations.array()).all();
}

void take_numbers_of(const BuildObjective& of, const Candidate& best, const Covariance& covariance,
                     FitBuildResult& result) {
  const Eigen::VectorXd deviations = covariance.of_steps.diagonal().cwiseSqrt();
  for (Eigen::Index k = 0; k < of.unknowns(); ++k) {
    const BuildNumber& number = of.numbers()[static_cast<std::size_t>(k)];
    result.numbers.push_back({number, value_in_unit(of, best.steps, k), deviations[k] * number.scale()});
    for (Eigen::Index j = 0; j < of.unknowns(); ++j)
      result.correlation.push_back(covariance.of_steps(k, j) / (deviations[k] * deviations[j]));
  }
  result.scaled_by = covariance.scaled_by;
  result.chi_squared = best.chi_squared;
  result.freedom = static_cast<int>(of.rows() - of.unknowns());
}

void take_others(const BuildObjective& of, const Candidate& best, const std::vector<Candidate>& reached,
                 const Covariance& covariance, FitBuildResult& result) {
  const double far = as_good * covariance.scaled_by * covariance.scaled_by;
  std::vector<Eigen::VectorXd> taken{best.steps};
  for (const Candidate& each : reached) {
    if (each.chi_squared > best.chi_squared + far) continue;
    if (std::ranges::any_of(taken, [&](const auto& one) { return is_same(one, each.steps, covariance); }))
      continue;
    taken.push_back(each.steps);
    OtherBuild other{{}, each.chi_squared};
    for (Eigen::Index k = 0; k < of.unknowns(); ++k) other.values.push_back(value_in_unit(of, each.steps, k));
    result.others.push_back(std::move(other));
  }
}

void take_fitted_edges(const BuildObjective& of, const Eigen::VectorXd& steps, FitBuildResult& result) {
  const std::vector<double> before = of.mtf50(Eigen::VectorXd::Zero(of.unknowns())), after = of.mtf50(steps);
  for (std::size_t i = 0; i < of.edges().size(); ++i) {
    const EdgeData& data = of.edges()[i];
    result.edges.push_back({data.photograph, data.edge->x_px, data.edge->y_px, degrees(data.edge->normal_rad),
                            data.edge->mtf50_cpp, before[i], after[i]});
  }
}

FitBuildResult fit(const Lens& lens, const std::vector<SfrMap>& photographs, const FitBuildRequest& request,
                   const ProgressCallback& progress) {
  BuildObjective of(lens, photographs, request);
  const std::vector<Eigen::VectorXd> starts = starts_of(of, lens);
  const double descents = static_cast<double>(starts.size() + 3 * things_of(of).size() + 2);
  double done = 0;
  const auto next = [&] {
    if (progress) progress(std::min(1.0, ++done / descents), "builds");
  };
  std::vector<Candidate> reached = descend_from_all(of, starts, first_evaluations, next);
  for (std::size_t i = 0; i < std::min(followed, reached.size()); ++i)
    reached[i] = descend_from(of, reached[i].steps, quick_evaluations);
  std::ranges::stable_sort(reached, {}, &Candidate::chi_squared);
  for (Candidate& other :
       descend_from_all(of, turned_round(of, reached.front().steps), quick_evaluations, next))
    reached.push_back(std::move(other));
  std::ranges::stable_sort(reached, {}, &Candidate::chi_squared);
  // Looked at more finely: the best, and what comes near it.
  const double near = reached.front().chi_squared * 1.1 + 10 * as_good;
  of.look({});
  of.count_shared_errors();
  std::vector<Candidate> fine;
  for (const Candidate& each : reached) {
    if (each.chi_squared > near || fine.size() == 4) break;
    const bool known = std::ranges::any_of(
        fine, [&](const Candidate& one) { return is_same(one.steps, each.steps, covariance_at(of, one)); });
    if (!known) fine.push_back(descend_from(of, each.steps, fine_evaluations));
    next();
  }
  std::ranges::stable_sort(fine, {}, &Candidate::chi_squared);
  const Candidate& best = fine.front();
  const Covariance covariance = covariance_at(of, best);
  FitBuildResult result;
  take_numbers_of(of, best, covariance, result);
  take_others(of, best, fine, covariance, result);
  name_others(result, photographs.size(), !request.focus_shifts_mm.empty());
  name_correlated(result);
  result.chi_squared_before = chi_squared(of, Eigen::VectorXd::Zero(of.unknowns()));
  take_fitted_edges(of, best.steps, result);
  result.lens = of.lens_at(best.steps, 0);
  result.lens.name += ", as built";
  return result;
}

}  // namespace

FitBuildResult fit_build(const Lens& lens, const std::vector<SfrMap>& photographs,
                         const FitBuildRequest& request, const Context& context) {
  return result_within(
      context, [&](const ProgressCallback& progress) { return fit(lens, photographs, request, progress); });
}

}  // namespace petzval
