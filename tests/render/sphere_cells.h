// SPDX-License-Identifier: BSD-3-Clause
// χ² of directions against a density over the sphere.
#pragma once

#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/render/vector3.h>

#include <cmath>
#include <string>
#include <vector>

namespace petzval::render {

/// Counts directions in cells of equal solid angle and compares them with the integral of a density, by the
/// midpoint rule with `fine` × `fine` points a cell.
class SphereCells {
 public:
  static constexpr int rings = 12, sectors = 12;

  void count(Vector3 w) {
    const int ring = std::min(static_cast<int>((w.z + 1) / 2 * rings), rings - 1);
    const double phi = std::atan2(w.y, w.x) + pi;
    const int sector = std::min(static_cast<int>(phi / (2 * pi) * sectors), sectors - 1);
    found_[static_cast<std::size_t>(ring * sectors + sector)] += 1;
  }

  /// \param samples  that were drawn, whether or not they were counted. \param rule_error  of the midpoint
  /// rule, relative: where the density has steps, or is steep.
  template <class Density>
  void expect_density(int samples, int fine, double rule_error, const std::string& what,
                      Density&& density) const {
    std::vector<double> expected(found_.size());
    const double solid_angle = 4 * pi / (rings * fine * sectors * fine);
    for (int ring = 0; ring < rings * fine; ++ring)
      for (int sector = 0; sector < sectors * fine; ++sector) {
        const double z = -1 + 2 * (ring + 0.5) / (rings * fine), r = std::sqrt(1 - z * z);
        const double phi = 2 * pi * (sector + 0.5) / (sectors * fine) - pi;
        expected[static_cast<std::size_t>(ring / fine * sectors + sector / fine)] +=
            density(Vector3{r * std::cos(phi), r * std::sin(phi), z}) * solid_angle * samples;
      }
    double chi2 = 0, cells = 0, few_found = 0, few_expected = 0;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      if (expected[i] < 20) {
        few_found += found_[i], few_expected += expected[i];
        continue;
      }
      const double rule = rule_error * expected[i];
      chi2 += (found_[i] - expected[i]) * (found_[i] - expected[i]) / (expected[i] + rule * rule);
      cells += 1;
    }
    EXPECT_GT(cells, 0) << what;
    // χ² has mean `cells` and variance 2·cells; five of its deviations are passed once in a million.
    EXPECT_LT(chi2, cells + 5 * std::sqrt(2 * cells)) << what;
    EXPECT_NEAR(few_found, few_expected, 5 * std::sqrt(few_expected + 1) + rule_error * samples * 0.01 + 5)
        << what;
  }

 private:
  std::vector<double> found_ = std::vector<double>(rings * sectors, 0.0);
};

}  // namespace petzval::render
