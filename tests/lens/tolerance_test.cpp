// SPDX-License-Identifier: BSD-3-Clause
// What each kind of tolerance does to a lens, against its definition; names of other programs; mistakes.
#include <fmt/format.h>
#include <petzval/base/units.h>
#include <petzval/lens/pose.h>
#include <petzval/lens/surface_shape.h>
#include <petzval/lens/tolerance.h>

#include <set>

#include "sample_lenses.h"

namespace petzval {
namespace {

using namespace testing;

Lens triplet_of_tolerances() {
  return read_lens("cooke-triplet").lens;
}

Lens off(const std::string& tolerance, double x, double y = 0) {
  return with_error(triplet_of_tolerances(), parse_tolerance(tolerance), x, y);
}

double radius(const Lens& lens, std::size_t surface) {
  return 1 / lens.surfaces[surface].curvature_per_mm;
}

TEST(Tolerance, RadiusByPercentAndMillimetre) {
  const double r = radius(triplet_of_tolerances(), 2);
  EXPECT_NEAR(radius(off("radius_percent@2=0.1", 0.1), 2), r * 1.001, 1e-12);
  EXPECT_NEAR(radius(off("radius_mm@2=0.1", -0.05), 2), r - 0.05, 1e-12);
}

TEST(Tolerance, FringesAreCountedAtTheRim) {
  // Two fringes of power in reflection are one wavelength of sag between test plate and surface at the rim.
  // The spheres' own sags differ from the parabolas' by (h/r)² of it, here 6 %.
  const Lens designed = triplet_of_tolerances(), built = off("radius_fringes@0=3", 2);
  const double h = *designed.surfaces[0].semi_diameter_mm;
  const auto sag = [&](const Lens& lens) {
    const double r = radius(lens, 0);
    return h * h / (r * (1 + std::sqrt(1 - h * h / (r * r))));
  };
  const double exact = sag(built) - sag(designed), steepness = std::pow(h / radius(designed, 0), 2);
  EXPECT_NEAR(exact / 546.07e-6, 1, 2 * steepness);
  EXPECT_GT(exact, 0);
}

/// From the definition: heights of the surface itself at its rim.
double sag_at(const Lens& lens, std::size_t surface, double azimuth) {
  const double rim = *lens.surfaces[surface].semi_diameter_mm;
  return surface_point(shape_of(lens.surfaces[surface]), rim * std::cos(azimuth), rim * std::sin(azimuth))
      .sag;
}

TEST(Tolerance, IrregularityIsSagFromPeakToValley) {
  constexpr double fringe_mm = 546.07e-6 / 2;
  std::vector<Lens> lenses(4, triplet_of_tolerances());
  lenses[1].surfaces[2].asphere = {{2, 1e-4}, {4, -3e-6}, {8, 1e-9}};
  lenses[2].surfaces[2].shape = {
      "zernike_sag", {{"normalisation_radius_mm", {9.0}}, {"coefficients_mm", {0, 1e-3, 0, 0, 2e-4}}}};
  lenses[3].surfaces[2].shape = {
      "xy_polynomial", {{"normalisation_radius_mm", {11.0}}, {"coefficients_mm", {1e-3, 0, 0, 2e-3}}}};
  const Tolerance tolerance = parse_tolerance("irregularity_fringes@2=2");
  for (const Lens& lens : lenses)
    for (const double turn : {0.0, 45.0, 90.0, 135.0}) {
      // An error of 2 fringes whose peak lies at an azimuth; opposite errors have peak and valley exchanged.
      const double twice = radians(2 * turn);
      const Lens built = with_error(lens, tolerance, 2 * std::cos(twice), 2 * std::sin(twice));
      const auto change = [&](double azimuth_deg) {
        return sag_at(built, 2, radians(azimuth_deg)) - sag_at(lens, 2, radians(azimuth_deg));
      };
      EXPECT_NEAR(change(turn) - change(turn + 90), 2 * fringe_mm, 1e-9 * fringe_mm);
      EXPECT_NEAR(change(turn) + change(turn + 90), 0, 1e-9 * fringe_mm);
      EXPECT_NEAR(change(turn + 45), 0, 1e-9 * fringe_mm);
      EXPECT_NEAR(change(turn + 180), change(turn), 1e-9 * fringe_mm);
    }
}

TEST(Tolerance, ReadsDrawingsOfIso10110) {
  const auto text_of = [](const char* text) {
    std::string all;
    for (const Tolerance& each : parse_tolerances(text))
      all += fmt::format("{}={:.6g} ", place_of(each), each.limit);
    return all;
  };
  EXPECT_EQ(text_of("3/2(0.5)@4"), "radius_fringes@4=2 irregularity_fringes@4=0.5 ");
  EXPECT_EQ(text_of("3/-(0.5)@4"), "irregularity_fringes@4=0.5 ");
  EXPECT_EQ(text_of("3/3@0"), "radius_fringes@0=3 ");
  EXPECT_EQ(text_of("4/3'@1"), "surface_tilt_deg@1=0.05 ");
  EXPECT_EQ(text_of("4/6@1"), "surface_tilt_deg@1=0.1 ");
  EXPECT_EQ(text_of("index@0=0.001"), "index@0=0.001 ");
  for (const char* text :
       {"3/", "4/", "3/@1", "3/-@1", "3/2(1@1", "3/2(1/0.5)@1", "3/2(1)@x", "4/x@1", "3/2(1)"})
    expect_mentions(error_of([&] { parse_tolerances(text); }), {"ISO 10110", "4/TILT"});
}

TEST(Tolerance, ThicknessMovesWhatLiesBehind) {
  EXPECT_DOUBLE_EQ(off("thickness_mm@1=0.1", 0.07).surfaces[1].thickness_mm,
                   triplet_of_tolerances().surfaces[1].thickness_mm + 0.07);
}

TEST(Tolerance, GlassComesOutAsItsMelt) {
  const Material before = triplet_of_tolerances().surfaces[0].material;
  const auto vd = [](const Material& m) {
    return (m.index(587.5618) - 1) / (m.index(486.1327) - m.index(656.2725));
  };
  const Material index = off("index@0=0.001", 5e-4).surfaces[0].material;
  EXPECT_NEAR(index.index(587.5618), before.index(587.5618) + 5e-4, 1e-15);
  EXPECT_NEAR(vd(index), vd(before), 1e-9);
  const Material abbe = off("abbe_percent@0=1", -0.5).surfaces[0].material;
  EXPECT_NEAR(abbe.index(587.5618), before.index(587.5618), 1e-15);
  EXPECT_NEAR(vd(abbe) / vd(before), 0.995, 1e-9);
  Lens both = with_error(off("index@0=0.001", 5e-4), parse_tolerance("abbe_percent@0=1"), -0.5);
  EXPECT_NEAR(both.surfaces[0].material.index(587.5618), before.index(587.5618) + 5e-4, 1e-15);
  EXPECT_NEAR(vd(both.surfaces[0].material) / vd(before), 0.995, 1e-9);
}

TEST(Tolerance, TiltsAndDecentresMoveWhatTheyName) {
  const std::vector<Frame> element = frames_of(off("element_decentre_mm@2-3=0.1", 0.03, -0.04));
  EXPECT_TRUE(element[1].is_none());
  EXPECT_EQ(element[2].offset_mm, (Frame::Vector{0.03, -0.04, 0}));
  EXPECT_EQ(element[3].offset_mm, (Frame::Vector{0.03, -0.04, 0}));
  EXPECT_TRUE(element[4].is_none());
  const Lens tilted = off("element_tilt_deg@2-3=0.1", 0.1);
  const double gap = tilted.surfaces[2].thickness_mm;
  EXPECT_NEAR(frames_of(tilted)[3].offset_mm[1], -gap * std::sin(radians(0.1)), 1e-15);
  EXPECT_EQ(off("surface_decentre_mm@1=0.1", 0.03, 0.04).surfaces[1].pose.decentre_y_mm, 0.04);
  EXPECT_EQ(off("surface_tilt_deg@1=0.1", 0.03, 0.04).surfaces[1].pose.tilt_y_deg, 0.04);
  EXPECT_EQ(off("sensor_tilt_deg@0=0.1", 0.03).sensor_pose.tilt_x_deg, 0.03);
}

TEST(Tolerance, RunoutIsTheSwingOfADialAtTheRim) {
  const Lens built = off("runout_mm@1=0.05", 0.02);
  const double rim = *built.surfaces[1].semi_diameter_mm;
  const Frame frame = frames_of(built)[1];
  const double swing = frame.to_lens({0, rim, 0})[2] - frame.to_lens({0, -rim, 0})[2];
  EXPECT_NEAR(swing, 0.02, 1e-6 * 0.02);
}

TEST(Tolerance, KnowsTheNamesOfOtherPrograms) {
  for (const auto& [theirs, ours] : {std::pair{"TRAD", "radius_mm"},
                                     {"TFRN", "radius_fringes"},
                                     {"DLF", "radius_fringes"},
                                     {"IRR", "irregularity_fringes"},
                                     {"TTHI", "thickness_mm"},
                                     {"DLT", "thickness_mm"},
                                     {"TIND", "index"},
                                     {"TSDX", "surface_decentre_mm"},
                                     {"TETY", "element_tilt_deg"},
                                     {"TEDX", "element_decentre_mm"},
                                     {"TIR", "runout_mm"}})
    EXPECT_EQ(parse_tolerance(std::string(theirs) + "@1=0.1").kind, ours);
  std::set<std::string> names;
  for (const ToleranceKind& kind : tolerance_kinds()) {
    EXPECT_TRUE(names.insert(kind.name).second);
    EXPECT_EQ(find_tolerance_kind(kind.name), &kind);
  }
  EXPECT_EQ(find_tolerance_kind("TXYZ"), nullptr);
}

TEST(Tolerance, GradesCoverTheWholeLens) {
  // Three single lenses: each two radii, two wedges, two irregularities, a thickness, nd, Vd, decentre, tilt;
  // two gaps of air (the gap before the stop is no lens's); tighter from grade to grade.
  const Lens lens = triplet_of_tolerances();
  const auto total = [&](const char* grade) {
    double sum = 0;
    for (const Tolerance& tolerance : graded_tolerances(lens, grade)) sum += tolerance.limit;
    return sum;
  };
  const std::vector<std::pair<std::size_t, std::size_t>> elements = elements_of(lens);
  ASSERT_EQ(elements.size(), 3u);
  const std::vector<Tolerance> tolerances = graded_tolerances(lens, "precision");
  EXPECT_EQ(tolerances.size(), 3 * 11 + 2u);
  for (const Tolerance& tolerance : tolerances) EXPECT_NO_THROW(check(lens, tolerance));
  EXPECT_LT(total("high"), total("precision"));
  EXPECT_LT(total("precision"), total("commercial"));
  expect_mentions(error_of([&] { graded_tolerances(lens, "best"); }), {"best", "commercial", "high"});
}

TEST(Tolerance, CementedLensesAreOneElement) {
  const Lens gauss = read_lens("double-gauss").lens;
  for (const auto& [first, last] : elements_of(gauss)) {
    EXPECT_TRUE(gauss.surfaces[last].material.is_air());
    for (std::size_t i = first; i < last; ++i) EXPECT_FALSE(gauss.surfaces[i].material.is_air());
  }
  EXPECT_EQ(elements_of(gauss).size(), 4u);
}

TEST(Tolerance, SaysWhatWouldBeRight) {
  const auto complaint = [](const std::string& text) {
    return error_of([&] { check(triplet_of_tolerances(), parse_tolerance(text)); });
  };
  for (const char* text : {"", "radius_percent", "radius_percent@2", "radius_percent@=1", "=@",
                           "@=", "radius_percent=1@2", "radius_percent@2=x", "radius_percent@-1=1",
                           "radius_percent@1-=1", "radius_percent@1.5=1", "radius_percent@2=nan"})
    expect_mentions(error_of([&] { parse_tolerance(text); }), {"radius_percent@2=0.1"});
  expect_mentions(complaint("wobble@2=1"), {"wobble", "element_tilt_deg"});
  expect_mentions(complaint("radius_percent@99=1"), {"radius_percent@99", "no such surface"});
  expect_mentions(complaint("radius_percent@0-1=1"), {"one surface"});
  expect_mentions(complaint("radius_percent@0=0"), {"positive number of %"});
  expect_mentions(complaint("radius_percent@0=-1"), {"positive number of %"});
  Lens odd = triplet_of_tolerances();
  odd.surfaces[2].asphere = {{3, 1e-6}};
  expect_mentions(error_of([&] { check(odd, parse_tolerance("IRR@2=1")); }), {"surfaces[2]", "odd powers"});
  expect_mentions(complaint("index@1=0.001"), {"surfaces[1]", "air"});
  Lens lens = triplet_of_tolerances();
  lens.surfaces[0].semi_diameter_mm.reset();
  expect_mentions(error_of([&] { check(lens, parse_tolerance("runout_mm@0=1")); }), {"semi_diameter_mm"});
}

TEST(Tolerance, FilesNameTheirMistakes) {
  const auto complaint = [](const std::string& json) {
    return error_of([&] { with_setting(triplet_of_tolerances(), "tolerances=" + json); });
  };
  EXPECT_EQ(
      with_setting(triplet_of_tolerances(), R"(tolerances=[{"kind": "TTHI", "surfaces": [1], "limit": 0.1}])")
          .tolerances[0]
          .kind,
      "thickness_mm");
  expect_mentions(complaint(R"([{"kind": "wobble", "surfaces": [1], "limit": 0.1}])"),
                  {"tolerances[0].kind", "wobble"});
  expect_mentions(complaint(R"([{"kind": "index", "surfaces": [1], "limit": 0.1}])"),
                  {"tolerances[0]", "air"});
  expect_mentions(complaint(R"([{"kind": "index", "surfaces": [], "limit": 0.1}])"),
                  {"tolerances[0].surfaces"});
  expect_mentions(complaint(R"([{"kind": "index", "surfaces": [0]}])"), {"tolerances[0]", "limit"});
  expect_mentions(complaint(R"([{"kind": "index", "surfaces": [0], "limit": 0}])"),
                  {"tolerances[0]", "positive"});
}

}  // namespace
}  // namespace petzval
