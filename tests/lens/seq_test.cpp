// SPDX-License-Identifier: BSD-3-Clause
// CODE V command files.
#include "random_lens.h"
#include "sample_lenses.h"
#include "scratch_file.h"

#include <petzval/base/data_directory.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/formats/seq_commands.h>
#include <petzval/lens/formats/seq_glass.h>

namespace petzval {
namespace {

using namespace testing;

constexpr const char* seq_example =
    "RDM;LEN   \"VERSION: 11.2\"\n"
    "TITLE 'a made-up lens; with ! signs'   ! and a comment\n"
    "epd 5.0; dim m\n"
    "WL    656.2725 &\n"
    "      587.5618 486.1327\n"
    "REF   2\n"
    "WTW   1 2 1\n"
    "XAN   0.0 0.0\n"
    "YAN   0.0 10.0\n"
    "VUY   0.0 0.0\n"
    "PRV\n"
    "PWL 656.2725 587.5618 486.1327\n"
    "'soft' 1.60 1.61 1.63\n"
    "END\n"
    "SO    0.0 0.1e14\n"
    "S     20 4.5 NBK7_SCHOTT\n"
    "  SLB \"first\"\n"
    "  CIR 6.0; CCY 0\n"
    "S     -40 3 516800.641673\n"
    "  ASP\n"
    "  K -0.5\n"
    "  A 1e-6; B -2e-8; J 3e-24\n"
    "  CIR EDG 8\n"
    "S     0 2\n"
    "  STO\n"
    "s     30. 1.5 'soft'\n"
    "S     -30. 25.5\n"
    "SI    0.0 0.25\n"
    "GO\n";

std::string seq_changed(const std::string& before, const std::string& after) {
  return with_change(seq_example, before, after);
}

LensFile read_seq_text(const std::string& text, const LensReadOptions& options = {}) {
  return read_text("lens.seq", text, options);
}

std::string seq_complaint(const std::string& before, const std::string& after) {
  return error_of([&] { read_seq_text(seq_changed(before, after)); });
}

TEST(SeqCommands, SplitsLinesAndWords) {
  const auto commands = seq_commands("tit 'a ; b'! x\nS1 2. &\n  3 ; sto;;go &\n");
  ASSERT_EQ(commands.size(), 4u);
  EXPECT_EQ(commands[0].name, "TIT");
  EXPECT_EQ(commands[0].words, std::vector<std::string>{"a ; b"});
  EXPECT_EQ(commands[1].name, "S1");
  EXPECT_EQ(commands[1].words, (std::vector<std::string>{"2.", "3"}));
  EXPECT_EQ(commands[1].line, 2);
  EXPECT_EQ(commands[2].name, "STO");
  EXPECT_EQ(commands[2].line, 3);
  EXPECT_EQ(commands[3].name, "GO");
  EXPECT_TRUE(seq_commands("! only\n\n &\n").empty());
}

TEST(SeqReader, TakesOverEverything) {
  const LensFile file = read_seq_text(seq_example);
  const Lens& lens = file.lens;
  EXPECT_EQ(lens.name, "a made-up lens; with ! signs");
  EXPECT_FALSE(lens.object_distance_mm);
  EXPECT_EQ(lens.aperture.kind, Aperture::Kind::entrance_pupil_diameter_mm);
  EXPECT_EQ(lens.aperture.value, 5);
  EXPECT_EQ(lens.wavelengths_nm, (std::vector<double>{656.2725, 587.5618, 486.1327}));
  EXPECT_EQ(lens.reference_wavelength_nm, 587.5618);
  EXPECT_EQ(lens.fields.kind, Fields::Kind::angle_deg);
  EXPECT_EQ(lens.fields.values, (std::vector<double>{0, 10}));
  ASSERT_EQ(lens.surfaces.size(), 5u);
  EXPECT_EQ(lens.surfaces[0].curvature_per_mm, 1 / 20.0);
  EXPECT_EQ(lens.surfaces[0].material.description(), "SCHOTT:N-BK7");
  EXPECT_EQ(lens.surfaces[0].semi_diameter_mm, 6);
  const auto model = std::get<Material::Model>(lens.surfaces[1].material.kind());
  EXPECT_EQ(model.nd, 1.5168);
  EXPECT_EQ(model.vd, 64.1673);
  EXPECT_EQ(lens.surfaces[1].conic, -0.5);
  EXPECT_EQ(lens.surfaces[1].asphere, (std::map<int, double>{{4, 1e-6}, {6, -2e-8}, {20, 3e-24}}));
  EXPECT_FALSE(lens.surfaces[1].semi_diameter_mm);  // an edge is not a clear aperture
  EXPECT_EQ(lens.stop_index(), 2u);
  EXPECT_EQ(lens.surfaces[3].material.index(587.5618), 1.61);
  EXPECT_EQ(lens.surfaces[4].thickness_mm, 25.75);  // with the shift of focus
  ASSERT_EQ(file.notes.size(), 2u);
  expect_mentions(file.notes[0], {"focus", "0.25"});
  expect_mentions(file.notes[1], {"3 of 5 surfaces"});
}

TEST(SeqReader, CurvatureUnlessRdm) {
  EXPECT_EQ(read_seq_text(seq_changed("RDM;", "")).lens.surfaces[0].curvature_per_mm, 20);
  EXPECT_EQ(read_seq_text(seq_changed("RDM;", "RDM N;")).lens.surfaces[0].curvature_per_mm, 20);
  EXPECT_EQ(read_seq_text(seq_changed("RDM;", "RDM Y;")).lens.surfaces[0].curvature_per_mm, 1 / 20.0);
  // RDY and CUY say which they are.
  EXPECT_EQ(read_seq_text(seq_changed("SI ", "RDY S1 25\nSI ")).lens.surfaces[0].curvature_per_mm, 1 / 25.0);
  EXPECT_EQ(read_seq_text(seq_changed("SI ", "CUY S1 0.5\nSI ")).lens.surfaces[0].curvature_per_mm, 0.5);
  // All curvatures absurd: radii, most likely.
  bool warned = false;
  for (const std::string& note : read_seq_text(seq_changed("RDM;", "")).notes)
    warned |= note.find("RDM") != note.npos;
  EXPECT_TRUE(warned);
}

// Focal lengths that another program (ray-optics) and hand calculation give for these two lenses: a
// plano-convex landscape lens scaled to f = 10, and R1 = 10, R2 = −20, t = 1.
TEST(SeqReader, TextbookLenses) {
  const Lens singlet = read_seq_text(
                           "tit 'singlet'\ndim m\nso 0. 100.\ns 0.1 1 '500.600'\ns -.05 15\nsi 0 0\n"
                           "fno 5.0\nwl 587.5618 650 450\nyim 0 1\n")
                           .lens;
  const double n = 1.5, c1 = 0.1, c2 = -0.05, t = 1;
  const double power = (n - 1) * (c1 - c2) + (n - 1) * (n - 1) * t * c1 * c2 / n;
  expect_relative(first_order(singlet).efl_mm, 1 / power, 1e-12);
  EXPECT_EQ(singlet.object_distance_mm, 100);
  EXPECT_EQ(singlet.aperture.kind, Aperture::Kind::working_f_number);
  EXPECT_EQ(singlet.fields.kind, Fields::Kind::paraxial_image_height_mm);
  EXPECT_EQ(singlet.reference_wavelength_nm, 587.5618);  // the first one
  EXPECT_EQ(singlet.stop_index(), 0u);                   // no STO
}

TEST(SeqReader, Apertures) {
  const auto kind = [](const std::string& text) {
    return read_seq_text(seq_changed("epd 5.0", text)).lens.aperture.kind;
  };
  EXPECT_EQ(kind("FNO 4"), Aperture::Kind::f_number);
  EXPECT_EQ(kind("NA 0.1"), Aperture::Kind::image_na);
  std::string finite = seq_changed("SO    0.0 0.1e14", "SO    0.0 50");
  finite.replace(finite.find("epd 5.0"), 7, "nao 0.1");
  EXPECT_EQ(read_seq_text(finite).lens.aperture.kind, Aperture::Kind::object_na);
}

TEST(SeqReader, UnitsScaleEveryLength) {
  const Lens mm = read_seq_text(seq_example).lens, cm = read_seq_text(seq_changed("dim m", "dim c")).lens;
  EXPECT_EQ(cm.aperture.value, 10 * mm.aperture.value);
  EXPECT_EQ(cm.surfaces[0].thickness_mm, 10 * mm.surfaces[0].thickness_mm);
  EXPECT_DOUBLE_EQ(cm.surfaces[0].curvature_per_mm, mm.surfaces[0].curvature_per_mm / 10);
  // The same shape ten times as large: z(r) = a r⁴ becomes 10 a (r/10)⁴.
  EXPECT_DOUBLE_EQ(cm.surfaces[1].asphere.at(4), 1e-9);
  EXPECT_EQ(*cm.surfaces[0].semi_diameter_mm, 60);
  expect_relative(first_order(cm).efl_mm, 10 * first_order(mm).efl_mm, 1e-12);
  EXPECT_EQ(read_seq_text(seq_changed("dim m", "dim i")).lens.aperture.value, 5 * 25.4);
  expect_mentions(seq_complaint("dim m", "dim furlong"), {"lens.seq:3: DIM", "inch"});
}

TEST(SeqReader, FieldsOfAllKinds) {
  const auto fields = [](const std::string& text) {
    return read_seq_text(seq_changed("XAN   0.0 0.0\nYAN   0.0 10.0\n", text)).lens.fields;
  };
  EXPECT_EQ(fields("YIM 0 3\n").kind, Fields::Kind::paraxial_image_height_mm);
  EXPECT_EQ(fields("YRI 0 3\n").kind, Fields::Kind::real_image_height_mm);
  EXPECT_EQ(fields("XIM 0 3\nYIM 0 4\n").values, (std::vector<double>{0, 5}));
  EXPECT_EQ(fields("").values, std::vector<double>{0});
  const std::string finite = seq_changed("SO    0.0 0.1e14", "SO    0.0 50");
  std::string heights = finite;
  heights.replace(heights.find("YAN"), 3, "YOB");
  EXPECT_EQ(read_seq_text(heights).lens.fields.kind, Fields::Kind::object_height_mm);
}

TEST(SeqReader, SolvesTheParaxialImageWhereNoDistanceStands) {
  const LensFile file =
      read_seq_text(seq_changed("S     -30. 25.5\nSI    0.0 0.25", "S     -30. 0\n PIM\nSI    0.0 0.0"));
  EXPECT_NEAR(trace_paraxial(file.lens, 1, 0, 587.5618).height_mm.back(), 0, 1e-13);
  // A distance that stands there is the solved one.
  EXPECT_EQ(
      read_seq_text(seq_changed("SI    0.0 0.25", " PIM\nSI    0.0 0")).lens.surfaces.back().thickness_mm,
      25.5);
}

TEST(SeqReader, Glasses) {
  const auto glass = [](const std::string& name, const LensReadOptions& options = {}) {
    return read_seq_text(seq_changed("NBK7_SCHOTT", name), options).lens.surfaces[0].material;
  };
  EXPECT_EQ(glass("nbk7_schott").description(), "SCHOTT:N-BK7");
  EXPECT_EQ(glass("N-SK16_SCHOTT").description(), "SCHOTT:N-SK16");
  EXPECT_EQ(glass("SBSL7_OHARA").description(), "OHARA:S-BSL7");
  EXPECT_EQ(glass("NLASF9").description(), "SCHOTT:N-LASF9");
  EXPECT_EQ(std::get<Material::Model>(glass("517642").kind()).nd, 1.517);
  EXPECT_EQ(std::get<Material::Model>(glass("517642").kind()).vd, 64.2);
  EXPECT_EQ(std::get<Material::Model>(glass("500.700").kind()).vd, 70);
  expect_mentions(seq_complaint("NBK7_SCHOTT", "NBK99_SCHOTT"),
                  {"lens.seq:16: S1: unknown glass", "N-BK7", "`substitute`"});
  expect_mentions(seq_complaint("NBK7_SCHOTT", "1.5"), {"lens.seq:16: S1: 1.5", "517.642"});
  LensReadOptions options;
  options.substitutions = {{"OLD_SCHOTT", "SCHOTT:F2"}};
  EXPECT_EQ(glass("OLD_SCHOTT", options).description(), "SCHOTT:F2");
  options.substitutions = {{"BK8", "SCHOTT:F2"}};
  expect_mentions(error_of([&] { read_seq_text(seq_example, options); }),
                  {"lens.seq: `substitute` BK8", "NBK7_SCHOTT"});
}

TEST(SeqReader, PrivateGlasses) {
  // Indices in the order of PWL, whatever it is.
  const Material soft = read_seq_text(seq_example).lens.surfaces[3].material;
  EXPECT_EQ(soft.index(486.1327), 1.63);
  EXPECT_EQ(soft.index(656.2725), 1.60);
  const Material constant =
      read_seq_text(seq_changed("1.60 1.61 1.63", "1.5 1.5 1.5")).lens.surfaces[3].material;
  EXPECT_EQ(constant.index(10600), 1.5);
  expect_mentions(seq_complaint("1.60 1.61 1.63", "1.60 1.61"),
                  {"lens.seq:13: private glass 'soft': 2 indices"});
  expect_mentions(seq_complaint("1.60 1.61 1.63", "LAU 1 2 3"), {"lens.seq:13: private glass 'soft'", "LAU"});
  expect_mentions(seq_complaint("1.60 1.61 1.63", "0.6 1.61 1.63"), {"lens.seq:13: ", "0.6"});
}

TEST(SeqReader, RefusesWhatItDoesNotModel) {
  const auto with = [&](const std::string& command) {
    return seq_complaint("  STO\n", "  STO\n " + command + "\n");
  };
  for (const char* command : {"YTO", "SPS XYP", "SPS QCN", "CUF 0.1", "DIF GRT", "HOE", "UDS", "CUX 1"})
    expect_mentions(with(command), {"lens.seq:26: S3: ", std::string(command, 3).c_str(), "not modelled"});
  EXPECT_NO_THROW(read_seq_text(seq_changed("  STO\n", "  STO\n ADE 0; XDE 0.0; CUF 0.0; REX EDG 4\n")));
  expect_mentions(with("REX 4"), {"lens.seq", "REX and REY"});
  expect_mentions(with("GRT; GRO 1"), {"lens.seq", "without a positive spacing (GRS)"});
  expect_mentions(with("GRT; GRO 1; GRS 0.002; GRZ 1"), {"lens.seq", "oblique"});
  expect_mentions(with("CIR HOL 2"), {"lens.seq:24: ", "hole (HOL)", "not modelled"});
  expect_mentions(seq_complaint("SI    0.0 0.25", "SI    0.1 0.25"), {"curved image"});
  expect_mentions(seq_complaint("SO    0.0", "SO    0.1"), {"curved object"});
  expect_mentions(seq_complaint("REF   2", "REF   2; TEM 40"), {"lens.seq:6: TEM", "temperature"});
  EXPECT_NO_THROW(read_seq_text(seq_changed("REF   2", "REF   2; TEM 20; PRE 760")));
}

TEST(SeqReader, OddPolynomials) {
  // CODE V, Lens System Setup: z = conic + Σ AR_p (r/NRADIUS)^p; C1 is K, C(p + 1) is AR_p, C33 is NRADIUS,
  // and NRADIUS 0 stands for 1.
  const auto surface = [&](const std::string& commands) {
    return read_seq_text(seq_changed("  ASP\n  K -0.5\n  A 1e-6; B -2e-8; J 3e-24\n", commands))
        .lens.surfaces[1];
  };
  using Terms = std::map<int, double>;
  const Surface named = surface("  SPS ODD 0.0\n  SCO K -0.5; SCO AR3 2e-4; sco ar30 -1e-20\n");
  EXPECT_EQ(named.conic, -0.5);
  EXPECT_EQ(named.asphere, (Terms{{3, 2e-4}, {30, -1e-20}}));
  const Surface numbered = surface("  SPS ODD\n  SCO C1 -0.5; SCO S2 C4 2e-4; SCO C31 -1e-20; SCC C4 100\n");
  EXPECT_EQ(numbered.asphere, named.asphere);
  EXPECT_EQ(numbered.conic, named.conic);
  for (const char* radius : {"  SPS ODD 2.0\n  SCO AR4 0.32\n", "  SPS ODD\n  SCO C5 0.32\n  SCO NRADIUS 2\n",
                             "  SPS ODD\n  SCO C33 2; SCO AR4 0.32\n"})
    EXPECT_NEAR(surface(radius).asphere.at(4), 0.02, 1e-17) << radius;
  // In inches: 0.32 in (r / 2 in)^4.
  const std::string inches = seq_changed("dim m", "dim i");
  const std::size_t at = inches.find("  ASP");
  const Lens lens = read_seq_text(inches.substr(0, at) + "  SPS ODD 2.0\n  SCO AR4 0.32\n" +
                                  inches.substr(inches.find("  CIR EDG")))
                        .lens;
  EXPECT_NEAR(lens.surfaces[1].asphere.at(4) / (0.32 * 25.4 / std::pow(50.8, 4)), 1, 1e-14);
  const auto refusal = [&](const std::string& commands) {
    return seq_complaint("  ASP\n  K -0.5\n  A 1e-6; B -2e-8; J 3e-24\n", commands);
  };
  expect_mentions(refusal("  SCO AR3 1\n"), {"lens.seq:20: S2: SCO", "no SPS ODD"});
  expect_mentions(refusal("  SPS ODD\n  SCO AR31 1\n"), {"lens.seq:21: S2: SCO AR31", "AR1 to AR30"});
  expect_mentions(refusal("  SPS ODD\n  SCO C32 1\n"), {"lens.seq:21: S2: SCO C32"});
  expect_mentions(refusal("  SPS ODD\n  SCO AR2147483647 1\n"), {"lens.seq:21: S2: SCO AR2147483647"});
  expect_mentions(refusal("  SPS ODD -1\n"), {"lens.seq:19: S has a negative NRADIUS"});
}

TEST(SeqReader, LinesThatGoOnWithoutABlank) {
  const Lens lens = read_seq_text(seq_changed("WL    656.2725 &\n", "WL    656.2725&\n")).lens;
  EXPECT_EQ(lens.wavelengths_nm.size(), 3u);
  EXPECT_EQ(read_seq_text(seq_changed("J 3e-24", "J&\n  3e-24")).lens.surfaces[1].asphere.at(20), 3e-24);
}

TEST(SeqReader, SolvesLeaveTheNumberOnTheSurfacesLine) {
  const LensFile solved =
      read_seq_text(seq_changed("SI    0.0 0.25", "THI S5 PIM\nTHI S4 OAL S1..5 60.0\nSI    0.0 0.25"));
  EXPECT_EQ(solved.lens.surfaces[3].thickness_mm, 1.5);
  expect_mentions(solved.notes[0], {"THI: a solve"});
}

TEST(SeqReader, NotesWhatItPassesOver) {
  const auto notes = read_seq_text(seq_changed("VUY   0.0 0.0", "VUY   0.0 0.1\nWXYZ 3")).notes;
  ASSERT_EQ(notes.size(), 4u);
  expect_mentions(notes[0], {"vignetting"});
  expect_mentions(notes[1], {"WXY"});
}

TEST(SeqReader, NamesTheLine) {
  expect_mentions(seq_complaint("S     20 4.5", "S     2x0 4.5"),
                  {"lens.seq:16: S1: S must have a number", "2x0"});
  expect_mentions(seq_complaint("  K -0.5", "  K"), {"lens.seq:21: S2: K must have a number"});
  expect_mentions(seq_complaint("epd 5.0; ", ""), {"EPD, FNO, NA and NAO"});
  expect_mentions(seq_complaint("epd 5.0", "epd five"), {"lens.seq:3: EPD must have a number"});
  expect_mentions(seq_complaint("epd 5.0", "nao 0.1"), {"object_na needs an object"});
  expect_mentions(seq_complaint("REF   2", "REF   4"), {"lens.seq:6: REF", "1 to 3"});
  expect_mentions(seq_complaint("SO    0.0 0.1e14\n", ""), {"lens.seq:15: S comes before the object"});
  expect_mentions(seq_complaint("SI    0.0 0.25\n", ""), {"whole lens", "SI"});
  expect_mentions(seq_complaint("GO\n", "S 1 2\n"), {"lens.seq:29: S comes after the image"});
  expect_mentions(seq_complaint("GO\n", "STO S9\n"), {"S9", "not there"});
  expect_mentions(seq_complaint("S     -40 3", "S7     -40 3"), {"lens.seq:19: S7 is not the next surface"});
  expect_mentions(seq_complaint("S     -30. 25.5", "S     -30. 1e20"), {"S is infinitely far"});
}

TEST(SeqWriter, ReadsBackTheSame) {
  for (const char* name : {"cooke-triplet", "double-gauss", "us-5831776"}) {
    SCOPED_TRACE(name);
    const Lens lens = read_lens(name).lens;
    const Lens again = through_file(lens, "lens.seq");
    EXPECT_EQ(again.name, lens.name);
    expect_same_optics(again, lens);
  }
}

TEST(SeqWriter, ReadsBackRandomLenses) {
  RandomLens random(15);
  for (int i = 0; i < 200; ++i) {
    Lens lens = random.designed();
    if (lens.object_distance_mm) lens.aperture.kind = Aperture::Kind::image_na;
    if (lens.aperture.kind == Aperture::Kind::stop_semi_diameter_mm ||
        lens.aperture.kind == Aperture::Kind::working_f_number)
      lens.aperture.kind = Aperture::Kind::f_number;
    for (Surface& surface : lens.surfaces)
      std::erase_if(surface.asphere, [](const auto& term) { return term.first > 30; });
    expect_same_optics(through_file(lens, "lens.seq"), lens);
  }
}

TEST(SeqWriter, FictitiousGlassesKeepEveryDigit) {
  RandomLens random(16);
  for (int i = 0; i < 1000; ++i) {
    const Material::Model model{1 + random.uniform(), 99 * random.uniform() + 0.5};
    const auto again = fictitious_glass(fictitious_glass_text(model));
    ASSERT_TRUE(again);
    EXPECT_EQ(again->nd, model.nd);
    EXPECT_EQ(again->vd, model.vd);
  }
  const auto colon = fictitious_glass("1.5168:64.17");
  ASSERT_TRUE(colon);
  EXPECT_EQ(colon->nd, 1.5168);
  EXPECT_EQ(colon->vd, 64.17);
  EXPECT_FALSE(fictitious_glass("SCHOTT:N-BK7"));
  EXPECT_EQ(fictitious_glass_text({1.5, 70}), "500.700");
  EXPECT_EQ(fictitious_glass_text({1.5168, 64.17}), "5168.6417");
  EXPECT_EQ(fictitious_glass_text({1.5, 7.5}), "500.075");
}

TEST(SeqWriter, RefusesWhatItCannotHold) {
  const Lens lens = read_lens("cooke-triplet").lens;
  const auto refusal = [&](const std::string& setting) {
    return error_of([&] { through_file(with_setting(lens, setting), "out.seq"); });
  };
  expect_mentions(refusal("surfaces[1].asphere.31=1e-9"), {"out.seq: surfaces[1].asphere", "r^31"});
  expect_mentions(refusal("surfaces[0].glass={\"nd\": 2.1, \"vd\": 20}"), {"surfaces[0].glass", "below 2"});
  expect_mentions(refusal("surfaces[0].glass={\"nd\": 1.6, \"vd\": 40, \"dpgf\": 0.01}"), {"normal line"});
  expect_mentions(refusal("aperture.stop_semi_diameter_mm=3"), {"stop_semi_diameter_mm"});
  expect_mentions(refusal("reference_wavelength_nm=555"), {"reference_wavelength_nm"});
  const Lens near = with_setting(lens, "object_distance_mm=500");
  expect_mentions(error_of([&] { through_file(with_setting(near, "aperture.f_number=5"), "out.seq"); }),
                  {"aperture.f_number", "working_f_number"});
}

/// Files as other programs wrote them, and the focal lengths that were published with them. The folder stands
/// beside the checkout or nowhere; the same forms are in the example above.
TEST(PublishedSeq, FocalLengths) {
  const std::string folder = data_directory() + "/../../shared/data/lenses/seq/";
  if (!std::filesystem::exists(folder))
    GTEST_SKIP() << folder << " is not here: the published files are not part of Petzval";
  EXPECT_NEAR(first_order(read_lens(folder + "landscape_lens.seq").lens).efl_mm, 10.0000,
              5e-5);  // as printed
  EXPECT_NEAR(first_order(read_lens(folder + "singlet.seq").lens).efl_mm, 13.105, 5e-4);
  EXPECT_NEAR(first_order(read_lens(folder + "ag_dblgauss.seq").lens).efl_mm, 100.00376, 5e-6);
  // Three mirrors that bend the axis by 120, −120 and −90 degrees: the sensor looks along −y.
  const Lens folded = read_lens(folder + "dec_tilt_test.seq").lens;
  const Frame::Vector normal = frames_of(folded).back().to_lens({0, 0, 1});
  EXPECT_NEAR(std::abs(normal[1]), 1, 1e-12);
}

}  // namespace
}  // namespace petzval
