// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/dataset/recipe.h>

#include <cmath>

namespace petzval {
namespace {

double number_at(const Distribution& distribution, double uniform) {
  return std::get<double>(distribution.at(uniform));
}

TEST(Distribution, QuantilesAreThoseOfTheLaws) {
  EXPECT_DOUBLE_EQ(number_at({.kind = Distribution::Kind::uniform, .from = 2, .to = 6}, 0.25), 3);
  EXPECT_DOUBLE_EQ(number_at({.kind = Distribution::Kind::log_uniform, .from = 1, .to = 100}, 0.5), 10);
  // Half of the normal distribution between 0 and 2σ lies below the x with Φ(x) = (Φ(0) + Φ(2))/2.
  const Distribution cut{.kind = Distribution::Kind::normal, .from = 0, .to = 1, .least = 0, .most = 2};
  const double median = number_at(cut, 0.5);
  EXPECT_NEAR(std::erf(median / std::sqrt(2)), std::erf(2 / std::sqrt(2)) / 2, 1e-12);
  EXPECT_DOUBLE_EQ(
      number_at({.kind = Distribution::Kind::normal, .from = 3, .to = 0, .least = 3, .most = 3}, 0.1), 3);
}

TEST(Distribution, WholeNumbersAreAllAlikeAndBothEndsOccur) {
  const Distribution dice{.kind = Distribution::Kind::integer, .from = 1, .to = 6};
  std::vector<int> count(7);
  for (int i = 0; i < 6000; ++i) ++count[static_cast<std::size_t>(number_at(dice, (i + 0.5) / 6000))];
  for (std::size_t face = 1; face <= 6; ++face) EXPECT_EQ(count[face], 1000) << face;
  EXPECT_EQ(number_at(dice, std::nextafter(1.0, 0.0)), 6);
}

TEST(Distribution, ChoicesComeByTheirWeights) {
  Distribution choice{.values = {std::string("a"), std::string("b")}, .weights = {1, 3}};
  EXPECT_EQ(std::get<std::string>(choice.at(0.2499)), "a");
  EXPECT_EQ(std::get<std::string>(choice.at(0.2501)), "b");
  choice.weights.clear();
  EXPECT_EQ(std::get<std::string>(choice.at(0.49)), "a");
  EXPECT_EQ(std::get<std::string>(choice.at(0.999)), "b");
}

const std::string start =
    R"({"format": "petzval-dataset/1", "items": 10, "parameters": {"lens": "dgauss-50mm",
  "sensor": "example-vga", "scene": "studio", "f_number": {"uniform": [2.8, 8]}})";

TEST(Recipe, ADrawDoesNotDependOnOtherParameters) {
  const Recipe few = parse_recipe(start + "}", "recipe");
  std::string more = start;
  more.insert(more.rfind('}'), R"(, "defocus_mm": {"normal": [0, 0.1]}, "build": {"integer": [0, 99]})");
  const Recipe many = parse_recipe(more + "}", "recipe");
  for (std::size_t item : {0u, 1u, 9u})
    EXPECT_EQ(draw_item(few, item).at("f_number"), draw_item(many, item).at("f_number"));
  EXPECT_NE(draw_item(few, 0).at("f_number"), draw_item(few, 1).at("f_number"));
  EXPECT_NE(draw_item(few, 0), draw_item(parse_recipe(start + R"(, "seed": 2})", "recipe"), 0));
}

TEST(Recipe, DrawsFollowTheirLaw) {
  // Of n draws the mean lies within 4 standard errors; a whole generator that is off by a part in 50 does
  // not.
  const Recipe recipe = parse_recipe(start + "}", "recipe");
  const int n = 20000;
  double sum = 0, squares = 0;
  for (int i = 0; i < n; ++i) {
    const double u =
        (std::get<double>(draw_item(recipe, static_cast<std::size_t>(i)).at("f_number")) - 2.8) / 5.2;
    sum += u, squares += u * u;
  }
  EXPECT_NEAR(sum / n, 0.5, 4 * std::sqrt(1.0 / 12 / n));
  EXPECT_NEAR(squares / n, 1.0 / 3, 4 * std::sqrt(4.0 / 45 / n));
}

TEST(Recipe, SaysWhatIsWrongAndWhere) {
  const auto message = [](std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    text.replace(at, from.size(), to);
    try {
      parse_recipe(text, "recipe.json");
      return std::string("no error");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  const std::string good = start + "}";
  for (const auto& [from, to, expected] : std::vector<std::array<std::string, 3>>{
           {"\"items\": 10", "\"items\": 0", "recipe.json:1: items is 0; a number from 1"},
           {"\"items\": 10", "\"items\": 1.5", "a whole number would be right"},
           {"\"items\": 10", "\"items\": 10, \"seed\": 9007199254740993", "a number from 0 to"},
           {"\"items\": 10", "\"items\": 10, \"about\": 0", "about must be"},
           {"\"f_number\": {", "\"build\": 1e-300, \"f_number\": {", "a whole number would be right"},
           {"\"f_number\": {", "\"build\": {\"choose\": [1, 2.5]}, \"f_number\": {",
            "a whole number would be right"},
           {"\"f_number\": {", "\"sensor_serial\": {\"uniform\": [1, 3]}, \"f_number\": {",
            "\"integer\" would be right"},
           {"petzval-dataset/1", "petzval-dataset/2", "\"petzval-dataset/1\" would be right"},
           {"f_number", "fnumber", "is no parameter; there are lens, grade"},
           {"[2.8, 8]", "[8, 2.8]", "has its ends the wrong way round"},
           {"[2.8, 8]", "[2.8]", "two would be right"},
           {"{\"uniform\": [2.8, 8]}", "{\"uniform\": [2.8, 8], \"choose\": [3]}",
            "one of them would be right"},
           {"{\"uniform\": [2.8, 8]}", "{\"log_uniform\": [-1, 8]}", "a number from"},
           {"{\"uniform\": [2.8, 8]}", "{\"choose\": []}", "is empty"},
           {"{\"uniform\": [2.8, 8]}", "{\"choose\": [2, 4], \"weights\": [1]}",
            "has 1 numbers for 2 values"},
           {"{\"uniform\": [2.8, 8]}", "{\"normal\": [4, 1], \"within\": [20, 30]}", "leaves no value"},
           {"{\"uniform\": [2.8, 8]}", "\"wide\"", "f_number must be"},
           {"\"scene\": \"studio\"", "\"scene\": {\"folder\": \"/no/such/folder\"}", "cannot be read"},
           {"\"scene\": \"studio\"", "\"scene\": {\"uniform\": [1, 2]}", "uniform"},
           {"\"scene\": \"studio\", ", "", "neither a scene nor a world"},
           {"\"lens\": \"dgauss-50mm\",", "", "has no lens"},
           {"\"scene\": \"studio\"", "\"scene\": \"studio\", \"world\": \"spheres\"", "both scene and world"},
           {"\"scene\": \"studio\"", "\"scene\": \"studio\", \"stop_down_ev\": 1",
            "both f_number and stop_down_ev"},
           {"\"scene\": \"studio\"", "\"scene\": \"studio\", \"grade\": \"high\"", "a grade without a build"},
           {"\"items\": 10", "\"items\": 10, \"build_tolerances\": [\"radius_percent@2=0.1\"]",
            "is without a build"},
           {"\"items\": 10", "\"items\": 10, \"build_tolerances\": [\"radius\"]", "is not a tolerance"},
           {"\"scene\": \"studio\"", "\"scene\": \"studio\", \"light_scale@0\": 2", "which is of a world"},
           {"\"scene\": \"studio\"", "\"scene\": \"studio\", \"state\": \"tele\", \"state_number\": 1",
            "both state and state_number"},
           {"\"scene\": \"studio\"", "\"scene\": \"studio\", \"camera_x\": 1", "camera_x"},
           {"\"scene\": \"studio\"", "\"world\": \"spheres\", \"camera_x\": {\"uniform\": [-1e308, 1e308]}",
            "farther apart"},
           {"\"scene\": \"studio\"",
            "\"world\": \"spheres\", \"light_scale@0\": {\"log_uniform\": [1e-310, 1]}", "farther apart"},
           {"\"items\": 10", "\"items\": 10, \"truth\": [\"normals\"]", "needs a world"},
           {"\"items\": 10", "\"items\": 10, \"truth\": [\"masks\"]", "needs a world"},
           {"\"scene\": \"studio\"", "\"world\": \"spheres\", \"rolling_shutter\": 0.5", "stands still"},
           {"\"scene\": \"studio\"", "\"world\": \"spheres\", \"camera_move_x\": 0.5", "all three"},
           {"\"items\": 10", "\"items\": 10, \"truth\": [\"depths\"]",
            "depth, normals, albedo, masks, flow would be right"},
           {"\"items\": 10", "\"items\": 10, \"psf_grid\": {\"size\": 30}", "is even"},
           {"\"items\": 10", "\"items\": 10, \"wavelengths_nm\": \"700:10:400\"", "wavelengths_nm"},
           {"\"items\": 10", "\"itemz\": 10", "itemz"}})
    EXPECT_NE(message(good, from, to).find(expected), std::string::npos)
        << to << ": " << message(good, from, to);
}

}  // namespace
}  // namespace petzval
