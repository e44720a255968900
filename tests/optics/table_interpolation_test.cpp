// SPDX-License-Identifier: BSD-3-Clause
#include "analytic_table.h"

#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/optics/table_interpolation.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace petzval {
namespace {

using testing::analytic_table;
using testing::AnalyticLens;

/// Largest of `error` at 700 fields between the axis and the edge, most of them between entries.
double worst(const AnalyticLens& lens, const std::function<double(double field)>& error) {
  double largest = 0;
  for (int k = 0; k <= 700; ++k) largest = std::max(largest, std::abs(error(lens.edge_deg * k / 700)));
  return largest;
}

// What the blur and the distortion ask of 21 fields: 1e-5 of the edge height (0.03 µm of 3 mm) and 1e-4 of g.
// The interpolation is of fourth order and stays well below.
TEST(RadialProfiles, InterpolatesASmoothLensBetweenItsFields) {
  const AnalyticLens lens;
  const RadialProfile at = RadialProfiles(analytic_table()).at_wavelength(500);
  const double edge = lens.height_mm(lens.edge_deg);
  EXPECT_LT(
      worst(lens,
            [&](double field) { return at.image_height_mm(field) / edge - lens.height_mm(field) / edge; }),
      1e-5);
  EXPECT_LT(worst(lens,
                  [&](double field) {
                    return at.object_field(lens.height_mm(field)) / lens.edge_deg - field / lens.edge_deg;
                  }),
            1e-5);
  EXPECT_LT(
      worst(lens, [&](double field) { return at.g_source_sr(lens.height_mm(field)) / lens.g_sr(field) - 1; }),
      1e-4);
  EXPECT_LT(worst(lens,
                  [&](double field) {
                    return at.g_sensor_sr(lens.height_mm(field)) / (0.99 * lens.g_sr(field)) - 1;
                  }),
            1e-4);
  EXPECT_DOUBLE_EQ(at.max_height_mm(), edge);
}

// Halving the spacing of the fields divides the error by 16, less what the limiter costs at the ends.
TEST(RadialProfiles, ConvergesWithTheFourthOrder) {
  const AnalyticLens lens;
  const auto error = [&](int fields) {
    const RadialProfile at = RadialProfiles(analytic_table(fields)).at_wavelength(500);
    return worst(lens, [&](double field) { return at.image_height_mm(field) - lens.height_mm(field); });
  };
  EXPECT_GT(error(11) / error(21), 12);
}

TEST(RadialProfiles, HeightAndFieldUndoEachOther) {
  const RadialProfile at = RadialProfiles(analytic_table()).at_wavelength(533);
  for (int k = 0; k <= 1000; ++k) {
    const double height = 1.05 * at.max_height_mm() * k / 1000;  // past the end too
    EXPECT_NEAR(at.image_height_mm(at.object_field(height)), height, 2e-14);
  }
}

TEST(RadialProfiles, IsExactAtTheEntriesAndLinearBetweenWavelengths) {
  const LensDataTable table = analytic_table();
  const RadialProfiles profiles(table);
  const AnalyticLens lens;
  for (std::size_t f = 0; f < table.fields.size(); ++f) {
    const double field = table.fields[f];
    EXPECT_NEAR(profiles.at_wavelength(600).image_height_mm(field),
                table.real_image_height_mm[table.index(f, 1)], 1e-14);
    // the analytic lens is linear in wavelength, so the table is exact there
    const RadialProfile between = profiles.at_wavelength(525);
    EXPECT_NEAR(between.image_height_mm(field), lens.height_mm(field, 525), 1e-13);
    EXPECT_NEAR(between.g_source_sr(lens.height_mm(field, 525)), lens.g_sr(field, 525), 1e-14);
  }
}

TEST(RadialProfiles, RefusesWavelengthsOutsideTheTable) {
  const RadialProfiles two(analytic_table()), one(analytic_table(21, {550}));
  EXPECT_THROW(two.at_wavelength(499.9), InputError);
  EXPECT_THROW(two.at_wavelength(600.1), InputError);
  EXPECT_THROW(two.at_wavelength(std::nan("")), InputError);
  EXPECT_NO_THROW(two.at_wavelength(600));
  EXPECT_NO_THROW(one.at_wavelength(550.4));
  EXPECT_THROW(one.at_wavelength(550.6), InputError);
}

TEST(RadialProfiles, IsHeldOrGoesOnBeyondTheLastField) {
  const AnalyticLens lens;
  const RadialProfile at = RadialProfiles(analytic_table()).at_wavelength(500);
  const double edge = at.max_height_mm();
  EXPECT_DOUBLE_EQ(at.g_source_sr(edge + 1), at.g_source_sr(edge));
  // slope of the analytic lens at the edge, to the accuracy of a one-sided stencil
  const double step = 1e-4;
  const double slope = step / (lens.height_mm(lens.edge_deg + step) - lens.height_mm(lens.edge_deg));
  EXPECT_NEAR(at.object_field(edge + 0.1) - lens.edge_deg, 0.1 * slope, 1e-3 * slope);
}

// g falls off a cliff where the last fields are vignetted: no curve may go below the cliff's foot or above
// its top.
TEST(RadialProfiles, DoesNotOvershootWhereVignettingSetsIn) {
  LensDataTable table = analytic_table();
  for (std::size_t f = 15; f < table.fields.size(); ++f)
    for (std::size_t w = 0; w < 2; ++w) table.g_source_sr[table.index(f, w)] = 0;
  const RadialProfile at = RadialProfiles(table).at_wavelength(500);
  for (int k = 0; k <= 2000; ++k) {
    const double height = at.max_height_mm() * k / 2000;
    EXPECT_GE(at.g_source_sr(height), 0);
    EXPECT_LE(at.g_source_sr(height), pi / 16 * (1 + 1e-15));
  }
  EXPECT_EQ(at.g_source_sr(table.real_image_height_mm[table.index(15, 0)]), 0);
}

// The paper's polynomials: they do not meet the entries, and say by how much. Residuals must be those of the
// polynomial that is used.
TEST(RadialProfiles, PolynomialsReportTheirResiduals) {
  const LensDataTable table = analytic_table();
  double previous = 1e9;
  for (int order = 4; order <= 8; ++order) {
    const RadialProfiles profiles(table, {order});
    const FitResiduals residuals = profiles.residuals_at(500);
    const RadialProfile at = profiles.at_wavelength(500);
    double height_um = 0, g = 0;
    for (std::size_t f = 0; f < table.fields.size(); ++f) {
      const double height = table.real_image_height_mm[table.index(f, 0)];
      height_um = std::max(height_um, 1e3 * std::abs(at.image_height_mm(table.fields[f]) - height));
      g = std::max(
          g, std::abs(at.g_source_sr(height) - table.g_source_sr[table.index(f, 0)]) / table.g_source_sr[0]);
    }
    // 1e-6 µm, 1e-9: sampling of the polynomial at 1025 points
    EXPECT_NEAR(residuals.height_max_um, height_um, 1e-6);
    EXPECT_NEAR(residuals.g_source_max, g, 1e-9);
    EXPECT_TRUE(residuals.monotone);
    EXPECT_LE(residuals.height_max_um, previous);
    previous = residuals.height_max_um;
    EXPECT_EQ(at.object_field(0), 0);
  }
  EXPECT_EQ(RadialProfiles(table).residuals_at(500).height_max_um, 0);
}

// The trap that the monotone interpolant is there for: a fisheye's data steep at the edge make an 8th-order
// polynomial turn back. Heights that rise in two steps do it here.
TEST(RadialProfiles, RefusesPolynomialsThatTurnBack) {
  LensDataTable table = analytic_table(21, {550});
  for (std::size_t f = 0; f < table.fields.size(); ++f)
    table.real_image_height_mm[f] = 1e-3 * static_cast<double>(f) + (f > 9 ? 3 : 0);
  EXPECT_FALSE(RadialProfiles(table, {8}).residuals_at(550).monotone);
  EXPECT_THROW(RadialProfiles(table, {8}).at_wavelength(550), InputError);
  const RadialProfile monotone = RadialProfiles(table).at_wavelength(550);
  double previous = -1;
  for (int k = 0; k <= 3000; ++k) {
    const double height = monotone.image_height_mm(table.fields.back() * k / 3000);
    EXPECT_GT(height, previous);
    previous = height;
  }
}

TEST(RadialProfiles, SaysWhatItNeeds) {
  EXPECT_THROW(RadialProfiles(analytic_table(21), {3}), InputError);
  EXPECT_THROW(RadialProfiles(analytic_table(21), {9}), InputError);
  EXPECT_THROW(RadialProfiles(analytic_table(6), {6}), InputError);
  EXPECT_NO_THROW(RadialProfiles(analytic_table(7), {6}));
  LensDataTable axis_only = analytic_table(2);
  axis_only.fields.resize(1);
  EXPECT_THROW(RadialProfiles{axis_only}, InputError);
}

TEST(RadialFit, IsNamedOnTheCommandLine) {
  EXPECT_EQ(RadialFit::parse("monotone").polynomial_order, 0);
  EXPECT_EQ(RadialFit::parse("6").polynomial_order, 6);
  for (const char* wrong : {"", "3", "9", "44", "spline"})
    EXPECT_THROW(RadialFit::parse(wrong), InputError) << wrong;
}

}  // namespace
}  // namespace petzval
