// SPDX-License-Identifier: BSD-3-Clause
// pbrt's tables of rows.
#include "sample_lenses.h"
#include "scratch_file.h"

#include <petzval/lens/first_order.h>

namespace petzval {
namespace {

using namespace testing;

constexpr const char* doublet =
    "# a doublet\n"
    "# made for this test\t\t\n"
    "60\t6\t1.5\t20\n"
    "-40 2 1.6 20   # cemented\r\n"
    "\n"
    "-120 3 1 19\n"
    "0 5 0 15\n"
    "500 1.5 1.7 16\n"
    "-500\t0\t1\t16";

std::string pbrt_complaint(std::string_view text) {
  return error_of([&] { read_text("bad.dat", text); });
}

TEST(PbrtReader, ReadsRows) {
  const LensFile file = read_text("doublet.dat", doublet);
  const Lens& lens = file.lens;
  EXPECT_EQ(lens.name, "doublet");
  expect_mentions(lens.source, {"a doublet; made for this test; cemented"});
  ASSERT_EQ(lens.surfaces.size(), 6u);
  EXPECT_EQ(lens.surfaces[0].curvature_per_mm, 1 / 60.0);
  EXPECT_EQ(lens.surfaces[0].thickness_mm, 6);
  EXPECT_EQ(lens.surfaces[0].material.index(500), 1.5);  // behind the surface
  EXPECT_EQ(lens.surfaces[0].semi_diameter_mm, 10);      // the file has diameters
  EXPECT_TRUE(lens.surfaces[2].material.is_air());
  EXPECT_EQ(lens.stop_index(), 3u);
  EXPECT_TRUE(is_flat(lens.surfaces[3]));
  EXPECT_TRUE(lens.surfaces[3].material.is_air());
  EXPECT_EQ(lens.aperture.kind, Aperture::Kind::stop_semi_diameter_mm);
  EXPECT_EQ(lens.aperture.value, 7.5);
}

TEST(PbrtReader, PutsAMissingImageAtTheFocusAndSaysSo) {
  const LensFile file = read_text("doublet.dat", doublet);
  EXPECT_EQ(trace_paraxial(file.lens, 1, 0, 587.5618).height_mm.size(), 7u);
  EXPECT_NEAR(trace_paraxial(file.lens, 1, 0, 587.5618).height_mm.back(), 0, 1e-14);
  ASSERT_EQ(file.notes.size(), 1u);
  expect_mentions(file.notes[0], {"paraxial focus"});
  std::string with_distance = doublet;
  with_distance.replace(with_distance.rfind("\t0\t"), 3, "\t80.5\t");
  EXPECT_EQ(read_text("doublet.dat", with_distance).lens.surfaces.back().thickness_mm, 80.5);
  EXPECT_TRUE(read_text("doublet.dat", with_distance).notes.empty());
}

TEST(PbrtReader, PassesOverAStatedFocalLength) {
  const LensFile plain = read_text("doublet.dat", doublet);
  const LensFile file = read_text("doublet.dat", "100.5\n" + std::string(doublet));
  expect_same_optics(file.lens, plain.lens);
  expect_mentions(file.notes.back(), {"100.5"});
}

TEST(PbrtReader, NamesTheLine) {
  expect_mentions(pbrt_complaint("1 2 1.5 4\n0 1 0 3\n5 6 1\n"), {"bad.dat:3: a row has 4 numbers", "not 3"});
  expect_mentions(pbrt_complaint("1 2 1.5 4 5\n"), {"bad.dat:1: ", "not 5"});
  expect_mentions(pbrt_complaint("1 2 x 4\n"), {"bad.dat:1: \"x\" is not a number"});
  expect_mentions(pbrt_complaint("1 nan 1 4\n"), {"bad.dat:1: \"nan\""});
  expect_mentions(pbrt_complaint("1 2 0 4\n"), {"bad.dat:1: the index 0 is below 1"});
  expect_mentions(pbrt_complaint("1 2 1.5 -4\n"), {"bad.dat:1: the aperture diameter -4 must be positive"});
  expect_mentions(pbrt_complaint("0 1 0 3\n5 6 1 3\n0 1 0 3\n"), {"bad.dat:3: a second stop", "line 1"});
  expect_mentions(pbrt_complaint("1 2 1.5 4\n"), {"no stop"});
  expect_mentions(pbrt_complaint("# nothing\n"), {"holds no lens"});
  expect_mentions(pbrt_complaint("0 1 0 3\n5 0 1 3\n"), {"no focus"});
}

TEST(PbrtWriter, ReadsBackTheSame) {
  for (const char* name : {"dgauss-50mm", "wide-22mm", "telephoto-250mm", "fisheye-10mm", "tessar"}) {
    Lens lens = read_lens(name).lens;
    lens.fields = {};
    expect_same_optics(through_file(lens, "lens.dat"), lens);
  }
}

TEST(PbrtWriter, RefusesWhatARowCannotSay) {
  const Lens lens = read_text("doublet.dat", doublet).lens;
  const auto refusal = [&](const std::string& setting) {
    return error_of([&] { through_file(with_setting(lens, setting), "out.dat"); });
  };
  expect_mentions(refusal("surfaces[1].glass=SCHOTT:N-BK7"), {"out.dat: surfaces[1]", "dispersion"});
  expect_mentions(refusal("surfaces[1].conic=1"), {"surfaces[1]", "conic"});
  expect_mentions(refusal("surfaces[1].asphere.4=1"), {"surfaces[1]", "asphere"});
  expect_mentions(refusal("surfaces[0].semi_diameter_mm=null"), {"surfaces[0]", "clear aperture"});
  expect_mentions(refusal("surfaces[0].radius_mm=null"), {"surfaces[0]", "flat"});
  expect_mentions(refusal("surfaces[1].stop=true"), {"surfaces[1]", "stop"});
  expect_mentions(refusal("aperture.f_number=4"), {"aperture.stop_semi_diameter_mm=7.5"});
  expect_mentions(refusal("object_distance_mm=100"), {"object_distance_mm"});
  expect_mentions(refusal("surfaces[5].thickness_mm=0"), {"surfaces[5]", "image"});
}

}  // namespace
}  // namespace petzval
