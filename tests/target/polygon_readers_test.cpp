// SPDX-License-Identifier: BSD-3-Clause
// Polygon and SVG readers on good, odd and hostile files.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/target/formats/polygon_file.h>
#include <petzval/target/formats/svg_path.h>
#include <petzval/target/formats/svg_shapes.h>
#include <petzval/target/polygon.h>
#include <petzval/target/test_charts.h>
#include <petzval/target/visible_regions.h>

#include <cmath>
#include <functional>
#include <random>

namespace petzval {
namespace {

std::string fault_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(PolygonFile, ReadsMtfMappersFormatAndMore) {
  const TargetScene scene = parse_polygons(
      "5 10 10 50 10 50 50 10 50 10 10 # closed\nground 0.9\nlevel 0.25\n"
      "3 1 1 2 1 1.5 2\nhole 3 1.4 1.2 1.6 1.2 1.5 1.4",
      "a.txt");
  ASSERT_EQ(scene.polygons.size(), 2u);
  EXPECT_EQ(scene.polygons[0].contours[0].size(), 4u) << "a corner that repeats another is dropped";
  EXPECT_EQ(scene.ground, 0.9);
  EXPECT_EQ(scene.polygons[0].level, 0);
  EXPECT_EQ(scene.polygons[1].level, 0.25);
  EXPECT_EQ(scene.polygons[1].contours.size(), 2u);
  EXPECT_EQ(scene.polygons[1].line, 4);
}

TEST(PolygonFile, SaysWhatIsWrongAndWhere) {
  const auto fault = [](const std::string& text) {
    return fault_of([&] { validate(parse_polygons(text, "p.txt")); });
  };
  EXPECT_NE(fault("4\n1 1\n2 x\n").find("p.txt:3: 'x'"), std::string::npos);
  EXPECT_NE(fault("4\n1 1\n2 2\n").find("the file ends"), std::string::npos);
  EXPECT_NE(fault("2 1 1 2 2").find("at least three"), std::string::npos);
  EXPECT_NE(fault("-7 1 1 2 2").find("at least three"), std::string::npos);
  EXPECT_NE(fault("99999999999999 1 1 2 2").find("up to"), std::string::npos);
  EXPECT_NE(fault("").find("no polygon"), std::string::npos);
  EXPECT_NE(fault("# nothing").find("no polygon"), std::string::npos);
  EXPECT_NE(fault("hole 3 1 1 2 2 3 1").find("before any polygon"), std::string::npos);
  EXPECT_NE(fault("3 1 1 nan 2 3 1").find("'nan'"), std::string::npos);
  EXPECT_NE(fault("\n\n4 0 0 10 10 10 0 0 10").find("p.txt:3: polygon 1: its outline crosses"),
            std::string::npos);
}

TEST(SvgPath, KnowsEveryCommand) {
  // Areas in closed form: a square, a disc of arcs, a parabola's segment, a cubic's.
  const auto area = [](const char* data) {
    double sum = 0;
    for (const Contour& contour : parse_svg_path(data, {})) sum += std::abs(signed_area(contour));
    return sum;
  };
  EXPECT_NEAR(area("M1,1h10v10H1z"), 100, 1e-12);
  EXPECT_NEAR(area("m1 1 10 0 0 10-10 0Z m 20 0 l 1 0 0 1 z"), 100.5, 1e-12);
  EXPECT_NEAR(area("M -5 0 A 5 5 0 0 1 5 0 A 5 5 0 0 1 -5 0 Z"), 25 * pi, 5e-3);
  EXPECT_NEAR(area("M0 0 A10 5 0 1 1 20 0 A10 5 0 0 1 0 0z"), 50 * pi, 1e-2) << "two half ellipses";
  EXPECT_NEAR(area("M0 0 Q 5 10 10 0 Z"), 2.0 / 3 * 10 * 5, 1e-3);
  EXPECT_NEAR(area("M0 0 Q 5 10 10 0 T 20 0 V -20 H 0 Z"), 400, 1e-3) << "one bump up, its reflection down";
  EXPECT_NEAR(area("M0 0 C 0 10 10 10 10 0 S 20 -10 20 0 V -20 H 0 Z"), 400, 1e-3);
  EXPECT_EQ(parse_svg_path("M0 0h1v1z", {}, 1e-4).size(), 1u);
}

TEST(SvgPath, Transforms) {
  const SvgTransform t = parse_svg_transform("translate(10 20) rotate(90) scale(2)");
  EXPECT_NEAR(t({1, 0}).x, 10, 1e-12);
  EXPECT_NEAR(t({1, 0}).y, 22, 1e-12);
  const SvgTransform about = parse_svg_transform("rotate(180, 5, 5)");
  EXPECT_NEAR(about({0, 0}).x, 10, 1e-12);
  EXPECT_THROW(parse_svg_transform("translate(1"), InputError);
  EXPECT_THROW(parse_svg_transform("jump(3)"), InputError);
}

TEST(SvgPath, SaysWhatIsWrong) {
  const auto fault = [](const char* data) { return fault_of([&] { parse_svg_path(data, {}); }); };
  EXPECT_NE(fault("M 0 0 L 1 1").find("open"), std::string::npos);
  EXPECT_NE(fault("L 1 1 Z").find("begins with M"), std::string::npos);
  EXPECT_NE(fault("M 0 0 X 3").find("command"), std::string::npos);
  EXPECT_NE(fault("M 0 0 L 1 Z").find("number"), std::string::npos);
  EXPECT_NE(fault("M 0 0 A 1 1 0 2 0 3 3 Z").find("flag"), std::string::npos);
  EXPECT_NE(fault("M 0 0 C 1e300 0 0 1e300 1 1 Z").find("too large"), std::string::npos);
  EXPECT_NE(fault("3 4").find("without a command"), std::string::npos);
}

TEST(SvgShapes, LevelsGroupsAndRules) {
  const TargetScene scene = parse_svg_shapes(
      R"svg(<svg><g fill="#fff" transform="translate(5 0)"><rect x="1" y="2" width="3" height="4"/></g>
         <circle cx="10" cy="10" r="3" style="fill: rgb(0, 0, 0)"/><path fill="none" d="M0 0"/>
         <path d="M0 0h10v10h-10z M2 2h6v6h-6z"/><path fill-rule="evenodd" d="M0 0h10v10h-10z M2 2h6v6h-6z"/></svg>)svg",
      "d.svg");
  ASSERT_EQ(scene.polygons.size(), 4u);
  EXPECT_EQ(scene.polygons[0].level, 1);
  EXPECT_NEAR(scene.polygons[0].contours[0][0].x, 6, 1e-12);
  EXPECT_EQ(scene.polygons[1].level, 0);
  EXPECT_EQ(scene.polygons[2].contours.size(), 1u)
      << "both wind the same way: no hole under the non-zero rule";
  EXPECT_EQ(scene.polygons[3].contours.size(), 2u);
}

double area_of(const TargetScene& scene) {
  double area = 0;
  for (const Region& region : visible_regions(scene))
    for (const Contour& contour : region.contours) area += signed_area(contour);
  return area;
}

TEST(PolygonFile, ARuleSaysWhatACrossedOutlineEncloses) {
  // A pentagram about a circle of radius 50: its points alone, or with the pentagon that they stand on.
  std::string star = "5";
  for (int i = 0; i < 5; ++i)
    star += " " + std::to_string(100 + 50 * std::sin(2 * M_PI * 2 * i / 5)) + " " +
            std::to_string(100 - 50 * std::cos(2 * M_PI * 2 * i / 5));
  // The pentagon within has the radius 50 cos 72°/cos 36°; a star is the ten triangles between the circles.
  const double inner = 50 * std::cos(72 * M_PI / 180) / std::cos(36 * M_PI / 180);
  const double pentagon = 2.5 * inner * inner * std::sin(72 * M_PI / 180);
  const double whole = 5 * 50 * inner * std::sin(36 * M_PI / 180);
  // Corners are written to 1e-6 and cut to 2^-24 pixels.
  const auto scene = [&](const char* rule) { return parse_polygons(rule + star, "star"); };
  EXPECT_NEAR(area_of(scene("rule nonzero ")), whole, 1e-3);
  EXPECT_NEAR(area_of(scene("rule evenodd ")), whole - pentagon, 1e-3);
  EXPECT_NO_THROW(validate(scene("rule nonzero ")));
  EXPECT_NO_THROW(validate(scene("rule evenodd ")));
  EXPECT_THROW(validate(scene("")), InputError);
  EXPECT_THROW(validate(scene("rule nonzero rule simple ")), InputError);
  EXPECT_THROW(scene("rule odd "), InputError);
  // A bow tie is two triangles that touch.
  const TargetScene tie = parse_polygons("rule evenodd 4 0 0 10 10 10 0 0 10", "tie");
  EXPECT_EQ(tie.polygons.size(), 2u);
  EXPECT_NO_THROW(validate(tie));
  EXPECT_NEAR(area_of(tie), 50, 1e-6);
  // An outline that does not cross itself keeps its corners.
  EXPECT_EQ(parse_polygons("rule nonzero 3 0.1 0 10 10 10.7 0", "plain").polygons[0].contours[0][0].x, 0.1);
}

TEST(SvgShapes, StyleSheets) {
  const auto level = [](const std::string& css, const std::string& attributes) {
    return parse_svg_shapes(
               "<svg><style>" + css + "</style><rect width='9' height='9' " + attributes + "/></svg>", "s")
        .polygons[0]
        .level;
  };
  EXPECT_EQ(level(".a{fill:#fff}", "class='b a'"), 1);
  EXPECT_EQ(level("rect{fill:white}", "fill='black'"), 1);
  EXPECT_EQ(level("rect{fill:white}", "style='fill:black'"), 0);
  EXPECT_EQ(level(".a{fill:white} rect{fill:black}", "class='a'"), 1);
  EXPECT_EQ(level("#x{fill:white} .a{fill:black}", "class='a' id='x'"), 1);
  EXPECT_EQ(level(".a{fill:black} /* } */ .b, rect.a{fill:white}", "class='a'"), 1);
  EXPECT_EQ(level(".a{fill:white}", "class='ab'"), 0);
  EXPECT_EQ(level("circle{fill:white} *{stroke:none}", "fill='black'"), 0);
  EXPECT_THROW(level("g > rect{fill:white}", ""), InputError);
  EXPECT_THROW(level(".a{fill:white", ""), InputError);
}

TEST(SvgShapes, SizesAndRoundedCorners) {
  const auto area = [](const std::string& root, const std::string& rectangle) {
    return area_of(parse_svg_shapes("<svg " + root + "><rect fill='black' " + rectangle + "/></svg>", "s"));
  };
  // Corners of radii a and b take (4 − π) a b; chords stay within 1e-4 pixels.
  EXPECT_NEAR(area("", "width='60' height='40' rx='10'"), 2400 - (4 - M_PI) * 100, 0.01);
  EXPECT_NEAR(area("", "width='60' height='40' rx='10' ry='5'"), 2400 - (4 - M_PI) * 50, 0.01);
  EXPECT_NEAR(area("", "width='60' height='40' rx='100'"), 2400 - (4 - M_PI) * 30 * 20, 0.01);
  // 96 pixels to the inch, the viewBox fitted in.
  const double per_mm = 96 / 25.4;
  EXPECT_NEAR(area("width='100mm' viewBox='0 0 100 50'", "width='10' height='10'"), 100 * per_mm * per_mm,
              1e-6);
  EXPECT_NEAR(area("width='200' height='300' viewBox='0,0,100,100'", "width='10' height='10'"), 400, 1e-6);
  const TargetScene middle = parse_svg_shapes(
      "<svg width='200' height='300' viewBox='5 5 100 100'><rect x='5' y='5' width='10' height='10'/></svg>",
      "s");
  EXPECT_EQ(middle.polygons[0].contours[0][0], (Vertex{0, 50}));
  EXPECT_NEAR(area("width='100%' viewBox='0 0 7 7'", "width='10' height='10'"), 100, 1e-6);
  for (const char* root : {"width='10furlongs'", "width='-3' viewBox='0 0 1 1'", "width='9' viewBox='0 0 1'",
                           "width='9' viewBox='0 0 0 1'"})
    EXPECT_THROW(area(root, "width='10' height='10'"), InputError) << root;
}

TEST(SvgShapes, RefusesWhatItWouldGetWrong) {
  const auto fault = [](const std::string& body) {
    return fault_of([&] { parse_svg_shapes("<svg>" + body + "</svg>", "d.svg"); });
  };
  EXPECT_NE(fault("<text>Hi</text>").find("convert it to a path"), std::string::npos);
  EXPECT_NE(fault("<rect width='3' height='3' stroke='red'/>").find("strokes"), std::string::npos);
  EXPECT_NE(fault("<rect width='3' height='3' fill='url(#g)'/>").find("fill"), std::string::npos);
  EXPECT_NE(fault("<rect width='3cm' height='3'/>").find("pixels"), std::string::npos);
  EXPECT_NE(fault("<path id='p' d='M 0 0 L 1 1'/>").find("<path> 'p': at character"), std::string::npos);
  EXPECT_NE(fault("").find("no filled shape"), std::string::npos);
  EXPECT_NE(fault_of([] { parse_svg_shapes("<svg><rect", "d.svg"); }).find("no sound XML"),
            std::string::npos);
  EXPECT_NE(fault_of([] { parse_svg_shapes("<html/>", "d.svg"); }).find("root"), std::string::npos);
  std::string deep;
  for (int i = 0; i < 5000; ++i) deep += "<g>";
  EXPECT_NE(fault(deep).find("d.svg"), std::string::npos);
}

TEST(PolygonReaders, SurviveEveryTruncationAndRandomDamage) {
  // Each ends in a scene or in an InputError.
  const std::string text = "ground 0.9 level 0.1 4 10 10 50 10 50 50 10 50 hole 3 20 20 40 20 30 40";
  const std::string svg =
      R"svg(<svg><g transform="rotate(5 3 3) matrix(1 0 0 1 2 3)"><path fill="#123456" d="M1 1C2 3 4 5 6 7S1 2 3 4Q1 1 2 2T3 3A1 2 3 0 1 9 9z"/></g></svg>)svg";
  std::mt19937 random(11);
  for (const std::string& good : {text, svg}) {
    const auto read = [&](const std::string& content) {
      fault_of([&] { parse_polygons(content, "x"); });
      fault_of([&] { parse_svg_shapes(content, "x"); });
      fault_of([&] { parse_svg_path(content, {}); });
      fault_of([&] { parse_svg_transform(content); });
    };
    for (std::size_t n = 0; n < good.size(); ++n) read(good.substr(0, n));
    for (int i = 0; i < 3000; ++i) {
      std::string bad = good;
      for (int k = 0; k < 3; ++k) bad[random() % bad.size()] = static_cast<char>(random() % 256);
      read(bad);
    }
  }
}

TEST(TestCharts, AreSoundInManySizes) {
  for (const std::string& name : test_chart_names())
    for (const auto& [columns, rows] : {std::pair{64, 64}, {640, 480}, {300, 900}})
      EXPECT_NO_THROW(validate(test_chart(name, columns, rows))) << name;
  EXPECT_NE(fault_of([] { test_chart("simens", 100, 100); }).find("siemens"), std::string::npos);
  EXPECT_THROW(test_chart("siemens", 10, 10), InputError);
}

}  // namespace
}  // namespace petzval
