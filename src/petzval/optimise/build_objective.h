// SPDX-License-Identifier: BSD-3-Clause
// What a fit of a build makes small: the edges' contrast against the model's, in standard deviations.
#pragma once

#include <petzval/optimise/edge_transfer.h>
#include <petzval/optimise/fit_build.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// An edge as the fit takes it up.
struct EdgeData {
  int photograph = 0;
  const MapEdge* edge = nullptr;
  SensorEdge at;
  std::vector<double> frequencies_cpmm;
  Eigen::VectorXd contrast, photosite;
  Eigen::MatrixXd whitening;  ///< makes of differences of contrast numbers of variance 1
};

/// Numbers of a lens against edges of photographs. Numbers are in steps of BuildNumber::scale().
class BuildObjective {
 public:
  /// \throws InputError as fit_build().
  BuildObjective(const Lens& lens, const std::vector<SfrMap>& photographs, const FitBuildRequest& request);

  const std::vector<BuildNumber>& numbers() const { return numbers_; }
  const std::vector<EdgeData>& edges() const { return edges_; }
  Eigen::Index unknowns() const { return static_cast<Eigen::Index>(numbers_.size()); }
  /// Of contrast, and of all residuals, those of expected deviations counted.
  Eigen::Index data() const { return data_; }
  Eigen::Index rows() const { return data_ + priors_; }
  const EdgeDetail& detail() const { return detail_; }
  void look(const EdgeDetail& detail);
  /// From here on residuals know that errors of all edges together are likely; far from the truth they are
  /// better not counted, as minima are less deep then.
  void count_shared_errors();

  /// The lens with its numbers, the sensor where a photograph had it.
  Lens lens_at(const Eigen::VectorXd& steps, int photograph) const;
  /// Residuals, and their slopes if asked for.
  void evaluate(const Eigen::VectorXd& steps, Eigen::VectorXd& residuals, Eigen::MatrixXd* slopes) const;
  /// MTF50 that the lens with these numbers gives every edge [cycles/pixel]; NaN above 1.
  std::vector<double> mtf50(const Eigen::VectorXd& steps) const;

 private:
  void take_numbers(const std::vector<std::string>& free, std::size_t photographs);
  void take_edges(const std::vector<SfrMap>& photographs, const FitBuildRequest& request);
  void find_objects();
  double shift_mm(int photograph) const;

  Lens lens_;
  std::vector<BuildNumber> numbers_;
  std::vector<double> focus_shifts_mm_;
  EdgeLight light_;
  double pitch_mm_;
  Photosite photosite_;
  std::vector<EdgeData> edges_;
  std::vector<Eigen::Index> first_row_;
  Eigen::Index data_ = 0, priors_ = 0;
  /// Once counted: directions among whitened differences of contrast that errors of all edges together take,
  /// orthonormal, and by how much they are shortened so that variances are 1 there too.
  Eigen::MatrixXd shared_directions_;
  Eigen::VectorXd shortened_by_;
  EdgeDetail detail_ = EdgeDetail::quick();
  std::vector<EdgeObjects> objects_;  ///< of the lens as given
};

}  // namespace petzval
