// SPDX-License-Identifier: BSD-3-Clause
// The native format: every number survives, and nothing is forgiven.
#include "random_lens.h"
#include "sample_lenses.h"

#include <petzval/base/number_text.h>

#include <algorithm>
#include <cmath>

namespace petzval {
namespace {

using namespace testing;

constexpr const char* native_example = R"({
  "format": "petzval-lens/1", "name": "example", "source": "this test",
  "object_distance_mm": null,
  "aperture": {"f_number": 1.8},
  "fields": {"type": "angle_deg", "values": [0, 14, 20]},
  "wavelengths_nm": [486.13, 587.56, 656.27], "reference_wavelength_nm": 587.56,
  "surfaces": [
    {"radius_mm": 29.475, "thickness_mm": 3.76, "glass": "SCHOTT:N-BAF10", "semi_diameter_mm": 12.6,
     "conic": 0.5, "asphere": {"4": 1.2e-6, "6": -3.0e-9}},
    {"radius_mm": null, "thickness_mm": 4.5, "stop": true, "semi_diameter_mm": 8.55},
    {"radius_mm": -20, "thickness_mm": 2, "glass": {"nd": 1.6, "vd": 50}},
    {"radius_mm": -30, "thickness_mm": 2, "glass": {"index": 1.7}},
    {"radius_mm": -40, "thickness_mm": 2, "glass": {"index_table": {"700": 1.5, "486.13": 1.6, "600": 1.55}}},
    {"radius_mm": -50, "thickness_mm": 30}
  ]
})";

/// The example with its first `before` changed to `after`.
std::string native_changed(const std::string& before, const std::string& after) {
  return with_change(native_example, before, after);
}

std::string native_complaint(const std::string& text) {
  return error_of([&] { lens_from_json(text, "file.json"); });
}

TEST(NativeReader, KeepsCoatingsOfEveryKind) {
  const std::string bare = R"("semi_diameter_mm": 12.6,)";
  for (const char* text :
       {R"("mgf2")", "0.005", "[[400, 0.03], [600, 0.01]]",
        R"({"name": "two films", "source": "this test", "layers": [{"index": 1.38, "thickness_nm": 99.5},
            {"material": "SCHOTT:N-SF66", "thickness_nm": 30.25}]})",
        R"({"name": "measured", "wavelengths_nm": [500, 600], "angles_deg": [0, 30, 60],
            "reflectance": [[0.01, 0.012, 0.05], [0.02, 0.022, 0.06]]})"}) {
    const Lens lens = lens_from_json(native_changed(bare, bare + " \"coating\": " + text + ","), "file.json");
    const Lens again = lens_from_json(lens_to_json(lens), "again.json");
    ASSERT_TRUE(lens.surfaces[0].coating && again.surfaces[0].coating) << text;
    const Coating &a = *lens.surfaces[0].coating, &b = *again.surfaces[0].coating;
    EXPECT_EQ(a.table, b.table);
    EXPECT_EQ(a.by_angle, b.by_angle);
    EXPECT_EQ(a.angles_deg, b.angles_deg);
    EXPECT_EQ(a.bundled, b.bundled);
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.reflectance(587.56, 1, 1.67), b.reflectance(587.56, 1, 1.67)) << text;
    EXPECT_FALSE(again.surfaces[1].coating);
  }
  // A quarter wave on glass of index n reflects ((n − 1.38²)/(n + 1.38²))² at its wavelength.
  const Coating film =
      *lens_from_json(native_changed(bare, bare + R"( "coating": "mgf2",)"), "file.json").surfaces[0].coating;
  const double square = 1.38 * 1.38;
  EXPECT_NEAR(film.reflectance(550, 1, 1.67), std::pow((1.67 - square) / (1.67 + square), 2), 1e-12);
}

TEST(NativeReader, RefusesCoatingsThatCannotBe) {
  const auto complaint = [](const std::string& coating) {
    const std::string bare = R"("semi_diameter_mm": 12.6,)";
    return native_complaint(native_changed(bare, bare + " \"coating\": " + coating + ","));
  };
  EXPECT_NE(complaint(R"("/etc/passwd")").find("is no bundled coating; these are: broadband-8, mgf2"),
            std::string::npos);
  EXPECT_NE(complaint("1.5").find("surfaces[0].coating"), std::string::npos);
  EXPECT_NE(complaint("[[500, 0.1], [400, 0.1]]").find("must increase"), std::string::npos);
  EXPECT_NE(complaint("[]").find("no reflectance"), std::string::npos);
  EXPECT_NE(complaint("true").find("surfaces[0].coating"), std::string::npos);
  // Films between two glasses: surface 3 of the example.
  EXPECT_NE(
      native_complaint(native_changed(R"("radius_mm": -30,)", R"("radius_mm": -30, "coating": "mgf2",)"))
          .find("lie between air and glass"),
      std::string::npos);
}

TEST(NativeReader, ReadsEveryEntry) {
  const Lens lens = lens_from_json(native_example, "file.json");
  EXPECT_EQ(lens.name, "example");
  EXPECT_EQ(lens.source, "this test");
  EXPECT_FALSE(lens.object_distance_mm);
  EXPECT_EQ(lens.aperture.kind, Aperture::Kind::f_number);
  EXPECT_EQ(lens.aperture.value, 1.8);
  EXPECT_EQ(lens.fields.values, (std::vector<double>{0, 14, 20}));
  EXPECT_EQ(lens.wavelengths_nm, (std::vector<double>{486.13, 587.56, 656.27}));
  EXPECT_EQ(lens.reference_wavelength_nm, 587.56);
  ASSERT_EQ(lens.surfaces.size(), 6u);
  const Surface& first = lens.surfaces[0];
  EXPECT_EQ(first.curvature_per_mm, 1 / 29.475);
  EXPECT_EQ(first.thickness_mm, 3.76);
  EXPECT_EQ(first.material.description(), "SCHOTT:N-BAF10");
  EXPECT_EQ(first.semi_diameter_mm, 12.6);
  EXPECT_EQ(first.conic, 0.5);
  EXPECT_EQ(first.asphere, (std::map<int, double>{{4, 1.2e-6}, {6, -3e-9}}));
  EXPECT_EQ(lens.stop_index(), 1u);
  EXPECT_TRUE(is_flat(lens.surfaces[1]));
  EXPECT_TRUE(lens.surfaces[1].material.is_air());
  EXPECT_EQ(std::get<Material::Model>(lens.surfaces[2].material.kind()).vd, 50);
  EXPECT_EQ(lens.surfaces[3].material.index(500), 1.7);
  EXPECT_EQ(lens.surfaces[4].material.index(600), 1.55);
  EXPECT_EQ(lens.total_track_mm(), 3.76 + 4.5 + 2 + 2 + 2 + 30);
}

TEST(NativeReader, StopsMayHaveBlades) {
  const std::string text =
      native_changed("\"stop\": true,", R"("stop": true, "blades": {"count": 7, "rotation_deg": 12.5},)");
  const Lens lens = lens_from_json(text, "file.json");
  EXPECT_EQ(lens.stop_blades().count, 7);
  EXPECT_EQ(lens.stop_blades().rotation_deg, 12.5);
  const Lens again = lens_from_json(lens_to_json(lens), "again.json");
  EXPECT_EQ(again.stop_blades().count, 7);
  EXPECT_EQ(again.stop_blades().rotation_deg, 12.5);
  const auto blades = [&](const std::string& value) {
    return native_complaint(native_changed("\"stop\": true,", "\"stop\": true, \"blades\": " + value + ","));
  };
  expect_mentions(blades("{\"count\": 2}"), {"file.json:10", "surfaces[1].blades.count", "3 to 64"});
  expect_mentions(blades("{\"count\": 5.5}"), {"surfaces[1].blades.count", "whole number"});
  expect_mentions(blades("{\"count\": 1e300}"), {"surfaces[1].blades.count", "whole number"});
  expect_mentions(blades("{\"rotation_deg\": 5}"), {"surfaces[1].blades", "count"});
  expect_mentions(blades("{\"count\": 5, \"shape\": 5}"), {"shape"});
  expect_mentions(
      native_complaint(native_changed("\"conic\": 0.5,", "\"conic\": 0.5, \"blades\": {\"count\": 5},")),
      {"surfaces[0].blades", "stop"});
  EXPECT_EQ(
      lens_from_json(native_changed("\"stop\": true,", "\"stop\": true, \"blades\": null,"), "file.json")
          .stop_blades()
          .count,
      0);
}

TEST(NativeReader, NamesFileLineAndPath) {
  expect_mentions(native_complaint(native_changed("\"conic\"", "\"conik\"")),
                  {"file.json:9: surfaces[0].conik ", "conic"});
  expect_mentions(native_complaint(native_changed("4.5, \"stop\"", "\"4.5\", \"stop\"")),
                  {"file.json:10: surfaces[1].thickness_mm must be a distance in mm, not a text"});
  expect_mentions(native_complaint(native_changed("-20, \"thickness_mm\": 2, ", "-20, ")),
                  {"file.json:11: surfaces[2] has no \"thickness_mm\""});
  expect_mentions(native_complaint(native_changed("N-BAF10", "N-BAF11")),
                  {"file.json:8: surfaces[0].glass", "N-BAF10"});
  expect_mentions(native_complaint(native_changed("1.2e-6", "null")),
                  {"file.json:9: surfaces[0].asphere.4 must be"});
  expect_mentions(native_complaint(native_changed("\"4\": 1", "\"four\": 1")),
                  {"file.json:9: surfaces[0].asphere.four"});
  expect_mentions(native_complaint(native_changed("\"4\": 1", "\"0\": 1")),
                  {"surfaces[0].asphere.0 is not a power", "1 to 40"});
  expect_mentions(native_complaint(native_changed("12.6", "-12.6")),
                  {"file.json:8: surfaces[0].semi_diameter_mm must be positive"});
  expect_mentions(native_complaint(native_changed("29.475", "0")),
                  {"file.json:8: surfaces[0].radius_mm", "null"});
  expect_mentions(native_complaint(native_changed("\"f_number\": 1.8", "\"f_number\": -1")),
                  {"file.json:4: aperture must be a positive number"});
  expect_mentions(native_complaint(native_changed("\"f_number\": 1.8", "\"f_stop\": 1")),
                  {"file.json:4: aperture.f_stop", "image_na"});
  expect_mentions(native_complaint(native_changed("\"f_number\": 1.8", "\"f_number\": 1, \"image_na\": 1")),
                  {"exactly one"});
  expect_mentions(native_complaint(native_changed("\"angle_deg\"", "\"angle\"")),
                  {"file.json:5: fields.type", "angle_deg"});
  expect_mentions(native_complaint(native_changed("[0, 14, 20]", "[0, 14, true]")),
                  {"file.json:5: fields.values[2] must be"});
  expect_mentions(native_complaint(native_changed("[0, 14, 20]", "[0, 14, 190]")),
                  {"fields.values[2] must be an angle below 180"});
  expect_mentions(native_complaint(native_changed("/1\"", "/2\"")),
                  {"file.json:2: format must be \"petzval-lens/1\""});
  expect_mentions(native_complaint(native_changed("\"stop\": true, ", "")),
                  {"file.json:7: surfaces has no stop"});
  expect_mentions(
      native_complaint(native_changed("\"radius_mm\": -20", "\"stop\": true, \"radius_mm\": -20")),
      {"file.json:11: surfaces[2].stop", "surfaces[1]"});
  expect_mentions(native_complaint(native_changed("\"index\": 1.7", "\"index\": 0.7")),
                  {"file.json:12: surfaces[3].glass"});
  expect_mentions(native_complaint(native_changed("\"index\": 1.7", "\"index\": 1.7, \"nd\": 1.7")),
                  {"surfaces[3].glass.nd"});
  expect_mentions(native_complaint(native_changed("\"vd\": 50", "\"v\": 50")), {"surfaces[2].glass.v "});
  expect_mentions(native_complaint(native_changed("486.13\": 1.6", "blue\": 1.6")),
                  {"surfaces[4].glass.index_table.blue"});
  expect_mentions(native_complaint(native_changed("null,\n", "-5,\n")),
                  {"file.json:3: object_distance_mm must be positive"});
  expect_mentions(native_complaint(native_changed(", \"reference_wavelength_nm\": 587.56", "")),
                  {"no \"reference_wavelength_nm\""});
  expect_mentions(native_complaint(native_changed("587.56,", "-587.56,")),
                  {"file.json:6: wavelengths_nm[1] must be"});
}

TEST(NativeReader, NamesTheLineOfBrokenJson) {
  expect_mentions(native_complaint(native_changed("\"fields\": {", "\"fields\": ")),
                  {"file.json:5: is not JSON"});
  expect_mentions(native_complaint(native_changed("8.55", "1e999")), {"file.json:10: is not JSON", "1e999"});
  expect_mentions(native_complaint(native_changed("8.55", "NaN")), {"file.json:10: is not JSON"});
  expect_mentions(
      native_complaint(native_changed("\"name\": \"example\"", "\"name\": \"a\", \"name\": \"b\"")),
      {"file.json:2: name is there twice"});
}

TEST(NativeReader, ReferenceOfASingleWavelengthIsPlain) {
  const std::string text =
      native_changed("[486.13, 587.56, 656.27], \"reference_wavelength_nm\": 587.56", "[500]");
  EXPECT_EQ(lens_from_json(text, "file.json").reference_wavelength_nm, 500);
}

TEST(NativeReader, SubstitutesOnlyWhatItIsTold) {
  LensReadOptions options;
  options.substitutions = {{"schott:n-baf10", "CDGM:H-LAK10"}};
  EXPECT_EQ(lens_from_json(native_example, "file.json", options).surfaces[0].material.description(),
            "CDGM:H-LAK10");
  options.substitutions = {{"SCHOTT:N-BAF10", "1.61025/56.71"}};
  const Lens model = lens_from_json(native_example, "file.json", options);
  EXPECT_EQ(std::get<Material::Model>(model.surfaces[0].material.kind()).nd, 1.61025);
  options.substitutions = {{"N-BAF10", "CDGM:H-LAK10"}};
  expect_mentions(error_of([&] { lens_from_json(native_example, "file.json", options); }),
                  {"file.json:", "`substitute` N-BAF10", "no such glass", "SCHOTT:N-BAF10"});
}

TEST(NativeWriter, EveryNumberSurvives) {
  RandomLens random(1);
  for (int i = 0; i < 500; ++i) {
    const Lens lens = random();
    const std::string text = lens_to_json(lens);
    const Lens again = lens_from_json(text, "text");
    expect_same_lens(again, lens);
    EXPECT_EQ(lens_to_json(again), text);
    if (::testing::Test::HasFailure()) FAIL() << "lens " << i << ": " << text;
  }
}

TEST(NativeWriter, OneSurfaceALine) {
  const std::string text = lens_to_json(lens_from_json(native_example, "file.json"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 10 + 6 + 2);
  expect_mentions(text, {"{\"radius_mm\": 29.475, \"thickness_mm\": 3.76, \"glass\": \"SCHOTT:N-BAF10\"",
                         "\"asphere\": {\"4\": 1.2e-06, \"6\": -3e-09}"});
}

TEST(NativeWriter, RefusesWhatIsNoLens) {
  Lens lens = lens_from_json(native_example, "file.json");
  lens.surfaces[2].thickness_mm = std::nan("");
  expect_mentions(error_of([&] { lens_to_json(lens); }), {"surfaces[2].thickness_mm"});
}

TEST(NumberText, RadiusGivesItsCurvatureBack) {
  RandomLens random(2);
  int long_texts = 0;
  constexpr int count = 20'000;
  for (int i = 0; i < count; ++i) {
    const double curvature = random.chance(0.5) ? random.magnitude() : -random.magnitude();
    const std::string text = radius_text(curvature);
    ASSERT_EQ(curvature_from_radius(text), curvature) << text;
    const double radius = parse_number(text).value();
    // Whoever reads it as a double is off by no more than the two roundings of a double.
    ASSERT_NEAR(1 / radius / curvature, 1, 4e-16);
    long_texts += 1 / radius != curvature;
  }
  // Spacing of doubles: between 1 and √2 there are more reciprocals than doubles, 1 − √2/2 of them are left
  // out.
  EXPECT_NEAR(long_texts / double{count}, 0.15, 0.05);
}

TEST(NumberText, PublishedRadiiStayShort) {
  for (const char* radius : {"29.475", "-435.76044", "1e+16", "0.001", "4.727", "100000.0"})
    EXPECT_EQ(radius_text(1 / parse_number(radius).value()), radius);
}

TEST(NumberText, NumbersAreWholeAndFinite) {
  EXPECT_EQ(parse_number("+1.5e3"), 1500);
  EXPECT_EQ(parse_number("1."), 1);
  for (const char* text : {"", "+", "1x", "1 ", " 1", "nan", "inf", "1e999", "0x10", "--1", "1,5"})
    EXPECT_FALSE(parse_number(text)) << text;
  EXPECT_EQ(parse_scaled_number("0.5875618", 3), 587.5618);
  EXPECT_EQ(parse_scaled_number("5.875618000000E-001", 3), 587.5618);
  EXPECT_FALSE(parse_scaled_number("1e99999999999", 3));
  EXPECT_EQ(number_text(250), "250.0");
  EXPECT_EQ(number_text(-0.0), "-0.0");
}

TEST(NumberText, ScalingByTenLosesNothing) {
  RandomLens random(3);
  for (int i = 0; i < 1000; ++i) {
    const double wavelength_nm = 300 + 700 * random.uniform();
    EXPECT_EQ(parse_scaled_number(scaled_number_text(wavelength_nm, -3), 3), wavelength_nm);
  }
}

}  // namespace
}  // namespace petzval
