// SPDX-License-Identifier: BSD-3-Clause
// --set: a path into the native form, and a value.
#include "random_lens.h"
#include "sample_lenses.h"

namespace petzval {
namespace {

using namespace testing;

Lens triplet() {
  return read_lens("cooke-triplet").lens;
}

Lens set(const std::string& assignment) {
  return with_setting(triplet(), assignment);
}

std::string setting_complaint(const std::string& assignment) {
  return error_of([&] { set(assignment); });
}

TEST(Setting, ChangesOneNumberAndNothingElse) {
  Lens expected = triplet();
  expected.surfaces[4].thickness_mm = 0.5;
  expect_same_lens(set("surfaces[4].thickness_mm=0.5"), expected);
  expected = triplet();
  expected.surfaces[0].curvature_per_mm = 1 / 25.0;
  expect_same_lens(set("surfaces[0].radius_mm=25"), expected);
}

TEST(Setting, OtherCurvaturesStayToTheLastBit) {
  RandomLens random(4);
  for (int i = 0; i < 50; ++i) {
    Lens lens = random();
    const Lens altered = with_setting(lens, "surfaces[0].thickness_mm=7");
    lens.surfaces[0].thickness_mm = 7;
    expect_same_lens(altered, lens);
    lens.surfaces[0].curvature_per_mm = 1 / 3.0;
    expect_same_lens(with_setting(altered, "surfaces[0].radius_mm=3"), lens);
  }
}

TEST(Setting, ReachesEntriesThatWereAbsent) {
  EXPECT_EQ(set("surfaces[1].conic=-1").surfaces[1].conic, -1);
  EXPECT_EQ(set("surfaces[1].asphere.4=1e-6").surfaces[1].asphere, (std::map<int, double>{{4, 1e-6}}));
  EXPECT_EQ(set("object_distance_mm=300").object_distance_mm, 300);
  EXPECT_FALSE(with_setting(set("object_distance_mm=300"), "object_distance_mm=null").object_distance_mm);
  EXPECT_EQ(set("source=somewhere else").source, "somewhere else");
}

TEST(Setting, ReplacesTheKindOfAperture) {
  const Lens lens = set("aperture.f_number=2.8");
  EXPECT_EQ(lens.aperture.kind, Aperture::Kind::f_number);
  EXPECT_EQ(lens.aperture.value, 2.8);
  EXPECT_EQ(set("aperture={\"image_na\": 0.2}").aperture.kind, Aperture::Kind::image_na);
}

TEST(Setting, ReplacesGlass) {
  EXPECT_EQ(set("surfaces[0].glass=SCHOTT:N-BK7").surfaces[0].material.description(), "SCHOTT:N-BK7");
  EXPECT_EQ(set("surfaces[0].glass={\"nd\": 1.6, \"vd\": 60}").surfaces[0].material.description(),
            "nd 1.6 Vd 60");
  const Lens constant = set("surfaces[0].glass.index=1.7");
  EXPECT_EQ(constant.surfaces[0].material.index(500), 1.7);
  EXPECT_EQ(set("surfaces[1].glass.index_table={\"486.1\": 1.6}").surfaces[1].material.index(486.1), 1.6);
  const Lens model =
      with_setting(set("surfaces[0].glass={\"nd\": 1.6, \"vd\": 60}"), "surfaces[0].glass.vd=40");
  EXPECT_EQ(std::get<Material::Model>(model.surfaces[0].material.kind()).nd, 1.6);
  EXPECT_EQ(std::get<Material::Model>(model.surfaces[0].material.kind()).vd, 40);
  EXPECT_TRUE(set("surfaces[0].glass=air").surfaces[0].material.is_air());
  EXPECT_TRUE(set("surfaces[0].glass=null").surfaces[0].material.is_air());
}

TEST(Setting, TakesEntriesAway) {
  EXPECT_FALSE(set("surfaces[0].semi_diameter_mm=null").surfaces[0].semi_diameter_mm);
  EXPECT_TRUE(is_flat(set("surfaces[0].radius_mm=null").surfaces[0]));
}

TEST(Setting, MovesTheStop) {
  EXPECT_EQ(triplet().stop_index(), 3u);
  EXPECT_EQ(set("surfaces[2].stop=true").stop_index(), 2u);
  EXPECT_EQ(set("surfaces[3].stop=true").stop_index(), 3u);
}

TEST(Setting, ReachesLists) {
  EXPECT_EQ(set("fields.values=[0, 10]").fields.values, (std::vector<double>{0, 10}));
  EXPECT_EQ(set("fields.values[4]=18.5").fields.values.back(), 18.5);
  EXPECT_EQ(set("wavelengths_nm[0]=450").wavelengths_nm[0], 450);
  EXPECT_EQ(set("reference_wavelength_nm=500").reference_wavelength_nm, 500);
}

TEST(Setting, SaysWhatWouldBeRight) {
  expect_mentions(setting_complaint("surfaces[4].thicknes_mm=1"),
                  {"`set` surfaces[4].thicknes_mm=1: ", "thickness_mm"});
  expect_mentions(setting_complaint("surfaces[6].conic=1"), {"surfaces[6] is not there", "0 to 5"});
  expect_mentions(setting_complaint("surfaces[99999999999].conic=1"), {"is not a path"});
  expect_mentions(setting_complaint("fields.values[5]=1"), {"fields.values[5] is not there", "0 to 4"});
  expect_mentions(setting_complaint("apertur.f_number=1"), {"apertur is not a key", "aperture"});
  expect_mentions(setting_complaint("aperture.f_stop=1"), {"aperture.f_stop", "f_number"});
  expect_mentions(setting_complaint("surfaces[0].thickness_mm=wide"),
                  {"surfaces[0].thickness_mm must be a distance in mm, not a text"});
  expect_mentions(setting_complaint("surfaces[0].thickness_mm="), {"surfaces[0].thickness_mm must be"});
  expect_mentions(setting_complaint("surfaces[0].glass=N-BK77"), {"surfaces[0].glass", "N-BK7"});
  expect_mentions(setting_complaint("surfaces[3].stop=false"), {"no stop"});
  expect_mentions(setting_complaint("name.x=1"), {"name has no entries"});
  expect_mentions(setting_complaint("name[0]=1"), {"name is not a list"});
  expect_mentions(setting_complaint("surfaces[0]"), {"no value"});
  expect_mentions(setting_complaint("reference_wavelength_nm=null"), {"reference_wavelength_nm must be"});
  for (const char* path : {"=1", ".=1", "a..b=1", "[0]=1", "surfaces[=1", "surfaces[]=1", "surfaces[-1]=1",
                           "surfaces[0]x=1", "a.=1"})
    expect_mentions(setting_complaint(path), {"is not a path", "surfaces[4].thickness_mm"});
}

TEST(Setting, HostileValues) {
  setting_complaint("surfaces=" + std::string(100'000, '['));
  setting_complaint("surfaces[0].glass=" + std::string(100'000, 'x'));
  setting_complaint("surfaces=[]");
  setting_complaint("surfaces[0]=null");
  setting_complaint("format=petzval-lens/2");
  setting_complaint("surfaces[0].radius_mm=1e-320");
}

}  // namespace
}  // namespace petzval
