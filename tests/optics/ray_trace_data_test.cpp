// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/optics/formats/ray_trace_data.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "analytic_table.h"

namespace petzval {
namespace {

/// The analytic lens as another program would give it: heights, illumination and PSFs, nothing of Petzval's.
RayTraceData of_another_program() {
  RayTraceData data = [] {
    LensDataTable table = testing::analytic_table(5);
    for (Psf& psf : table.psf) psf = testing::comatic_psf(7, 1, 0.5);
    return ray_trace_data(table);
  }();
  data.kept.clear();
  return data;
}

bool has_note(const ImportedTable& imported, const std::string& words) {
  for (const std::string& note : imported.notes)
    if (note.find(words) != std::string::npos) return true;
  return false;
}

std::string refusal_of(const RayTraceData& data, const RayTraceReading& reading = {}) {
  try {
    table_of(data, reading);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

/// The falloff of the lens is cos⁴ whatever number stands for the axis in the file, so the table must be.
TEST(RelativeIllumination, IsThatOfTheLensWhateverTheAxisIsCalled) {
  const RayTraceData right = of_another_program();
  const ImportedTable wanted = table_of(right);
  EXPECT_FALSE(has_note(wanted, "relative illumination"));
  const testing::AnalyticLens lens;
  for (const auto& [axis, words] : {std::pair{100.0, "per cent"}, {0.93, "is 0.93 on the axis"}}) {
    RayTraceData data = right;
    for (double& value : data.relative_illumination) value *= axis;
    const ImportedTable imported = table_of(data);
    EXPECT_TRUE(has_note(imported, words)) << axis;
    for (std::size_t i = 0; i < wanted.table.g_sensor_sr.size(); ++i) {
      EXPECT_NEAR(imported.table.g_sensor_sr[i], wanted.table.g_sensor_sr[i], 1e-15);  // a division
      EXPECT_NEAR(imported.table.g_source_sr[i], wanted.table.g_source_sr[i], 1e-15);
    }
    const double edge = imported.table.g_sensor_sr[8] / imported.table.g_sensor_sr[0];
    EXPECT_NEAR(edge, lens.g_sr(30, 500) / lens.g_sr(0, 500), 1e-12);
  }
}

TEST(RelativeIllumination, OfAWallIsRelativeToTheAxisAtEachWavelength) {
  RayTraceData data = of_another_program();
  for (std::size_t i = 0; i < data.relative_illumination.size(); ++i)
    data.relative_illumination[i] *= i % 2 == 0 ? 0.9 : 0.8;
  const ImportedTable imported = table_of(data);
  EXPECT_TRUE(has_note(imported, "is 0.8 to 0.9 on the axis"));
  EXPECT_DOUBLE_EQ(imported.table.g_sensor_sr[0], imported.table.g_sensor_sr[1]);
}

TEST(RelativeIllumination, StaysAsRoundedFilesHaveIt) {
  RayTraceData data = of_another_program();
  for (double& value : data.relative_illumination) value *= 0.995;
  RayTraceReading reading;
  reading.g_axis_sr = 0.2;
  const ImportedTable imported = table_of(data, reading);
  EXPECT_FALSE(has_note(imported, "relative illumination"));
  EXPECT_DOUBLE_EQ(imported.table.g_sensor_sr[0], 0.2 * 0.995);
}

/// Of object points before the blur, ISET multiplies by the number that stands there.
TEST(RelativeIllumination, OfObjectPointsIsTakenAsItStands) {
  RayTraceData data = of_another_program();
  for (double& value : data.relative_illumination) value *= 1.016;
  RayTraceReading reading;
  reading.g_axis_sr = 0.2;
  reading.illumination = RayTraceReading::Illumination::source;
  const ImportedTable imported = table_of(data, reading);
  EXPECT_FALSE(has_note(imported, "relative illumination"));
  EXPECT_DOUBLE_EQ(imported.table.g_source_sr[0], 0.2 * 1.016);
}

/// A hemisphere of light is π sr: whatever says that a lens gives more is wrong.
TEST(TableOfRayTraceData, RefusesMoreLightThanThereIs) {
  RayTraceReading reading;
  reading.g_axis_sr = 3.1;
  EXPECT_EQ(refusal_of(of_another_program(), reading), "");
  reading.g_axis_sr = 3.2;
  EXPECT_NE(refusal_of(of_another_program(), reading).find("π"), std::string::npos);
  RayTraceData brighter = of_another_program();
  brighter.relative_illumination[4] *= 100;  // of one field alone
  EXPECT_NE(refusal_of(brighter).find("π"), std::string::npos);
}

TEST(TableOfRayTraceData, SaysWhatIsMissingOrImpossible) {
  const std::vector<std::pair<std::string, std::function<void(RayTraceData&)>>> spoilt = {
      {"focal length is -6 mm", [](RayTraceData& data) { data.effective_focal_length_mm = -6; }},
      {"focal length is missing",
       [](RayTraceData& data) { data.effective_focal_length_mm = RayTraceData::unknown; }},
      {"object distance is -100 mm", [](RayTraceData& data) { data.object_distance_mm = -100; }},
      {"object distance is 0 mm", [](RayTraceData& data) { data.object_distance_mm = 0; }},
      {"does not say the object distance",
       [](RayTraceData& data) {
         data.object_distance_mm = RayTraceData::unknown;
         data.magnification = -0.1;
       }},
      {"magnification is missing",
       [](RayTraceData& data) {
         data.object_distance_mm = 100;
         data.magnification = RayTraceData::unknown;
       }},
      {"does not say the f-number", [](RayTraceData& data) { data.f_number = RayTraceData::unknown; }},
      {"f-number is -2", [](RayTraceData& data) { data.f_number = -2; }},
      {"550 would be right for 0.55",
       [](RayTraceData& data) {
         data.wavelengths_nm = {0.55, 0.65};
       }},
  };
  for (const auto& [words, spoil] : spoilt) {
    RayTraceData data = of_another_program();
    spoil(data);
    EXPECT_NE(refusal_of(data).find(words), std::string::npos) << words << " in: " << refusal_of(data);
  }
}

TEST(TableOfRayTraceData, SaysWhenItTakesTheObjectToBeAtInfinity) {
  EXPECT_FALSE(has_note(table_of(of_another_program()), "infinity"));
  RayTraceData silent = of_another_program();
  silent.object_distance_mm = RayTraceData::unknown;
  EXPECT_TRUE(has_note(table_of(silent), "does not say the object distance"));
  RayTraceData torn = of_another_program();
  torn.object_distance_mm = 100;
  EXPECT_TRUE(has_note(table_of(torn), "the magnification is 0"));
}

TEST(TableOfRayTraceData, SaysThatWhatPetzvalKeptIsTakenAsItWas) {
  LensDataTable table = testing::analytic_table(5);
  for (Psf& psf : table.psf) psf = testing::comatic_psf(7, 1, 0.5);
  RayTraceReading reading;
  EXPECT_TRUE(table_of(ray_trace_data(table), reading).notes.empty());
  reading.g_axis_sr = 0.2;
  const ImportedTable imported = table_of(ray_trace_data(table), reading);
  EXPECT_EQ(imported.table.g_sensor_sr, table.g_sensor_sr);
  EXPECT_TRUE(has_note(imported, "`g_axis_sr`"));
}

}  // namespace
}  // namespace petzval
