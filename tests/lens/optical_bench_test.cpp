// SPDX-License-Identifier: BSD-3-Clause
// Prescriptions as the Optical Bench and FlareSim keep them.
#include "bench_samples.h"
#include "sample_lenses.h"
#include "scratch_file.h"

#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_states.h>
#include <petzval/lens/surface_shape.h>

#include <map>
#include <vector>

namespace petzval {
namespace {

using namespace testing;

using Powers = std::map<int, double>;

LensFile read_bench(const std::string& text) {
  return read_text("sample.txt", text);
}

std::string bench_complaint(const std::string& text, const std::string& name = "sample.txt") {
  return error_of([&] { read_text(name, text); });
}

TEST(OpticalBench, ReadsSurfacesAndGlasses) {
  const LensFile file = read_bench(bench("", singlet));
  const Lens& lens = file.lens;
  EXPECT_EQ(lens.name, "Sample");
  ASSERT_EQ(lens.surfaces.size(), 3u);
  EXPECT_EQ(lens.surfaces[0].curvature_per_mm, 1 / 51.68);
  EXPECT_EQ(lens.surfaces[0].semi_diameter_mm, 12.5);
  EXPECT_EQ(lens.surfaces[1].curvature_per_mm, 0);
  EXPECT_TRUE(lens.surfaces[2].stop);
  EXPECT_EQ(lens.surfaces[2].thickness_mm, 96.3);
  EXPECT_FALSE(lens.object_distance_mm);
  EXPECT_EQ(lens.fields.values, (std::vector<double>{0, 5, 7, 10}));
  // A plano-convex lens: f = R / (n − 1).
  EXPECT_NEAR(first_order(lens).efl_mm, 51.68 / 0.5168, 1e-9);
  EXPECT_NEAR(first_order(lens).f_number, 8, 1e-9);
  const double f = lens.surfaces[0].material.index(486.1327), c = lens.surfaces[0].material.index(656.2725);
  EXPECT_NEAR(0.5168 / (f - c), 64.17, 1e-6);
  EXPECT_TRUE(file.notes.empty());
  EXPECT_TRUE(lens.states.empty());
}

TEST(OpticalBench, HasAStateForEachSettingThatGivesAllGaps) {
  const std::string rows = "1\t51.68\td1\t1.5168\t25\t64.17\n2\tInfinity\t1\t\t25\n3\tAS\tBf\t\t12\n";
  const Lens lens = read_bench(bench("", rows, "", "d1\t4\t5\nBf\t96.3\t110\n")).lens;
  EXPECT_EQ(lens.states.names, (std::vector<std::string>{"setting-1", "setting-2"}));
  EXPECT_EQ(lens.surfaces[0].thickness_mm, 4);
  const Lens second = in_state(lens, "setting-2");
  EXPECT_EQ(second.surfaces[0].thickness_mm, 5);
  EXPECT_EQ(second.surfaces[2].thickness_mm, 110);
  EXPECT_EQ(second.fields.values.back(), 12);
  // The second setting does not say d1.
  EXPECT_TRUE(read_bench(bench("", rows, "", "d1\t4\nBf\t96.3\t110\n")).lens.states.empty());
}

TEST(OpticalBench, TakesTheCataloguesGlassWhereIndexAndAbbeNumberAreItsOwn) {
  const std::string behind = "2\tInfinity\t1\t\t25\n3\tAS\tBf\t\t12\n";
  const auto glass = [&](const std::string& row) {
    return read_bench(bench("", row + behind)).lens.surfaces[0].material;
  };
  EXPECT_EQ(glass("1\t51.68\t4\t1.51680\t25\t64.17\tN-BK7\n").description(), "SCHOTT:N-BK7");
  // Another index than the catalogue's: the patent's counts.
  EXPECT_NEAR(glass("1\t51.68\t4\t1.52000\t25\t64.17\tN-BK7\n").index(587.5618), 1.52, 1e-12);
  EXPECT_NEAR(glass("1\t51.68\t4\t1.52000\t25\t64.17\tUNHEARD-OF\n").index(587.5618), 1.52, 1e-12);
}

/// Powers 4, 6, 8 …; 2, 4, 6 … with AsphericalA2; with odd powers, 3, 4, 6, 8 … (one) and 3, 4, 5, 6, 8 …
/// (two), as US patent 7,663,816 prints them (C3, C4, C6 …).
TEST(OpticalBench, KnowsWhichPowersItsCoefficientsAreOf) {
  const auto powers = [](const std::string& constants) {
    const std::string coefficients = "1\t51.68\t-0.5\t1e-3\t2e-4\t3e-6\t4e-8\n";
    const Lens lens = read_bench(bench(constants, singlet, coefficients)).lens;
    EXPECT_EQ(lens.surfaces[0].conic, -0.5);
    return lens.surfaces[0].asphere;
  };
  EXPECT_EQ(powers(""), (Powers{{4, 1e-3}, {6, 2e-4}, {8, 3e-6}, {10, 4e-8}}));
  EXPECT_EQ(powers("AsphericalA2\n"), (Powers{{2, 1e-3}, {4, 2e-4}, {6, 3e-6}, {8, 4e-8}}));
  EXPECT_EQ(powers("AsphericalOddCount\t1\n"), (Powers{{3, 1e-3}, {4, 2e-4}, {6, 3e-6}, {8, 4e-8}}));
  EXPECT_EQ(powers("AsphericalOddCount\t2\n"), (Powers{{3, 1e-3}, {4, 2e-4}, {5, 3e-6}, {6, 4e-8}}));
}

TEST(OpticalBench, PutsTheSensorInTheFocusWhereNoBackFocusIsGiven) {
  const LensFile file = read_bench(bench("", singlet, "", "Bf\tundefined\n"));
  const FirstOrder data = first_order(file.lens);
  EXPECT_NEAR(data.paraxial_image_mm, file.lens.surfaces[2].thickness_mm, 1e-9);
  expect_mentions(file.notes.back(), {"paraxial focus"});
}

TEST(OpticalBench, SaysWhatIsWrongAndWhere) {
  expect_mentions(bench_complaint(bench("", "1\t51.68\td4\t1.5\t25\t64\n2\tAS\tBf\t\t12\n")),
                  {"11: the thickness 'd4' is neither a number nor given"});
  expect_mentions(bench_complaint(bench("", "1\tround\t4\t1.5\t25\t64\n")), {"'round' is no radius"});
  expect_mentions(bench_complaint(bench("", "1\t51.68\t4\t1.5\t25\t64\n")), {"has no stop"});
  expect_mentions(bench_complaint(bench("", singlet, "9\t51.68\t0\t1e-3\n")), {"no surface '9'"});
  expect_mentions(bench_complaint(bench("", "")), {"[lens data] is empty"});
  expect_mentions(bench_complaint(bench("AsphericalOddCount\t1e99\n", singlet)), {":4:", "1 to 20"});
}

TEST(FlareSim, ReadsRowsOfSemiApertures) {
  const LensFile file = read_text("sample.lens", flare_rows);
  EXPECT_TRUE(file.notes.empty());
  EXPECT_EQ(file.lens.name, "Sample");
  EXPECT_EQ(file.lens.surfaces[0].semi_diameter_mm, 12.5);
  EXPECT_EQ(file.lens.aperture.value, 6);
  EXPECT_NEAR(first_order(file.lens).efl_mm, 100, 1e-9);
}

TEST(FlareSim, ReadsDiametersOfConvertedFilesAsThatAndSaysSo) {
  const LensFile file =
      read_text("sample.lens", "# Converted from photonstophotos.net Optical Bench data\n" + flare_rows);
  EXPECT_EQ(file.lens.surfaces[0].semi_diameter_mm, 6.25);
  ASSERT_EQ(file.notes.size(), 1u);
  expect_mentions(file.notes[0], {"diameters"});
}

TEST(FlareSim, SaysWhatIsWrongAndWhere) {
  expect_mentions(bench_complaint("surfaces:\n51.68 4\n", "sample.lens"), {"2: a surface has"});
  expect_mentions(bench_complaint("surfaces:\n51.68 4 0.5 0 12 1\n", "sample.lens"),
                  {"the index 0.5 is below 1"});
  expect_mentions(bench_complaint("surfaces:\n51.68 4 1.5 60 12 1\n", "sample.lens"), {"has no stop"});
  expect_mentions(bench_complaint("name: none\n", "sample.lens"), {"has no surfaces"});
}

}  // namespace
}  // namespace petzval
