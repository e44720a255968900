// SPDX-License-Identifier: BSD-3-Clause
// Zemax sequential files.
#include "random_lens.h"
#include "sample_lenses.h"
#include "scratch_file.h"

#include <petzval/lens/first_order.h>

#include <algorithm>

namespace petzval {
namespace {

using namespace testing;

constexpr const char* zmx_example =
    "VERS 140124 258 36214\n"
    "MODE SEQ\n"
    "NAME a made-up lens\n"
    "UNIT MM X W X CM MR CPMM\n"
    "FNUM 4.0 0\n"
    "ENVD 20 1 0\n"
    "GCAT SUMITA SCHOTT\n"
    "FTYP 0 0 3 2 0 0 0\n"
    "XFLN 0 0 0 0 0 0 0 0 0 0 0 0\n"
    "YFLN 0 7 10 0 0 0 0 0 0 0 0 0\n"
    "VCYN 0 0 0 0 0 0 0 0 0 0 0 0\n"
    "WAVM 1 4.861327000000E-001 1\n"
    "WAVM 2 0.5875618 1\n"
    "WAVM 3 0.55 1\n"
    "PWAV 2\n"
    "SURF 0\n"
    "  TYPE STANDARD\n"
    "  CURV 0.0 0 0 0 0 \"\"\n"
    "  DISZ INFINITY\n"
    "SURF 1\n"
    "  COMM the \"first\" lens\n"
    "  TYPE EVENASPH\n"
    "  CURV 0.05 0 0 0 0 \"\"\n"
    "  PARM 1 0\n"
    "  PARM 2 1e-6\n"
    "  PARM 8 -3e-20\n"
    "  DISZ 4.5\n"
    "  GLAS F2 0 0 1.5 40 0 0 0 0 0 0\n"
    "  CONI -0.5\n"
    "  DIAM 9 0 0 0 1 \"\"\n"
    "  CLAP 0 8.5 0\n"
    "SURF 2\n"
    "  CURV -0.02\n"
    "  DISZ 3\n"
    "  DIAM 8 1 0 0 1 \"\"\n"
    "SURF 3\n"
    "  STOP\n"
    "  TYPE STANDARD\n"
    "  CURV 0.0\n"
    "  DISZ 2\n"
    "  DIAM 4.25 0 0 0 1 \"\"\n"
    "SURF 4\n"
    "  TYPE ODDASPHE\n"
    "  CURV 0.01\n"
    "  PARM 3 1e-5\n"
    "  DISZ 1.5\n"
    "  GLAS ___BLANK 1 0 1.62 36.5 0 0 0 0 0 0\n"
    "  FLAP 0 7 0\n"
    "SURF 5\n"
    "  TYPE STANDARD\n"
    "  CURV 0\n"
    "  DISZ 30.25\n"
    "  DIAM 7 1\n"
    "SURF 6\n"
    "  TYPE STANDARD\n"
    "  CURV 0.0\n"
    "  DISZ 0\n"
    "  DIAM 5 0\n"
    "EFFL   0   2              0              0\n"
    "TOL TOFF   0   0\n"
    "CURV 1 2 3\n";

std::string zmx_changed(const std::string& before, const std::string& after) {
  return with_change(zmx_example, before, after);
}

LensFile read_zmx_text(const std::string& text, const LensReadOptions& options = {}) {
  return read_text("lens.zmx", text, options);
}

std::string zmx_complaint(const std::string& before, const std::string& after) {
  return error_of([&] { read_zmx_text(zmx_changed(before, after)); });
}

TEST(ZmxReader, ReadsWhatThereIs) {
  const LensFile file = read_zmx_text(zmx_example);
  const Lens& lens = file.lens;
  EXPECT_EQ(lens.name, "a made-up lens");
  EXPECT_FALSE(lens.object_distance_mm);
  EXPECT_EQ(lens.aperture.kind, Aperture::Kind::f_number);
  EXPECT_EQ(lens.aperture.value, 4);
  EXPECT_EQ(lens.fields.kind, Fields::Kind::angle_deg);
  EXPECT_EQ(lens.fields.values, (std::vector<double>{0, 7, 10}));
  EXPECT_EQ(lens.wavelengths_nm, (std::vector<double>{486.1327, 587.5618}));
  EXPECT_EQ(lens.reference_wavelength_nm, 587.5618);
  ASSERT_EQ(lens.surfaces.size(), 5u);
  const Surface& first = lens.surfaces[0];
  EXPECT_EQ(first.curvature_per_mm, 0.05);
  EXPECT_EQ(first.thickness_mm, 4.5);
  EXPECT_EQ(first.conic, -0.5);
  EXPECT_EQ(first.asphere, (std::map<int, double>{{4, 1e-6}, {16, -3e-20}}));
  EXPECT_EQ(first.material.description(), "SCHOTT:F2");
  EXPECT_EQ(first.semi_diameter_mm, 8.5);
  EXPECT_EQ(lens.surfaces[1].semi_diameter_mm, 8);  // fixed by the designer
  EXPECT_FALSE(lens.surfaces[2].semi_diameter_mm);  // automatic: no aperture
  EXPECT_EQ(lens.stop_index(), 2u);
  EXPECT_EQ(lens.surfaces[3].asphere, (std::map<int, double>{{3, 1e-5}}));
  EXPECT_EQ(std::get<Material::Model>(lens.surfaces[3].material.kind()).nd, 1.62);
  EXPECT_EQ(lens.surfaces[3].semi_diameter_mm, 7);
  EXPECT_TRUE(lens.surfaces[4].material.is_air());
  EXPECT_EQ(lens.surfaces[4].thickness_mm, 30.25);
  EXPECT_TRUE(file.notes.empty()) << file.notes.front();
}

/// The same text in the encodings that these files come in.
TEST(ZmxReader, KnowsItsEncodings) {
  const Lens plain = read_zmx_text(zmx_example).lens;
  std::string little = "\xFF\xFE", big = "\xFE\xFF", windows;
  for (const char* c = zmx_example; *c; ++c) {
    little += {*c, '\0'};
    big += {'\0', *c};
    windows += *c == '\n' ? "\r\n" : std::string(1, *c);
  }
  for (const std::string& text :
       {little, big, little.substr(2), big.substr(2), windows, "\xEF\xBB\xBF" + std::string(zmx_example)})
    expect_same_lens(read_zmx_text(text).lens, plain);
  EXPECT_EQ(read_zmx_text(zmx_changed("made-up", "\xE9")).lens.name, "a \xC3\xA9 lens");      // Latin-1
  EXPECT_EQ(read_zmx_text(zmx_changed("made-up", "\xC3\xA9")).lens.name, "a \xC3\xA9 lens");  // UTF-8
}

TEST(ZmxReader, Apertures) {
  using Kind = Aperture::Kind;
  const auto aperture = [](const std::string& line) {
    std::string text = zmx_changed("DISZ INFINITY", "DISZ 100");
    text.replace(text.find("FNUM 4.0 0"), 10, line);
    return read_zmx_text(text).lens.aperture;
  };
  const auto expect = [&](const std::string& line, Kind kind, double value) {
    SCOPED_TRACE(line);
    EXPECT_EQ(aperture(line).kind, kind);
    EXPECT_DOUBLE_EQ(aperture(line).value, value);
  };
  expect("FNUM 1.8 1", Kind::working_f_number, 1.8);
  expect("FNUM 1.8", Kind::f_number, 1.8);
  expect("ENPD 8.25", Kind::entrance_pupil_diameter_mm, 8.25);
  expect("OBNA 0.15 0", Kind::object_na, 0.15);
  expect("OBNA 30 1", Kind::object_na, 0.5);  // half a cone of 30 degrees
  expect("FLOA", Kind::stop_semi_diameter_mm, 4.25);
}

TEST(ZmxReader, UnitsAreLengths) {
  const Lens mm = read_zmx_text(zmx_example).lens,
             inch = read_zmx_text(zmx_changed("UNIT MM", "UNIT IN")).lens;
  EXPECT_DOUBLE_EQ(first_order(inch).efl_mm, 25.4 * first_order(mm).efl_mm);
  EXPECT_DOUBLE_EQ(*inch.surfaces[0].semi_diameter_mm, 25.4 * 8.5);
  EXPECT_DOUBLE_EQ(inch.surfaces[0].asphere.at(4), 1e-6 / (25.4 * 25.4 * 25.4));
  EXPECT_EQ(inch.fields.values, mm.fields.values);  // degrees
  EXPECT_EQ(read_zmx_text(zmx_changed("UNIT MM", "UNIT METER")).lens.surfaces[0].thickness_mm, 4500);
  expect_mentions(zmx_complaint("UNIT MM", "UNIT FURLONG"),
                  {"lens.zmx:4: ", "FURLONG", "MM, CM, IN and METER"});
}

TEST(ZmxReader, Fields) {
  const auto fields = [](const std::string& type, const std::string& x) {
    std::string text = zmx_changed("FTYP 0 0 3 2", "FTYP " + type + " 0 3 2");
    text.replace(text.find("XFLN 0 0 0"), 10, "XFLN " + x);
    return read_zmx_text(text).lens.fields;
  };
  EXPECT_EQ(fields("2", "0 0 0").kind, Fields::Kind::paraxial_image_height_mm);
  EXPECT_EQ(fields("3", "0 0 0").kind, Fields::Kind::real_image_height_mm);
  EXPECT_DOUBLE_EQ(fields("2", "0 24 0").values[1], 25);  // 7, 24, 25
  // Field angles combine by their tangents.
  EXPECT_NEAR(std::tan(fields("0", "0 7 0").values[1] * M_PI / 180), std::sqrt(2) * std::tan(7 * M_PI / 180),
              1e-15);
  expect_mentions(error_of([&] { fields("4", "0 0 0"); }), {"lens.zmx:8: field type 4"});
  expect_mentions(error_of([&] { fields("1", "0 0 0"); }), {"object_height_mm needs an object"});
}

TEST(ZmxReader, OldFilesHaveOldKeywords) {
  std::string text = zmx_changed("FTYP 0 0 3 2 0 0 0", "FTYP 0 0");
  text.replace(text.find("YFLN 0 7 10 0 0 0 0 0 0 0 0 0"), 29, "YFLD 0 7 10");
  text.replace(text.find("XFLN 0 0 0 0 0 0 0 0 0 0 0 0"), 28, "XFLD 0 0 0");
  const std::size_t waves = text.find("WAVM 1"), end = text.find("PWAV");
  text.replace(waves, end - waves, "WAVL 0.4861327 0.5875618\n");
  expect_same_lens(read_zmx_text(text).lens, read_zmx_text(zmx_example).lens);
}

TEST(ZmxReader, GlassNamesFollowTheCatalogueOrder) {
  // CDGM's and HIKARI's F2 are other glasses than SCHOTT's; without a preference the name decides nothing.
  expect_mentions(zmx_complaint("GCAT SUMITA SCHOTT\n", ""),
                  {"lens.zmx:27: SURF 1: ", "F2", "ambiguous", "SCHOTT:F2"});
  EXPECT_NE(read_zmx_text(zmx_changed("GCAT SUMITA SCHOTT", "GCAT HIKARI SCHOTT"))
                .lens.surfaces[0]
                .material.description(),
            "SCHOTT:F2");
  expect_mentions(zmx_complaint("GLAS F2", "GLAS FF22"), {"lens.zmx:28: SURF 1: unknown glass FF22"});
  LensReadOptions options;
  options.substitutions = {{"FF22", "CDGM:H-LAK10"}, {"___BLANK", "SCHOTT:F2"}};
  const Lens lens = read_zmx_text(zmx_changed("GLAS F2", "GLAS FF22"), options).lens;
  EXPECT_EQ(lens.surfaces[0].material.description(), "CDGM:H-LAK10");
  EXPECT_EQ(lens.surfaces[3].material.description(), "SCHOTT:F2");
}

TEST(ZmxReader, ModelGlasses) {
  // Flag 1 says that the numbers count and not the name.
  const LensFile file = read_zmx_text(zmx_changed("GLAS F2 0 0 1.5 40", "GLAS F2 1 0 1.5 40"));
  EXPECT_EQ(std::get<Material::Model>(file.lens.surfaces[0].material.kind()).vd, 40);
  ASSERT_EQ(file.notes.size(), 1u);
  expect_mentions(file.notes[0], {"SURF 1", "F2"});
  const Lens constant = read_zmx_text(zmx_changed("1.62 36.5", "1.62 0")).lens;
  EXPECT_EQ(constant.surfaces[3].material.index(400), 1.62);
  // Off the normal line: P_gF is larger by so much, and nd and Vd stay.
  const Material normal = read_zmx_text(zmx_example).lens.surfaces[3].material;
  const Material off =
      read_zmx_text(zmx_changed("1.62 36.5 0 ", "1.62 36.5 0.01 ")).lens.surfaces[3].material;
  const double g = 435.8343, f = 486.1327, d = 587.5618, c = 656.2725;
  const auto partial = [=](const Material& m) {
    return (m.index(g) - m.index(f)) / (m.index(f) - m.index(c));
  };
  EXPECT_NEAR(partial(off) - partial(normal), 0.01, 1e-12);  // rounding of differences of indices
  EXPECT_NEAR(off.index(d), 1.62, 1e-15);
  EXPECT_NEAR((off.index(d) - 1) / (off.index(f) - off.index(c)), 36.5, 1e-10);
}

TEST(ZmxReader, ExtendedAspheres) {
  // Coefficients of (r/R)², (r/R)⁴ …, R = 2.
  const Lens lens =
      read_zmx_text(zmx_changed("  TYPE EVENASPH\n",
                                "  TYPE XASPHERE\n  XDAT 1 3 0 0 1 0 0 \"\"\n  XDAT 2 2.0 0 0 1\n  XDAT 3 0\n"
                                "  XDAT 4 1.6e-3\n  XDAT 5 -6.4e-4\n  XDAT 6 9\n"))
          .lens;
  ASSERT_EQ(lens.surfaces[0].asphere.size(), 2u);  // term 4 is beyond the number of terms
  EXPECT_DOUBLE_EQ(lens.surfaces[0].asphere.at(4), 1e-4);
  EXPECT_DOUBLE_EQ(lens.surfaces[0].asphere.at(6), -1e-5);
  // Odd ones are of r/R, (r/R)² ….
  EXPECT_EQ(
      read_zmx_text(
          zmx_changed("  TYPE EVENASPH\n",
                      "  TYPE XOSPHERE\n  XDAT 1 11\n  XDAT 2 2.0\n  XDAT 5 8e-3\n  XDAT 13 4.096e-5\n"))
          .lens.surfaces[0]
          .asphere,
      (std::map<int, double>{{3, 1e-3}, {11, 2e-8}}));
  expect_mentions(zmx_complaint("  TYPE EVENASPH\n", "  TYPE XASPHERE\n  XDAT 1 3\n  XDAT 4 1e-3\n"),
                  {"SURF 1: ", "XDAT 2"});
}

TEST(ZmxReader, ReadsTheConfigurationThatIsWrittenOut) {
  const auto notes =
      read_zmx_text(zmx_changed("TOL TOFF", "MNUM 2\nTHIC 1 1 4.5\nTHIC 1 2 5\nTOL TOFF")).notes;
  ASSERT_EQ(notes.size(), 1u);
  expect_mentions(notes[0], {"lens.zmx:60: of 2 configurations"});
  EXPECT_TRUE(read_zmx_text(zmx_changed("TOL TOFF", "MNUM 1 1\nTOL TOFF")).notes.empty());
}

TEST(ZmxReader, RefusesWhatItDoesNotModel) {
  const char* line = "  CONI -0.5\n";
  const auto with = [&](const std::string& record) { return zmx_complaint(line, "  " + record + "\n"); };
  expect_mentions(with("OBSC 1 2"), {"lens.zmx:29: SURF 1: OBSC", "inner radius"});
  expect_mentions(with("SCBD 0 0 0 45"), {"SURF 1: SCBD", "tilted"});
  for (const char* record : {"SPID 1 300", "UDAD 1", "IGNR 1", "NSCO 1"})
    expect_mentions(with(record), {"SURF 1: ", std::string(record, 4).c_str()});
  for (const char* type : {"TOROGRAT", "GRINSUR1", "HOLOGRM1", "USERSURF", ""})
    expect_mentions(zmx_complaint("TYPE EVENASPH", std::string("TYPE ") + type),
                    {"lens.zmx:22: SURF 1: TYPE", type, "EVENASPH"});
  expect_mentions(zmx_complaint("MODE SEQ", "MODE NSC"), {"lens.zmx:2: MODE NSC"});
  expect_mentions(zmx_complaint("ENVD 20 1 0", "ENVD 40 1 1"), {"lens.zmx:6: ", "temperature"});
  expect_mentions(zmx_complaint("ENVD 20 1 0", "PFIL 1 0 0"), {"lens.zmx:6: PFIL"});
  expect_mentions(zmx_complaint("PARM 8", "PARM 9"), {"lens.zmx:26: SURF 1: PARM 9"});
  expect_mentions(zmx_complaint("  CURV 0.0\n  DISZ 0\n", "  CURV 0.1\n  DISZ 0\n"),
                  {"SURF 6: a curved image"});
  expect_mentions(zmx_complaint("DISZ 4.5", "DISZ INFINITY"), {"SURF 1: only the object"});
  expect_mentions(zmx_complaint("TYPE EVENASPH", "TYPE PARAXIAL"), {"SURF 1: a PARAXIAL", "focal length"});
  EXPECT_NO_THROW(read_zmx_text(zmx_changed(line, "  OBDC 0 0\n  SCBD 0 0 0 0\n")));
  EXPECT_NO_THROW(read_zmx_text(zmx_changed("ENVD 20 1 0", "ENVD 40 1 0")));
}

TEST(ZmxReader, NotesWhatItPassesOver) {
  const auto note = [](const std::string& before, const std::string& after) {
    const auto notes = read_zmx_text(zmx_changed(before, after)).notes;
    EXPECT_EQ(notes.size(), 1u);
    return notes.empty() ? "" : notes[0];
  };
  expect_mentions(note("VCYN 0 0 0", "VCYN 0 0 0.1"), {"vignetting factors"});
  expect_mentions(note("FTYP 0 0", "FTYP 0 1"), {"telecentric"});
  expect_mentions(note("ENVD 20 1 0", "WXYZ 1\nABCD"), {"ABCD, WXYZ"});
  expect_mentions(note("  DIAM 8 1 0 0 1 \"\"\n", ""), {"1 of 5 surfaces"});
}

TEST(ZmxReader, NamesTheLine) {
  expect_mentions(zmx_complaint("CURV 0.05", "CURV 0.05x"),
                  {"lens.zmx:23: SURF 1: value 1 of CURV must be a number, not \"0.05x\""});
  expect_mentions(zmx_complaint("CURV 0.05 0 0 0 0 \"\"", "CURV"), {"lens.zmx:23: SURF 1: value 1 of CURV"});
  expect_mentions(zmx_complaint("SURF 3", "SURF 7"), {"lens.zmx:36: ", "SURF 3"});
  expect_mentions(zmx_complaint("FNUM 4.0 0\n", ""), {"0 system apertures", "ENPD, FNUM, OBNA and FLOA"});
  expect_mentions(zmx_complaint("FNUM 4.0 0\n", "FNUM 4.0 0\nENPD 3\n"), {"2 system apertures"});
  expect_mentions(zmx_complaint("FNUM 4.0 0\n", "OBNA 0.1 0\n"), {"object_na needs an object"});
  expect_mentions(zmx_complaint("  STOP\n", ""), {"no stop"});
  expect_mentions(zmx_complaint("  CURV -0.02\n", "  STOP\n  CURV -0.02\n"),
                  {"lens.zmx:37: surfaces[2].stop"});
  expect_mentions(zmx_complaint("PWAV 2", "PWAV 3"), {"lens.zmx:15: PWAV", "1 to 2"});
  expect_mentions(zmx_complaint("WAVM 2", "WAVM 5"), {"lens.zmx:13: WAVM"});
  expect_mentions(zmx_complaint("YFLN 0 7", "YFLN 0 seven"), {"lens.zmx:10: value 2 of YFLN"});
  expect_mentions(zmx_complaint("FTYP 0 0 3", "FTYP 0 0 -3"), {"lens.zmx:8: value 3 of FTYP"});
}

TEST(ZmxWriter, ReadsBackTheSame) {
  for (const char* name :
       {"edmund-54852", "cooke-triplet", "double-gauss", "fisheye-10mm", "us-2532751", "us-5831776"}) {
    SCOPED_TRACE(name);
    const Lens lens = read_lens(name).lens;
    const Lens again = through_file(lens, "lens.zmx");
    EXPECT_EQ(again.name, lens.name);
    expect_same_optics(again, lens);
  }
}

TEST(ZmxWriter, ReadsBackRandomLenses) {
  RandomLens random(5);
  int written = 0;
  for (int i = 0; i < 200; ++i) {
    Lens lens = random.designed();
    if (lens.aperture.kind == Aperture::Kind::image_na) lens.aperture.kind = Aperture::Kind::f_number;
    for (Surface& surface : lens.surfaces) {
      if (std::holds_alternative<Material::Table>(surface.material.kind())) surface.material = Material();
      std::erase_if(surface.asphere, [](const auto& term) { return term.first > 8; });
    }
    const Lens again = through_file(lens, "lens.zmx");
    expect_same_optics(again, lens);
    ++written;
  }
  EXPECT_EQ(written, 200);
}

TEST(ZmxWriter, ImageNaBecomesTheWorkingFNumberThatItIs) {
  const Lens lens = with_setting(read_lens("cooke-triplet").lens, "aperture.image_na=0.125");
  const Lens again = through_file(lens, "lens.zmx");
  EXPECT_EQ(again.aperture.kind, Aperture::Kind::working_f_number);
  EXPECT_EQ(again.aperture.value, 4);
}

TEST(ZmxWriter, KeepsEveryDigitOfAbsurdWavelengths) {
  // In µm the nearest double to a thousandth is another number; found by the fuzzer.
  Lens lens = read_lens("cooke-triplet").lens;
  lens.wavelengths_nm.push_back(1.1111111113333333e76);
  lens.wavelengths_nm.push_back(100.00000000000003);
  EXPECT_EQ(through_file(lens, "lens.zmx").wavelengths_nm, lens.wavelengths_nm);
}

TEST(ZmxWriter, RefusesWhatItCannotHold) {
  const Lens lens = read_lens("cooke-triplet").lens;
  const auto refusal = [&](const std::string& setting) {
    return error_of([&] { through_file(with_setting(lens, setting), "out.zmx"); });
  };
  expect_mentions(refusal("surfaces[2].glass.index_table={\"550\": 1.6}"),
                  {"out.zmx: surfaces[2].glass", "table"});
  EXPECT_EQ(through_file(with_setting(lens, "surfaces[1].asphere.18=1e-9"), "out.zmx").surfaces[1].asphere,
            (std::map<int, double>{{18, 1e-9}}));
  EXPECT_EQ(through_file(with_setting(lens, "surfaces[1].asphere.9=1e-9"), "out.zmx").surfaces[1].asphere,
            (std::map<int, double>{{9, 1e-9}}))
      << "an extended odd asphere";
  expect_mentions(refusal("reference_wavelength_nm=555"), {"reference_wavelength_nm"});
  // Whichever catalogue a reader searches first, one SF1 is taken for the other.
  const Lens confusing = with_setting(lens, "surfaces[0].glass=SCHOTT:SF1");
  expect_mentions(
      error_of([&] { through_file(with_setting(confusing, "surfaces[4].glass=HIKARI:SF1"), "out.zmx"); }),
      {"out.zmx: ", "SF1", "HIKARI", "SCHOTT"});
}

TEST(LensFile, UnknownExtensions) {
  expect_mentions(error_of([] { read_text("lens.doc", "lens"); }), {"lens.doc: ", ".json", ".dat", ".zmx"});
  const Lens lens = read_lens("tessar").lens;
  expect_mentions(error_of([&] { through_file(lens, "lens.doc"); }),
                  {"lens.doc: ", ".json", ".iset.json", ".dat", ".zmx", ".seq"});
  expect_mentions(error_of([] { read_lens("tesar"); }), {"tesar", "tessar"});
  EXPECT_EQ(read_text("LENS.ZMX", zmx_example).lens.name, "a made-up lens");
}

}  // namespace
}  // namespace petzval
