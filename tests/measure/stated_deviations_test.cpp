// SPDX-License-Identifier: BSD-3-Clause
// Deviations of edges that hide in their noise what corners add, and show it together.
#include <gtest/gtest.h>
#include <petzval/measure/sfr/stated_deviations.h>

#include <cmath>
#include <random>
#include <vector>

namespace petzval {
namespace {

/// Edges as measured at one frequency: noise of `of_samples` in the SFR, and twice that in the comparison of
/// profiles, which shows `per_corner` times a number between 1 and 2 of each edge.
struct DrawnEdges {
  std::vector<EdgeMeasurement> edges;
  std::vector<double> errors;

  void add(int count, double rise_px, double per_corner, std::mt19937& random) {
    constexpr double of_samples = 1e-3, of_comparison = 2e-3, variance = of_comparison * of_comparison;
    std::normal_distribution<double> normal(0, 1);
    std::uniform_real_distribution<double> corners(1, 2);
    for (int i = 0; i < count; ++i) {
      EdgeMeasurement& edge = edges.emplace_back();
      edge.rise_px = rise_px;
      edge.frequencies_cpp = {0.25};
      edge.parts.corners = corners(random);
      const double added = per_corner * edge.parts.corners;
      edge.parts.of_samples = {of_samples};
      edge.parts.model_square = {std::pow(added + of_comparison * normal(random), 2) - variance};
      edge.parts.square_variance = {2 * variance * variance};
      errors.push_back(added + of_samples * normal(random));
    }
  }
  /// Of the edges from `first` on, as the ruler promises it.
  void expect_errors_as_stated(std::size_t first = 0) const {
    EXPECT_GT(over_stated(first), 0.8);
    EXPECT_LT(over_stated(first), 1.25);
  }
  /// Root mean square of the errors over what is stated of the edges from `first` on.
  double over_stated(std::size_t first = 0) const {
    double sum = 0;
    for (std::size_t i = first; i < edges.size(); ++i)
      sum += std::pow(errors[i] / edges[i].sfr_deviation[0], 2);
    return std::sqrt(sum / static_cast<double>(edges.size() - first));
  }
  void state_together() {
    std::vector<EdgeMeasurement*> all;
    for (EdgeMeasurement& edge : edges) all.push_back(&edge);
    state_deviations(all);
  }
  void state_alone() {
    for (EdgeMeasurement& edge : edges) {
      EdgeMeasurement* const alone = &edge;
      state_deviations({&alone, 1});
    }
  }
};

// Four hundred draws know a root mean square to 4 %, and the mean square of the comparisons to 15 %.
TEST(StatedDeviations, HoldTogetherWhatEachEdgeHides) {
  std::mt19937 random(1);
  DrawnEdges drawn;
  drawn.add(400, 2.5, 1.5e-3, random);
  drawn.state_alone();
  EXPECT_GT(drawn.over_stated(), 1.25);
  drawn.state_together();
  drawn.expect_errors_as_stated();
}

TEST(StatedDeviations, AreNoLargerWhereCornersAddNothing) {
  std::mt19937 random(2);
  DrawnEdges drawn;
  drawn.add(400, 2.5, 0, random);
  drawn.state_together();
  drawn.expect_errors_as_stated();
}

TEST(StatedDeviations, AreThoseOfEdgesOfTheSameBlur) {
  std::mt19937 random(3);
  DrawnEdges drawn;
  drawn.add(400, 6, 2.5e-3, random);
  drawn.add(400, 2.5, 0, random);
  drawn.state_together();
  drawn.expect_errors_as_stated(400);
}

}  // namespace
}  // namespace petzval
