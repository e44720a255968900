// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/report/sweep_plot.h>

#include <cmath>

namespace petzval {
namespace {

Table table_of_keys(const std::vector<std::string>& keys) {
  Table table;
  for (const std::string& key : keys) table.columns.push_back({key, "", 3, key});
  return table;
}

TEST(SweepPlot, TakesNumbersInOneUnitForAnAxis) {
  const auto metres = swept_axis({"1m", "2.5m", "4m"});
  ASSERT_TRUE(metres);
  EXPECT_EQ(metres->unit, "m");
  EXPECT_EQ(metres->values, (std::vector<double>{1, 2.5, 4}));
  EXPECT_TRUE(swept_axis({"5", "1e-3"}));
  EXPECT_FALSE(swept_axis({"cooke-triplet", "tessar"}));
  EXPECT_FALSE(swept_axis({"256.5mm", "1m"})) << "two units";
  EXPECT_FALSE(swept_axis({"4", "4"})) << "nothing varies";
  EXPECT_FALSE(swept_axis({"400:10:700"})) << "a list is one value";
}

/// A table of two fields and two lenses at three stops, whose values say where they belong.
TEST(SweepPlot, DrawsACurveForEachFieldAndLens) {
  Table table = table_of_keys({"lens", "f-number", "status", "field", "tangential", "sagittal"});
  for (const char* lens : {"a", "b"})
    for (const double stop : {8.0, 4.0, 16.0})  // not in order
      for (const double field : {0.0, 14.0}) {
        const double value = stop / 100 + field / 1000 + (*lens == 'b' ? 0.5 : 0);
        table.rows.push_back({std::string(lens), stop, std::string("ok"), field, value, value / 2});
      }
  const std::vector<Plot> plots = sweep_plots(table, {"lens", "f-number"});
  ASSERT_EQ(plots.size(), 1u);
  const Plot& plot = plots[0];
  EXPECT_EQ(plot.x.label, "f-number") << "names of lenses are no axis";
  ASSERT_EQ(plot.series.size(), 8u) << "two lenses, two fields, tangential and sagittal";
  EXPECT_EQ(plot.series[0].label, "lens a, field 0");
  EXPECT_EQ(plot.series[3].label, "lens b, field 14");
  for (std::size_t i = 0; i < 4; ++i) {
    const PlotSeries &tangential = plot.series[i], &sagittal = plot.series[i + 4];
    EXPECT_EQ(tangential.x, (std::vector<double>{4, 8, 16}));
    EXPECT_EQ(tangential.stroke, PlotStroke::solid);
    EXPECT_EQ(sagittal.stroke, PlotStroke::dashed);
    EXPECT_EQ(tangential.colour, sagittal.colour);
    for (std::size_t point = 0; point < 3; ++point) {
      const double expected = tangential.x[point] / 100 + (i % 2 == 1 ? 0.014 : 0) + (i >= 2 ? 0.5 : 0);
      EXPECT_DOUBLE_EQ(tangential.y[point], expected);
      EXPECT_DOUBLE_EQ(sagittal.y[point], expected / 2);
    }
  }
  EXPECT_NE(plots[0].svg().find("lens b, field 14"), std::string::npos);
}

TEST(SweepPlot, ShowsWhatChangesUnlessItIsTold) {
  Table table = table_of_keys({"f-number", "efl_mm", "rms_radius_um", "blur_seconds", "source"});
  table.rows = {{4.0, 50.0, 9.0, 1.0, std::string("x")}, {8.0, 50.0, 4.5, 2.0, std::string("x")}};
  EXPECT_EQ(measured_columns(table, {"f-number"}),
            (std::vector<std::string>{"efl_mm", "rms_radius_um", "blur_seconds"}));
  EXPECT_EQ(sweep_plots(table, {"f-number"}).at(0).y.label, "rms radius");
  EXPECT_EQ(sweep_plots(table, {"f-number"}).at(0).y.unit, "µm");
  const std::vector<Plot> asked = sweep_plots(table, {"f-number"}, {"efl_mm", "blur_seconds"});
  ASSERT_EQ(asked.size(), 2u);
  EXPECT_EQ(asked[0].y.unit, "mm");
  EXPECT_THROW(sweep_plots(table, {"f-number"}, {"source"}), InputError);
  EXPECT_THROW(sweep_plots(table, {"source"}), InputError) << "no axis";
}

TEST(SweepPlot, LeavesAGapWhereAPointFailed) {
  Table table = table_of_keys({"focus", "status", "field", "rms_um"});
  table.rows = {{std::string("1m"), std::string("ok"), 0.0, 3.0},
                {std::string("2m"), std::string("failed"), std::string(), std::string()},
                {std::string("3m"), std::string("ok"), 0.0, 5.0},
                {std::string("3m"), std::string("ok"), 7.0, 6.0}};
  const Plot plot = sweep_plots(table, {"focus"}).at(0);
  EXPECT_EQ(plot.x.unit, "m");
  ASSERT_EQ(plot.series.size(), 2u);
  EXPECT_EQ(plot.series[0].x, (std::vector<double>{1, 3}));
}

TEST(SweepPlot, LeavesOutWhatNobodyCouldRead) {
  Table many = table_of_keys({"f-number", "field", "wavelength_nm", "frequency_cpmm", "tangential"});
  for (const double stop : {4.0, 8.0})
    for (const double field : {0.0, 7.0, 14.0})
      for (const double nm : {486.0, 588.0, 656.0})
        for (int frequency = 0; frequency <= 100; frequency += 10)
          many.rows.push_back({stop, field, nm, double(frequency), 1 - frequency / 200.0});
  std::vector<std::string> left_out;
  const std::vector<Plot> plots = sweep_plots(many, {"f-number"}, {}, &left_out);
  ASSERT_LE(plots.at(0).series.size(), 24u);
  EXPECT_EQ(plots[0].series.front().label, "field 0, 588 nm, 20/mm");
  ASSERT_EQ(left_out.size(), 2u);
  EXPECT_EQ(left_out[0], "of wavelength_nm only 588 are drawn");
  EXPECT_EQ(left_out[1], "of frequency_cpmm only 20, 50, 100 are drawn");
  // What was varied is never left out.
  Table lenses = table_of_keys({"lens", "f-number", "efl_mm"});
  for (int lens = 0; lens < 61; ++lens)
    for (const double stop : {4.0, 8.0}) lenses.rows.push_back({"lens " + std::to_string(lens), stop, stop});
  EXPECT_THROW(sweep_plots(lenses, {"lens", "f-number"}), InputError);
}

}  // namespace
}  // namespace petzval
