// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/live/message.h>

#include "live_page.h"

namespace petzval {
namespace {

using test::bench_state;
using test::json;

LiveMessage parsed(const json& message) {
  static const LiveNames names = bundled_live_names();
  return parse_live_message(message.dump(), names);
}

TEST(LiveMessage, HoldsWhatThePageSaid) {
  json message = bench_state(9, "tessar");
  message["camera"] = {
      {"f_number", 5.6}, {"blades", 7}, {"focus", "1.2m"}, {"distance_m", 3}, {"defocus_mm", -0.25}};
  message["cursor_mm"] = {1.5, -2};
  message["coatings"] = {"mgf2", nullptr, "quarter-half-quarter"};
  const json suns = {{{"deg", {20, -15.5}}, {"lx", 5000}}, {{"deg", {-3, 0}}, {"lx", 20}}};
  message["stray"] = {{"suns", suns},      {"sun", 1},          {"threshold", 12.5}, {"ghosts", true},
                      {"starburst", true}, {"roughness_nm", 2}, {"ghost", {5, 0}}};
  const auto state = std::get<BenchState>(parsed(message));
  EXPECT_EQ(state.id, 9);
  EXPECT_EQ(state.f_number, 5.6);
  EXPECT_EQ(state.focus, Focus::at_m(1.2));
  EXPECT_EQ(state.distance_m, 3);
  EXPECT_EQ(state.defocus_mm, -0.25);
  EXPECT_EQ(state.cursor_mm[1], -2);
  EXPECT_EQ(state.coating_text(), "surfaces[0]=mgf2,surfaces[2]=quarter-half-quarter");
  EXPECT_EQ(state.blades.value_or(StopBlades{}).count, 7);
  ASSERT_TRUE(state.suns.size() == 2 && state.ghost);
  EXPECT_EQ(state.suns[0].right_deg, 20);
  EXPECT_EQ(state.suns[0].up_deg, -15.5);
  EXPECT_EQ(state.suns[0].illuminance_lx, 5000);
  EXPECT_EQ(state.suns[1].right_deg, -3);
  EXPECT_EQ(state.chosen_sun, 1u);
  EXPECT_EQ(state.threshold, 12.5);
  EXPECT_TRUE(state.ghosts && state.starburst);
  EXPECT_EQ(state.roughness_nm, 2);
  EXPECT_EQ(*state.ghost, (GhostPair{5, 0}));
  EXPECT_EQ(lens_to_json(lens_from_json(state.lens_json, "test")), lens_to_json(read_lens("tessar").lens));
}

TEST(LiveMessage, RefusesEveryMissingAndEveryFurtherKey) {
  const json whole = bench_state(1);
  EXPECT_NO_THROW(parsed(whole));
  for (const auto& [key, value] : whole.items()) {
    json without = whole;
    without.erase(key);
    EXPECT_THROW(parsed(without), InputError) << key;
    if (!value.is_object() || key == "lens") continue;
    for (const auto& [inner, unused] : value.items()) {
      json less = whole;
      less[key].erase(inner);
      EXPECT_THROW(parsed(less), InputError) << key << "." << inner;
    }
    json more = whole;
    more[key]["path"] = "/etc/passwd";
    EXPECT_THROW(parsed(more), InputError) << key;
  }
  json more = whole;
  more["path"] = "/etc/passwd";
  EXPECT_THROW(parsed(more), InputError);
}

TEST(LiveMessage, RefusesNamesThatWereNotOffered) {
  for (const char* key : {"scene", "sensor", "illuminant"}) {
    for (const char* name :
         {"/etc/passwd", "../data/lenses/tessar.json", "http://evil.example/x", "studio\n", ""}) {
      if (std::string(key) == "illuminant" && std::string(name).empty()) continue;  // its own light
      json state = bench_state(1);
      state[key] = name;
      EXPECT_THROW(parsed(state), InputError) << key << " " << name;
    }
  }
}

TEST(LiveMessage, RefusesNumbersOutOfRange) {
  const auto with = [](const char* pointer, const json& value) {
    json state = bench_state(1);
    state[json::json_pointer(pointer)] = value;
    return state;
  };
  EXPECT_THROW(parsed(with("/id", 1.5)), InputError);
  EXPECT_THROW(parsed(with("/id", -1)), InputError);
  EXPECT_THROW(parsed(with("/camera/f_number", 0)), InputError);
  EXPECT_THROW(parsed(with("/camera/f_number", "2")), InputError);
  EXPECT_THROW(parsed(with("/camera/distance_m", -1)), InputError);
  EXPECT_THROW(parsed(with("/camera/focus", "somewhere")), InputError);
  EXPECT_THROW(parsed(with("/shot/exposure", "long")), InputError);
  EXPECT_THROW(parsed(with("/shot/noise", 1)), InputError);
  EXPECT_THROW(parsed(with("/cursor_mm", json::array({1}))), InputError);
  EXPECT_THROW(parsed(with("/coatings", json::array({"/etc/passwd"}))), InputError);
  EXPECT_THROW(parsed(with("/coatings", "mgf2")), InputError);
  EXPECT_THROW(parsed(with("/cursor_mm/0", 1e300)), InputError);
  const auto sun = [](const json& deg, double lx) { return json::array({{{"deg", deg}, {"lx", lx}}}); };
  EXPECT_NO_THROW(parsed(with("/stray/suns", sun({20, 0}, 1))));
  EXPECT_THROW(parsed(with("/stray/suns", sun({80, 0}, 1))), InputError);
  EXPECT_THROW(parsed(with("/stray/suns", sun({1, 2, 3}, 1))), InputError);
  EXPECT_THROW(parsed(with("/stray/suns", sun({20, 0}, 0))), InputError);
  EXPECT_THROW(parsed(with("/stray/suns", json::array({1}))), InputError);
  EXPECT_THROW(parsed(with("/stray/suns", json(17, sun({20, 0}, 1)[0]))), InputError) << "too many";
  EXPECT_THROW(parsed(with("/camera/blades", 2)), InputError);
  EXPECT_THROW(parsed(with("/camera/blades", 65)), InputError);
  EXPECT_THROW(parsed(with("/stray/threshold", 0.5)), InputError);
  EXPECT_THROW(parsed(with("/stray/roughness_nm", -1)), InputError);
  EXPECT_THROW(parsed(with("/stray/ghost", {0, 5})), InputError);
  EXPECT_THROW(parsed(with("/stray/ghost", {1.5, 0})), InputError);
  EXPECT_THROW(parsed(with("/stray/ghost", {1, -1})), InputError);
  EXPECT_THROW(parsed(with("/plots", json(std::vector<std::string>(17, "mtf")))), InputError);
}

TEST(LiveMessage, FocusesOnAPlace) {
  const auto wish = std::get<FocusWish>(parsed({{"kind", "focus"}, {"id", 4}, {"place_mm", {1.5, -2}}}));
  EXPECT_EQ(wish.place_mm, (std::array<double, 2>{1.5, -2}));
  EXPECT_THROW(parsed({{"kind", "focus"}, {"id", 4}, {"place_mm", {1.5}}}), InputError);
  EXPECT_THROW(parsed({{"kind", "focus"}, {"id", 4}, {"place_mm", {1.5, 2}}, {"zone", 1}}), InputError);
}

TEST(LiveUpload, IsAHeaderAndBytes) {
  const std::string header = R"({"kind":"upload","id":3,"name":"Old Lens.ZMX"})";
  const std::string frame = std::string({static_cast<char>(header.size()), 0, 0, 0}) + header + "SURF";
  const Upload upload = parse_live_upload(frame);
  EXPECT_EQ(upload.extension, ".zmx");
  EXPECT_EQ(upload.label, "Old Lens");
  EXPECT_EQ(upload.bytes, "SURF");
  // Cut anywhere in the header it is none.
  for (std::size_t length = 0; length < 4 + header.size(); ++length)
    EXPECT_THROW(parse_live_upload(std::string_view(frame).substr(0, length)), InputError) << length;
}

TEST(LiveUpload, MayHaveACompanion) {
  const auto frame = [](const json& header, const std::string& files) {
    const std::string text = header.dump();
    return std::string({static_cast<char>(text.size()), 0, 0, 0}) + text + files;
  };
  json header{
      {"kind", "upload"}, {"id", 3}, {"name", "a.hdr"}, {"companion", "a.raw"}, {"companion_bytes", 3}};
  const Upload upload = parse_live_upload(frame(header, "ENVI\n123"));
  EXPECT_EQ(upload.bytes, "ENVI\n");
  EXPECT_EQ(upload.companion_bytes, "123");
  for (const auto& [key, value] : std::vector<std::pair<std::string, json>>{{"companion_bytes", 9},
                                                                            {"companion_bytes", -1},
                                                                            {"companion_bytes", 0.5},
                                                                            {"companion", ""},
                                                                            {"companion", 1},
                                                                            {"name", "a.zmx"}}) {
    json wrong = header;
    wrong[key] = value;
    EXPECT_THROW(parse_live_upload(frame(wrong, "ENVI\n123")), InputError) << key << ' ' << value;
  }
  header.erase("companion");
  EXPECT_THROW(parse_live_upload(frame(header, "ENVI\n123")), InputError);
}

}  // namespace
}  // namespace petzval
