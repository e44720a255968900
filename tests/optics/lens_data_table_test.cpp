// SPDX-License-Identifier: BSD-3-Clause
#include "analytic_table.h"

#include <gtest/gtest.h>
#include <petzval/base/error.h>

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace petzval {
namespace {

using testing::analytic_table;

TEST(LensDataTable, AcceptsAWholeTable) {
  EXPECT_NO_THROW(analytic_table().validate());
  EXPECT_NO_THROW(analytic_table(1, {550}).validate());
}

TEST(LensDataTable, NamesWhatIsWrong) {
  const double nan = std::nan("");
  const std::vector<std::pair<const char*, std::function<void(LensDataTable&)>>> faults = {
      {"no fields", [](LensDataTable& t) { t.fields.clear(); }},
      {"no wavelengths", [](LensDataTable& t) { t.wavelengths_nm.clear(); }},
      {"fields must increase", [](LensDataTable& t) { std::swap(t.fields[3], t.fields[4]); }},
      {"wavelengths must increase", [](LensDataTable& t) { t.wavelengths_nm[1] = t.wavelengths_nm[0]; }},
      {"first field", [](LensDataTable& t) { t.fields[0] = -1; }},
      {"no wavelength", [](LensDataTable& t) { t.wavelengths_nm[0] = -5; }},
      {"must be finite", [&](LensDataTable& t) { t.fields[2] = nan; }},
      {"real_image_height_mm", [&](LensDataTable& t) { t.real_image_height_mm[5] = nan; }},
      {"g_source_sr", [&](LensDataTable& t) { t.g_source_sr[5] = INFINITY; }},
      {"g_sensor_sr", [](LensDataTable& t) { t.g_sensor_sr[5] = -1e-9; }},
      {"from the whole hemisphere", [](LensDataTable& t) { t.g_sensor_sr[5] = 3.15; }},
      {"from the whole hemisphere", [](LensDataTable& t) { t.g_source_sr[5] = 22; }},
      {"need 42", [](LensDataTable& t) { t.g_sensor_sr.pop_back(); }},
      {"no light of 600 nm", [](LensDataTable& t) { t.g_source_sr[1] = 0; }},
      {"does not rise", [](LensDataTable& t) { t.real_image_height_mm[12] = t.real_image_height_mm[10]; }},
      {"stands 0.1 mm", [](LensDataTable& t) { t.real_image_height_mm[0] = 0.1; }},
      {"PSFs", [](LensDataTable& t) { t.psf.pop_back(); }},
      {"values for size", [](LensDataTable& t) { t.psf[7].values.pop_back(); }},
      {"values for size", [](LensDataTable& t) { t.psf[7].size = -3; }},
      {"sample spacing", [](LensDataTable& t) { t.psf[7].spacing_um = 0; }},
      {"captured", [&](LensDataTable& t) { t.psf[7].captured = nan; }},
      {"must sum to 1", [](LensDataTable& t) { t.psf[7].values[0] += 0.1f; }},
      {"must sum to 1", [&](LensDataTable& t) { t.psf[7].values[0] = static_cast<float>(nan); }},
      {"object distance", [](LensDataTable& t) { t.object_distance_mm = 0; }},
      {"from vertex 1", [&](LensDataTable& t) { t.vertex_to_sensor_mm = nan; }},
  };
  for (const auto& [words, spoil] : faults) {
    LensDataTable table = analytic_table();
    spoil(table);
    try {
      table.validate();
      FAIL() << "accepted: " << words;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }
}

/// Oil or glass before the sensor holds n'² times the light of air.
TEST(LensDataTable, AcceptsWhatOnlyAnImmersedLensGives) {
  LensDataTable table = analytic_table();
  table.g_sensor_sr[0] = 1.4 * 1.4 * pi;
  EXPECT_THROW(table.validate(), InputError);
  table.first_order.image_space_na = 1.4;
  EXPECT_NO_THROW(table.validate());
  table.lens_json.clear();  // the number is all that says so
  EXPECT_THROW(table.validate(), InputError);
}

TEST(LensDataTable, KnowsTheTangentOfItsFields) {
  LensDataTable table = analytic_table();
  EXPECT_STREQ(table.field_unit(), "deg");
  EXPECT_DOUBLE_EQ(table.field_tangent(45), 1);
  EXPECT_THROW(table.field_tangent(90), InputError);
  EXPECT_THROW(table.field_tangent(std::nan("")), InputError);
  table.object_distance_mm = 250;
  EXPECT_STREQ(table.field_unit(), "mm");
  EXPECT_DOUBLE_EQ(table.field_tangent(50), 0.2);
}

}  // namespace
}  // namespace petzval
