// SPDX-License-Identifier: BSD-3-Clause
// Zoom and focus positions: native, .zmx and .seq.
#include "random_lens.h"
#include "sample_lenses.h"
#include "scratch_file.h"

#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_states.h>
#include <petzval/lens/reversed_lens.h>
#include <petzval/lens/scaled_lens.h>

namespace petzval {
namespace {

using namespace testing;

Lens zoom_lens() {
  return read_lens("zoom-14-24mm").lens;
}

double focal_length(const Lens& lens, const std::string& state) {
  return first_order(in_state(lens, state)).efl_mm;
}

/// WO 2021/117563, example 4. It prints focal lengths and gaps to 0.01 mm and radii to four digits; the
/// bound, 0.1 %, is that of such digits in a row of 28 surfaces, set when 0.03 % had been seen.
TEST(LensStates, TheZoomLensIsThePatents) {
  const Lens zoom = zoom_lens();
  const std::pair<const char*, double> printed[] = {
      {"wide", 14.42}, {"18mm", 18.00}, {"20mm", 20.00}, {"tele", 23.29}};
  for (const auto& [state, focal_length_mm] : printed)
    expect_relative(focal_length(zoom, state), focal_length_mm, 1e-3);
  EXPECT_NEAR(in_state(zoom, "wide").total_track_mm(), 138.261, 0.01);
  // Near and far states of a zoom position are focused on one sensor: to the depth of focus at f/2.9 of a
  // circle of 0.03 mm.
  for (std::size_t i = 0; i < 4; ++i) {
    const Lens far = in_state(zoom, static_cast<double>(i)),
               near = in_state(zoom, static_cast<double>(7 - i));
    EXPECT_EQ(far.image_distance_mm(), near.image_distance_mm());
    EXPECT_NEAR(first_order(far).paraxial_image_mm, first_order(near).paraxial_image_mm, 2.91 * 0.03);
    EXPECT_NEAR(near.object_distance_mm.value() + near.total_track_mm(), 280, 0.02);
  }
  // The lens stands in its first state, and says so.
  EXPECT_EQ(present_state(zoom), 0u);
  EXPECT_EQ(present_state(in_state(zoom, "tele-near")), 4u);
  EXPECT_FALSE(present_state(with_setting(zoom, "surfaces[7].thickness_mm=19")));
}

TEST(LensStates, BetweenTwoStatesNumbersAreInProportion) {
  const Lens zoom = zoom_lens();
  const Lens between = in_state(zoom, "0.25");
  EXPECT_NEAR(between.surfaces[7].thickness_mm, 19.11 + 0.25 * (10.32 - 19.11), 1e-12);
  EXPECT_FALSE(between.object_distance_mm);
  // Half as near is twice as far.
  EXPECT_NEAR(in_state(zoom, "3.5").object_distance_mm.value(), 2 * 150.34, 1e-9);
  Lens curved = zoom;
  curved.states.rows = {{"surfaces[0].radius_mm", {"50", "null", "-100", "25", "25", "25", "25", "25"}},
                        {"fields.values", {"[0, 4]", "[0, 8]", "[0]", "[0]", "[0]", "[0]", "[0]", "[0]"}}};
  EXPECT_NEAR(in_state(curved, 0.5).surfaces[0].curvature_per_mm, 0.01, 1e-15);
  EXPECT_NEAR(in_state(curved, 0.5).fields.values[1], 6, 1e-15);
  curved.states.rows.pop_back();
  EXPECT_NEAR(in_state(curved, 2.5).surfaces[0].curvature_per_mm, 0.5 * (1 / 25.0 - 1 / 100.0), 1e-15);
}

TEST(LensStates, SayWhatIsWrongInOneLine) {
  const std::string text = lens_to_json(zoom_lens());
  const auto complaint = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    const std::size_t at = changed.find(from);
    EXPECT_NE(at, changed.npos) << from;
    changed.replace(at, from.size(), to);
    return error_of([&] { lens_from_json(changed, "zoom.json"); });
  };
  expect_mentions(complaint("[19.11, 10.32, ", "[19.11, "),
                  {"zoom.json:", "surfaces[7].thickness_mm", "misses the value of state \"wide-near\""});
  expect_mentions(complaint("[19.11, ", "[1, 19.11, "), {"9 values for 8 states"});
  expect_mentions(complaint("[19.11, ", "[\"x\", "), {"zoom.json:", "state \"wide\"", "thickness_mm"});
  expect_mentions(complaint("[19.11, ", "[null, "), {"state \"wide\"", "thickness_mm"});
  expect_mentions(complaint("\"surfaces[7].thickness_mm\"", "\"surfaces[70].thickness_mm\""),
                  {"surfaces[70] is not there"});
  expect_mentions(complaint("\"surfaces[7].thickness_mm\"", "\"wavelengths_nm\""), {"cannot differ"});
  expect_mentions(complaint("\"surfaces[7].thickness_mm\"", "\"surfaces[\""), {"is not a path"});
  expect_mentions(complaint("\"wide\"", "\"tele\""), {"\"tele\" stands there twice"});
  expect_mentions(complaint("\"wide\"", "\"3\""), {"states.names[0]", "no number"});
  for (const char* state : {"wied", "8", "-1", "7.5", "nan", "1e9"})
    expect_mentions(error_of([&] { in_state(zoom_lens(), state); }), {state, "wide, 18mm", "0 to 7"});
  expect_mentions(error_of([&] { in_state(read_lens("tessar").lens, "1"); }), {"Tessar has no states"});
  Lens glass = zoom_lens();
  glass.states = {{"a", "b"}, {{"surfaces[0].glass", {"\"SCHOTT:N-BK7\"", "\"SCHOTT:N-SF5\""}}}};
  EXPECT_EQ(in_state(glass, "b").surfaces[0].material.description(), "SCHOTT:N-SF5");
  expect_mentions(error_of([&] { in_state(glass, 0.5); }), {"N-BK7", "N-SF5", "only numbers"});
}

/// The same light in every state: gaps and first-order data to rounding.
void expect_same_states(const Lens& a, const Lens& b) {
  ASSERT_EQ(a.states.size(), b.states.size());
  for (std::size_t i = 0; i < a.states.size(); ++i) {
    SCOPED_TRACE(a.states.names[i]);
    const Lens one = in_state(a, static_cast<double>(i)), other = in_state(b, static_cast<double>(i));
    EXPECT_EQ(one.object_distance_mm, other.object_distance_mm);
    ASSERT_EQ(one.surfaces.size(), other.surfaces.size());
    for (std::size_t k = 0; k < one.surfaces.size(); ++k)
      EXPECT_EQ(one.surfaces[k].thickness_mm, other.surfaces[k].thickness_mm);
    expect_relative(first_order(one).efl_mm, first_order(other).efl_mm, 1e-12);
    expect_relative(first_order(one).entrance_pupil.diameter_mm,
                    first_order(other).entrance_pupil.diameter_mm, 1e-12);
  }
}

TEST(LensStates, GoThroughEveryFormat) {
  // A .seq file holds no fictitious glass of nd 2.
  Lens zoom = with_setting(zoom_lens(), "surfaces[8].glass={\"nd\": 1.9, \"vd\": 25.4}");
  const Lens native = through_file(zoom, "zoom.json");
  expect_same_lens(native, zoom);
  EXPECT_EQ(native.states.names, zoom.states.names);
  EXPECT_EQ(lens_to_json(native), lens_to_json(zoom));
  for (const char* name : {"zoom.zmx", "zoom.seq"}) {
    SCOPED_TRACE(name);
    expect_same_states(through_file(zoom, name), zoom);
  }
  zoom.states.rows.push_back({"surfaces[0].radius_mm", {"151.5", "152", "null", "1", "2", "3", "4", "5e3"}});
  zoom.states.rows.push_back({"surfaces[1].conic", {"-1", "-0.5", "0", "0", "1", "0", "0", "-1"}});
  zoom.states.rows.push_back({"aperture.f_number", {"2.91", "3", "4", "5", "6", "7", "8", "9"}});
  zoom.states.rows[4].values = {"151.5", "152", "null", "200", "300", "400", "500", "5e3"};
  for (const char* name : {"zoom.json", "zoom.zmx", "zoom.seq"}) {
    SCOPED_TRACE(name);
    expect_same_states(through_file(zoom, name), zoom);
  }
  // Glasses, fields and clear apertures too; what has no operand is refused by name.
  zoom.states.rows.push_back({"surfaces[0].glass", std::vector<std::string>(8, "\"SCHOTT:N-BK7\"")});
  zoom.states.rows.back().values[3] = "\"OHARA:S-BSL7\"";
  zoom.states.rows.push_back({"fields.values", std::vector<std::string>(8, "[0, 1, 2, 3, 4]")});
  zoom.states.rows.back().values[2] = "[0, 2, 4, 6, 8]";
  zoom.states.rows.push_back(
      {"surfaces[2].semi_diameter_mm", {"11", "12", "13", "14", "15", "16", "17", "18"}});
  for (const char* name : {"zoom.zmx", "zoom.seq"}) {
    SCOPED_TRACE(name);
    const Lens read = through_file(zoom, name);
    expect_same_states(read, zoom);
    const Lens third = in_state(read, 2), fourth = in_state(read, 3);
    EXPECT_EQ(third.fields.values, (std::vector<double>{0, 2, 4, 6, 8}));
    EXPECT_EQ(third.surfaces[2].semi_diameter_mm, 13);
    EXPECT_EQ(third.surfaces[0].material.description(), "SCHOTT:N-BK7");
    EXPECT_EQ(fourth.surfaces[0].material.description(), "OHARA:S-BSL7");
  }
  zoom.states.rows.push_back({"surfaces[4].asphere", std::vector<std::string>(8, "{\"4\": 1e-6}")});
  for (const char* name : {"zoom.zmx", "zoom.seq"}) {
    ScratchFile file(name);
    expect_mentions(error_of([&] { write_lens(zoom, file.path()); }), {"surfaces[4].asphere", "states"});
  }
}

TEST(LensStates, FollowTheLensWhenItIsScaledOrTurned) {
  const Lens zoom = zoom_lens(), twice = scaled_lens(zoom, 2);
  for (const std::string& state : zoom.states.names)
    expect_relative(focal_length(twice, state), 2 * focal_length(zoom, state), 1e-12);
  const Lens one = read_lens("cooke-triplet").lens;
  const Lens moved = joined_states({"one", "moved"}, {one, with_setting(one, "surfaces[1].thickness_mm=5")});
  const Lens turned = reversed_lens(moved);
  for (const char* state : {"one", "moved"})
    expect_relative(focal_length(turned, state), focal_length(moved, state), 1e-9);
  EXPECT_GT(std::abs(focal_length(moved, "one") - focal_length(moved, "moved")), 0.1);
}

TEST(LensStates, JoinLensesThatDiffer) {
  const Lens one = read_lens("cooke-triplet").lens;
  Lens other = with_setting(one, "surfaces[0].stop=true");
  other = with_setting(other, "aperture.f_number=8");
  other = with_setting(other, "surfaces[2].semi_diameter_mm=null");
  other = with_setting(other, "surfaces[1].asphere.4=1e-6");
  const Lens joined = joined_states({"one", "other"}, {one, other});
  expect_same_lens(in_state(joined, "one"), one);
  expect_same_lens(in_state(joined, "other"), other);
  expect_same_lens(in_state(in_state(joined, "other"), "one"), one);
  Lens shorter = one;
  shorter.surfaces.pop_back();
  EXPECT_THROW(joined_states({"one", "other"}, {one, shorter}), InputError);
}

/// Two thin-ish lenses in air; configurations in the form that OpticStudio 2023 saves.
constexpr const char* zmx_zoom = R"(MODE SEQ
NAME two groups
UNIT MM X W X CM MR CPMM
ENPD 4
ENVD 20 1 0
GCAT SCHOTT
FTYP 0 0 2 1 0 0 0
XFLN 0 0
YFLN 0 5
WAVM 1 0.5875618 1
PWAV 1
SURF 0
  TYPE STANDARD
  CURV 0.0
  DISZ INFINITY
SURF 1
  STOP
  TYPE STANDARD
  CURV 0.02
  DISZ 2
  GLAS N-BK7 0 0 1.5 40
SURF 2
  TYPE STANDARD
  CURV -0.01
  DISZ 5
SURF 3
  TYPE STANDARD
  CURV 0.01
  DISZ 3
  GLAS N-SF5 0 0 1.5 40
SURF 4
  TYPE STANDARD
  CURV 0.0
  DISZ 30
  TCOM 2 35
SURF 5
  TYPE STANDARD
  CURV 0.0
  DISZ 0
TOL TOFF   0   0
)";

TEST(LensStates, ReadsConfigurationsOfZemax) {
  const std::string operands =
      "MNUM 3 1\n"
      "THIC 2 1 5 0 0 0 1 1 1 0 0 \"\" 0\nTHIC 2 2 6 0 0 0 1 1 1 0 0 \"\" 0\nTHIC 2 3 8 0 0 0 1 1 1 0 0 \"\" "
      "0\n"
      "THIC 0 1 1e10 0\nTHIC 0 2 1E+10 0\nTHIC 0 3 500 0\n"
      "APER 0 1 4 0\nAPER 0 2 3 0\nAPER 0 3 2 0\n"
      "CRVT 1 1 0.02\nCRVT 1 2 0.02\nCRVT 1 3 0.025\n"
      "GLSS 3 1 N-SF5\nGLSS 3 2 \"N-SF5\"\nGLSS 3 3 F2\n"
      "STPS 0 1 1\nSTPS 0 2 1\nSTPS 0 3 3\n"
      "YFIE 2 1 5\nYFIE 2 2 4\nYFIE 2 3 3\n"
      "FVCY 1 1 0\nFVCY 1 2 0\nFVCY 1 3 0.1\n";
  const LensFile file = read_text("zoom.zmx", std::string(zmx_zoom) + operands);
  ASSERT_EQ(file.lens.states.names, (std::vector<std::string>{"config-1", "config-2", "config-3"}));
  expect_mentions(file.notes.at(0), {"3 configurations", "config-1 to config-3"});
  EXPECT_EQ(present_state(file.lens), 0u);
  const Lens second = in_state(file.lens, "config-2"), third = in_state(file.lens, "config-3");
  EXPECT_EQ(second.surfaces[1].thickness_mm, 6);
  EXPECT_EQ(second.surfaces[3].thickness_mm, 29);  // 35 together, as TCOM says
  EXPECT_FALSE(second.object_distance_mm);
  EXPECT_EQ(second.aperture.value, 3);
  EXPECT_EQ(second.fields.values, (std::vector<double>{0, 4}));
  EXPECT_EQ(third.object_distance_mm, 500);
  EXPECT_EQ(third.surfaces[0].curvature_per_mm, 0.025);
  EXPECT_EQ(third.surfaces[2].material.description(), "SCHOTT:F2");
  EXPECT_EQ(third.stop_index(), 2u);
  EXPECT_EQ(second.surfaces[2].material.description(), "SCHOTT:N-SF5");
  // All gaps from surface 2 to this one, 10.58 as OpticStudio's Position solve saves it.
  std::string spans = zmx_zoom;
  spans.replace(spans.find("TCOM 2 35"), 9, "TOLE 2 40");
  EXPECT_EQ(in_state(read_text("zoom.zmx", spans + operands).lens, 1).surfaces[3].thickness_mm, 40 - 6 - 3);
  // The sensor in the paraxial focus.
  std::string focus = zmx_zoom;
  focus.replace(focus.find("TCOM 2 35"), 9, "MAZH 0 0");
  const Lens focused = in_state(read_text("zoom.zmx", focus + operands).lens, 1);
  expect_relative(focused.image_distance_mm(), first_order(focused).paraxial_image_mm, 1e-12);
}

TEST(LensStates, SayWhichConfigurationIsIncomplete) {
  const auto read = [](const std::string& operands) { return read_text("zoom.zmx", zmx_zoom + operands); };
  const auto complaint = [&](const std::string& operands) { return error_of([&] { read(operands); }); };
  expect_mentions(complaint("MNUM 2 1\nTHIC 2 1 5\n"), {"zoom.zmx:", "THIC 2", "configuration 2"});
  expect_mentions(complaint("MNUM 2 1\nTHIC 2 1 5\nTHIC 2 2\n"), {"THIC 2 misses", "configuration 2"});
  expect_mentions(complaint("MNUM 2 1\nTHIC 9 1 5\nTHIC 9 2 4\n"), {"THIC 9", "no such surface"});
  expect_mentions(complaint("MNUM 2 1\nYFIE 9 1 5\nYFIE 9 2 4\n"), {"YFIE 9", "no such field"});
  expect_mentions(complaint("MNUM 0.5\n"), {"MNUM"});
  // What is not modelled leaves the lens as it is written out, and a note says so.
  const LensFile other = read("MNUM 2 1\nTHIC 2 1 5\nTHIC 2 2 6\nPRAM 2 1 5\n");
  EXPECT_TRUE(other.lens.states.empty());
  expect_mentions(other.notes.at(0), {"2 configurations", "the one written out", "PRAM"});
}

constexpr const char* seq_zoom_text = R"(RDM; LEN
TIT 'two groups'
EPD 4; DIM M; WL 587.5618; REF 1; YAN 0 5
SO 0 1e13
S1 50 2 NBK7_SCHOTT
 STO
S2 -100 5
S3 100 3 NSF5_SCHOTT
S4 0 30
SI 0 0
)";

TEST(LensStates, ReadsZoomPositionsOfCodeV) {
  const std::string zoomed =
      "ZOO 3\nZOO THI S2 5 6 8\nZOO THI S4 30 29 27\nZOO THI S4 30 29 26\nZOO EPD 4 3 2\nZOO YAN F2 5 4 3\n"
      "ZOO THI SO 1e13 1e13 500\nZOO GLA S3 NSF5_SCHOTT NSF5_SCHOTT F2_SCHOTT\nZOO RDY S1 50 50 40\n"
      "ZOO THC S2 0 0 0\nZOO VUY F2 0 0 0.1\nGO\n";
  const LensFile file = read_text("zoom.seq", seq_zoom_text + zoomed);
  ASSERT_EQ(file.lens.states.names, (std::vector<std::string>{"zoom-1", "zoom-2", "zoom-3"}));
  const Lens second = in_state(file.lens, "zoom-2"), third = in_state(file.lens, "zoom-3");
  EXPECT_EQ(second.surfaces[1].thickness_mm, 6);
  EXPECT_EQ(third.surfaces[3].thickness_mm, 26);
  EXPECT_EQ(second.aperture.value, 3);
  EXPECT_EQ(third.fields.values, (std::vector<double>{0, 3}));
  EXPECT_FALSE(second.object_distance_mm);
  EXPECT_EQ(third.object_distance_mm, 500);
  EXPECT_EQ(third.surfaces[2].material.description(), "SCHOTT:F2");
  EXPECT_EQ(third.surfaces[0].curvature_per_mm, 1 / 40.0);
  const auto complaint = [](const std::string& lines) {
    return error_of([&] { read_text("zoom.seq", seq_zoom_text + lines); });
  };
  expect_mentions(complaint("ZOO 3\nZOO THI S2 5 6\n"),
                  {"zoom.seq:12:", "THI", "2 values for 3 zoom positions"});
  expect_mentions(complaint("ZOO 2\nZOO ADE S2 5 6\n"), {"zoom.seq:12:", "ADE", "not modelled"});
  expect_mentions(complaint("ZOO 2\nZOO YAN F7 5 6\n"), {"F7", "fields"});
  expect_mentions(complaint("ZOO 0\n"), {"zoom.seq:11:", "zoom positions"});
  expect_mentions(complaint("ZOO 2\nZOO THI S2 5 x\n"), {"zoom.seq:12:", "THI"});
}

}  // namespace
}  // namespace petzval
