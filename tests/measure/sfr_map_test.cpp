// SPDX-License-Identifier: BSD-3-Clause
// Maps of sharpness from files: what is taken, and what is refused in one line.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/measure/sfr/sfr_map.h>

#include <string>

namespace petzval {
namespace {

const std::string line = R"("line": {"x_px": 12.5, "y_px": 30, "normal_deg": 95, "half_length_px": 20})";
const std::string curve =
    R"("frequencies_cpp": [0, 0.1, 0.2, 0.3, 0.4, 0.5], "sfr": [1, 0.85, 0.6, 0.4, 0.25, 0.1],
  "sfr_deviation": [0, 0.01, 0.02, 0.02, 0.03, 0.03])";

std::string picture(const std::string& edge) {
  return R"({"image": "a.png", "columns": 640, "rows": 480, "edges": [{)" + edge + "}]}";
}

TEST(SfrMap, TakesThreeLevelsWithTheirCorrelations) {
  const auto maps = parse_sfr_maps(
      picture(R"("mtf50_cpp": 0.25, "level_correlations": [0.5, 0.1, 0.3], )" + line + ", " + curve), "map");
  ASSERT_EQ(maps.size(), 1u);
  EXPECT_EQ(maps[0].columns, 640);
  const MapEdge& edge = maps[0].edges.at(0);
  EXPECT_DOUBLE_EQ(edge.normal_rad, radians(95));
  EXPECT_DOUBLE_EQ(edge.half_length_px, 20);
  ASSERT_EQ(edge.contrast.size(), 3u);
  EXPECT_NEAR(edge.frequencies_cpp[0], 0.12, 1e-12);
  EXPECT_NEAR(edge.frequencies_cpp[1], 0.25, 1e-12);
  EXPECT_NEAR(edge.contrast[1], 0.5, 1e-12);
  EXPECT_NEAR(edge.deviation[0], 0.012, 1e-12);
  EXPECT_EQ(edge.correlation, (std::vector<double>{1, 0.5, 0.1, 0.5, 1, 0.3, 0.1, 0.3, 1}));
}

TEST(SfrMap, WithoutCorrelationsMtf50Counts) {
  const auto maps = parse_sfr_maps(picture(R"("mtf50_cpp": 0.25, )" + line + ", " + curve), "map");
  EXPECT_EQ(maps[0].edges.at(0).frequencies_cpp, std::vector<double>{0.25});
  const auto bare =
      parse_sfr_maps(picture(R"("mtf50_cpp": 0.25, "mtf50_deviation_cpp": 0.005, )" + line), "map");
  EXPECT_NEAR(bare[0].edges.at(0).deviation.at(0), 0.693 * 0.02, 1e-12);
}

TEST(SfrMap, SeveralPicturesAreSeveralMaps) {
  const std::string one = picture(R"("mtf50_cpp": 0.25, )" + line + ", " + curve);
  EXPECT_EQ(parse_sfr_maps(R"({"pictures": [)" + one + "," + one + R"(], "failed": []})", "map").size(), 2u);
}

TEST(SfrMap, RefusesInOneLine) {
  for (
      const auto& [text, says] :
      {std::pair{std::string("[]"), "no JSON object"},
       {std::string("{"), "no JSON object"},
       {std::string(R"({"columns": 3})"), "list of edges"},
       {std::string(R"({"columns": 640, "rows": 0, "edges": []})"), "how many rows"},
       {std::string(R"({"columns": 640, "rows": 480, "edges": []})"), "no edge"},
       {std::string(R"({"pictures": []})"), "empty list"},
       {picture(R"("mtf50_cpp": null)"), "no edge"},
       {picture(R"("mtf50_cpp": 0.2)"), "no line"},
       {picture(R"("mtf50_cpp": -0.2, )" + line), "not positive"},
       {picture(R"("mtf50_cpp": 0.2, )" + line), "mtf50_deviation_cpp"},
       {picture(R"("mtf50_cpp": "x", )" + line), "no number"},
       {picture(R"("mtf50_cpp": 0.2, "level_correlations": [2, 0, 0], )" + line + "," + curve), "-1 to 1"},
       {picture(R"("mtf50_cpp": 0.2, "frequencies_cpp": [0, 0], "sfr": [1, 1], "sfr_deviation": [0, 0], )" +
                line),
        "rising"},
       {picture(R"("mtf50_cpp": 0.2, "frequencies_cpp": [0, 1], "sfr": [1], "sfr_deviation": [0, 0], )" +
                line),
        "as long as"},
       // At MTF50, beyond the curve, it would be 1 - 1e308 · (0.2 / 1e-300).
       {picture(
            R"("mtf50_cpp": 0.2, "frequencies_cpp": [0, 1e-300], "sfr": [1, -1e308], "sfr_deviation": [0, 0], )" +
            line),
        "no contrast"}}) {
    try {
      parse_sfr_maps(text, "map.json");
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find("map.json"), 0u);
    }
  }
}

}  // namespace
}  // namespace petzval
