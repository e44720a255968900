// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/imaging/lens_corrections.h>

#include <cmath>

namespace petzval {
namespace {

/// A lens of 10 mm with distortion of the third order and light as cos⁴, by its formulas; the frame's corner
/// is 5 mm off the axis.
LensDataTable formula_table(double third_order) {
  LensDataTable table;
  table.first_order.wavelength_nm = 550;
  table.wavelengths_nm = {550};
  for (double degrees = 0; degrees <= 36; degrees += 2) {
    const double tangent = std::tan(degrees * 3.14159265358979 / 180);
    table.fields.push_back(degrees);
    table.real_image_height_mm.push_back(10 * tangent * (1 + third_order * tangent * tangent));
    table.g_sensor_sr.push_back(0.2 / std::pow(1 + tangent * tangent, 2));
  }
  return table;
}

constexpr SensorGeometry corrected_frame{1600, 1200, 5};

double even_sum(const std::vector<double>& terms, double r) {
  double sum = 0;
  for (std::size_t i = 0; i < terms.size(); ++i) sum += terms[i] * std::pow(r, 2 * static_cast<double>(i));
  return sum;
}

TEST(LensCorrections, UndoDistortionAndFallOff) {
  for (const double third_order : {-0.3, 0.0, 0.2}) {
    LensFacts facts;
    add_corrections(facts, formula_table(third_order), corrected_frame);
    ASSERT_EQ(facts.warp.size(), 4u) << third_order;
    ASSERT_EQ(facts.vignetting.size(), 5u) << third_order;
    // A point of the straight picture at r has the tangent r · 5/(10 · scale), and lies on the sensor where
    // the lens puts it. Pincushion distortion is shown so large that the corner stays where it is.
    const double scale = third_order > 0 ? 1 / facts.warp[0] : 1;
    for (double r = 0.05; r <= 1; r += 0.05) {
      const double tangent = r / 2 / scale, real = 2 * tangent * (1 + third_order * tangent * tangent);
      constexpr double tenth_of_a_pixel = 0.1 * 0.005 / 5;
      EXPECT_NEAR(even_sum(facts.warp, r) * r, real, tenth_of_a_pixel) << third_order << " at " << r;
      const double light = 1 / std::pow(1 + tangent * tangent, 2);
      std::vector<double> gain{1};
      gain.insert(gain.end(), facts.vignetting.begin(), facts.vignetting.end());
      EXPECT_NEAR(light * even_sum(gain, real), 1, 0.001) << third_order << " at " << r;
    }
    if (third_order > 0) {
      EXPECT_NEAR(even_sum(facts.warp, 1), 1, 1e-3);
    }
  }
}

TEST(LensCorrections, AreLeftOutWhereTheyDoNotFit) {
  LensFacts facts;
  add_corrections(facts, formula_table(-0.3), {4800, 3600, 5});  // fields end before the corner
  EXPECT_TRUE(facts.warp.empty());
  EXPECT_TRUE(facts.vignetting.empty());
  LensDataTable fisheye = formula_table(0);
  for (std::size_t i = 0; i < fisheye.fields.size(); ++i) {
    fisheye.fields[i] = 4.9 * static_cast<double>(i);
    fisheye.real_image_height_mm[i] = 5.0 / 17 * static_cast<double>(i);
  }
  add_corrections(facts, fisheye, corrected_frame);
  EXPECT_TRUE(facts.warp.empty());
}

}  // namespace
}  // namespace petzval
