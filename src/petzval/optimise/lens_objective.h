// SPDX-License-Identifier: BSD-3-Clause
// What an optimisation makes small, as a function of numbers that run without limits.
#pragma once

#include <petzval/optimise/lens_variable.h>
#include <petzval/optimise/optimise.h>
#include <petzval/optimise/ray_merit.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <unsupported/Eigen/LevenbergMarquardt>
#include <utility>
#include <vector>

namespace petzval {

/// Stands for a lens through which a ray does not get: no step leads there.
inline constexpr double lost_ray = 1e6;

double efl_of(const Lens& lens);

/// How thick the glass behind a surface is at the clear aperture [mm]; nothing for air or without a rim.
std::optional<double> glass_rim_mm(const Lens& lens, std::size_t surface);

/// Numbers that run without limits, mapped into those of the variables.
class VariableMapping {
 public:
  VariableMapping(const Lens& lens, const std::vector<LensVariable>& variables);

  Lens lens_at(Lens lens, const Eigen::VectorXd& x) const;
  Eigen::VectorXd at(const Lens& lens) const;
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

  const std::vector<LensVariable>& variables_;
  std::vector<double> scales_;
};

/// Everything that is made small in one round.
class LensObjective : public Eigen::DenseFunctor<double> {
 public:
  struct Targets {
    double efl_mm;
    std::vector<std::pair<std::size_t, double>> rims;  ///< surface, and how thick its glass is to stay
    std::vector<double> fields = {};                   ///< object fields at which distortion counts
    double most_distortion_percent = 0;
    std::vector<double> azimuths_deg = {};  ///< of these fields

    std::size_t count() const { return 1 + rims.size() + fields.size(); }
  };

  LensObjective(const Lens& lens, const OptimiseRequest& request, const VariableMapping& mapping,
                const Targets& targets, const std::function<void()>& check_stop)
      : LensObjective(RayMerit(lens, request), lens, request, mapping, targets, check_stop) {}

  int operator()(const InputType& x, ValueType& values) const {
    evaluate(mapping_.lens_at(lens_, x), values, nullptr);
    return 0;
  }
  int df(const InputType& x, JacobianType& slopes) const;

  const RayMerit& rays() const { return rays_; }
  /// Of the lens that this round began with.
  double start_cost() const {
    ValueType values(this->values());
    evaluate(lens_, values, nullptr);
    return values.squaredNorm();
  }

 private:
  LensObjective(RayMerit rays, const Lens& lens, const OptimiseRequest& request,
                const VariableMapping& mapping, const Targets& targets,
                const std::function<void()>& check_stop);

  /// Focal length, rims, distortion.
  Eigen::VectorXd others(const Lens& lens) const;

  void evaluate(const Lens& lens, ValueType& values, JacobianType* slopes) const;

  RayMerit rays_;
  Lens lens_;
  const VariableMapping& mapping_;
  const Targets& targets_;
  const std::function<void()>& check_stop_;
  double cost_;
};

}  // namespace petzval
