// SPDX-License-Identifier: BSD-3-Clause
// Lenses typed as tables: the same lens in every way of writing it, and what is left out.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/formats/lens_table.h>

#include <cmath>

namespace petzval {
namespace {

LensFile table(const std::string& text) {
  return read_lens_table(text, "mine.csv", {});
}

/// A lens of radius 50, 5 mm of index 1.5, flat behind: 1/f = 0.5/50, whatever its thickness.
constexpr const char* bare = "50, 5, 1.5, 10\nflat, , , 10\n";

TEST(LensTable, IsTheSameLensHoweverItIsWritten) {
  for (const std::string text :
       {bare, "50 5 1.5 10\n0 100 air 10\n", "50\t5\t1.5\t10\ninf\t\t\t10\n",
        "radius;thickness;nd;diameter\n50;5;1.5;20\nplano;;;20\n",
        "Surface,Glass,Radius [mm],Thickness (mm),Semi-Diameter\n1,1.5,50.0,5,10\n2,air,-,,10\n"}) {
    const Lens lens = table(text).lens;
    ASSERT_EQ(lens.surfaces.size(), 2U) << text;
    EXPECT_NEAR(first_order(lens).efl_mm, 100, 1e-9) << text;
    EXPECT_EQ(lens.surfaces[0].semi_diameter_mm, 10) << text;
    EXPECT_EQ(lens.surfaces[1].curvature_per_mm, 0) << text;
  }
}

TEST(LensTable, TakesAsUsualWhatNobodySays) {
  const LensFile file = table(bare);
  EXPECT_TRUE(file.lens.surfaces[0].stop);
  EXPECT_EQ(file.lens.wavelengths_nm.size(), 3U);
  // Plane surface behind, principal plane at the front vertex: bfl = f − t/n.
  EXPECT_NEAR(file.lens.surfaces[1].thickness_mm, 100 - 5 / 1.5, 1e-9);
  ASSERT_EQ(file.notes.size(), 1U);
  for (const char* words : {"stop", "wavelengths", "fields", "paraxial focus"})
    EXPECT_NE(file.notes[0].find(words), std::string::npos) << file.notes[0];
}

TEST(LensTable, SaysWhatItIsToldToSay) {
  const LensFile file = table(
      "# name: mine\n# f-number: 4\n# fields: 0, 3\n# wavelengths: 500, 600\n# object: 400\n"
      "stop, 2,,\n50,5,1.5168/64.17,10\n-50,90,,10\n");
  EXPECT_EQ(file.lens.name, "mine");
  EXPECT_TRUE(file.lens.surfaces[0].stop);
  EXPECT_EQ(file.lens.object_distance_mm, 400);
  EXPECT_NEAR(first_order(file.lens).f_number, 4, 1e-9);
  EXPECT_EQ(file.lens.fields.values, (std::vector<double>{0, 3}));
  EXPECT_TRUE(file.notes.empty());
}

TEST(LensTable, TheOneToStartFromIsALensOf50Millimetres) {
  const LensFile file = table(lens_table_to_start_from());
  EXPECT_NEAR(first_order(file.lens).efl_mm, 50, 0.01);
}

TEST(LensTable, RefusesWhatIsNoLensWithItsLine) {
  const auto refusal = [](const std::string& text) -> std::string {
    try {
      table(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal("50,5,1.5,10\nround,,,10\n").find("mine.csv:2"), std::string::npos);
  EXPECT_NE(refusal("50,,1.5,10\nflat,,,10\n").find("thickness"), std::string::npos);
  EXPECT_NE(refusal("50,5,N-BK77,10\nflat,,,10\n").find("N-BK7"), std::string::npos);
  EXPECT_NE(refusal("50,5,1.5\nflat,,\n").find("# f-number"), std::string::npos);
  EXPECT_NE(refusal("-50,5,1.5,10\nflat,,,10\n").find("real image"), std::string::npos);
  EXPECT_NE(refusal("radius,weight\n50,5\n").find("headings"), std::string::npos);
  EXPECT_NE(refusal("").find("surfaces"), std::string::npos);
  EXPECT_NE(refusal("1,2,3,4,5,6,7\n").find("columns"), std::string::npos);
  for (const char* noise :
       {"\xff\xfe\n", ",,,,\n", "# :\n", "nan,1,1.5,1\n", "1e400,1,1.5,1\n", "50,5,0.5,10\n"})
    EXPECT_NE(refusal(noise), "") << noise;
}

}  // namespace
}  // namespace petzval
