// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/report/lens_drawing.h>
#include <petzval/report/surface_profile.h>

#include <cmath>

#include "report/markup_checker.h"

namespace petzval {
namespace {

using test::markup_fault;
using test::occurrences;

Surface surface(double radius, double thickness, double index, std::optional<double> semi_diameter = {}) {
  Surface s;
  s.curvature_per_mm = radius == 0 ? 0 : 1 / radius;
  s.thickness_mm = thickness;
  if (index > 1) s.material = Material(Material::Constant{index});
  s.semi_diameter_mm = semi_diameter;
  return s;
}

/// A cemented doublet, a stop, a singlet: three elements, six surfaces.
Lens three_elements() {
  Lens lens;
  lens.name = "doublet & singlet";
  lens.surfaces = {surface(30, 5, 1.5, 10), surface(-30, 2, 1.7, 9), surface(0, 4, 1, 8),
                   surface(0, 3, 1, 5),     surface(25, 3, 1.6, 7),  surface(-25, 20, 1, 7)};
  lens.surfaces[3].stop = true;
  return lens;
}

TEST(Profile, LiesOnTheSphere) {
  for (const double radius : {12.0, -40.0}) {
    const auto points = profile(surface(radius, 1, 1.5), 3, 9);
    EXPECT_EQ(points.front()[1], -9);
    EXPECT_EQ(points.back()[1], 9);
    // The circle's own equation; rounding of numbers of order 10³.
    for (const auto& [z, y] : points)
      EXPECT_NEAR(std::hypot(z - 3 - radius, y), std::abs(radius), 1e-12 * 1e3);
    EXPECT_EQ(std::signbit(points.back()[0] - 3), std::signbit(radius));
  }
}

TEST(Profile, FollowsConicsAndAspheres) {
  Surface paraboloid = surface(10, 1, 1.5);
  paraboloid.conic = -1;
  EXPECT_NEAR(profile(paraboloid, 0, 4).back()[0], 4.0 * 4 / (2 * 10), 1e-14);
  paraboloid.asphere = {{4, 1e-3}};
  EXPECT_NEAR(profile(paraboloid, 0, 4).front()[0], 0.8 + 0.256, 1e-14);
  EXPECT_TRUE(std::isnan(profile(surface(8, 1, 1.5), 0, 9).front()[0]));
}

TEST(ElementOutline, JoinsRimsAtTheLargerSemiDiameter) {
  const auto outline =
      element_outline(profile(surface(30, 5, 1.5), 0, 6), profile(surface(-30, 5, 1.5), 5, 9));
  double highest = 0;
  bool annulus = false;
  const double rim_z = 30 - std::sqrt(900.0 - 36);
  for (const auto& [z, y] : outline) {
    highest = std::max(highest, y);
    annulus = annulus || (y == 9 && std::abs(z - rim_z) < 1e-12);
  }
  EXPECT_EQ(highest, 9);
  EXPECT_TRUE(annulus) << "the front carries on as a flat annulus";
}

TEST(ElementOutline, UsesAConeWhereACylinderWouldCross) {
  const auto front = profile(surface(10, 1, 1.5), 0, 5), back = profile(surface(-10, 1, 1.5), 1, 8);
  EXPECT_EQ(element_outline(front, back).size(), front.size() + back.size());
}

TEST(SemiDiameters, ComeFromLensThenOptionsThenRaysThenNeighbours) {
  Lens lens = three_elements();
  lens.surfaces[1].semi_diameter_mm.reset();
  lens.surfaces[2].semi_diameter_mm.reset();
  lens.surfaces[3].semi_diameter_mm.reset();
  lens.surfaces[5].semi_diameter_mm.reset();
  const DrawnRay ray{{{-10, 6}, {7, 6}, {11, 4}, {30, 0}}, ""};
  LensDrawingOptions options;
  options.semi_diameters_mm = {1, 8.5};
  const auto drawn = drawn_semi_diameters_mm(lens, {ray}, options);
  EXPECT_EQ(drawn[0], 10);
  EXPECT_EQ(drawn[1], 8.5);
  EXPECT_NEAR(drawn[2], 6 * 1.04, 1e-12);  // a point of the ray on the flat at z = 7
  EXPECT_NEAR(drawn[3], 4, 1e-12);         // the stop at z = 11: exactly
  EXPECT_EQ(drawn[4], 7);
  EXPECT_GT(drawn[5], 0);
  EXPECT_EQ(drawn_semi_diameters_mm(lens, {}, {})[3], 7);  // nothing known: the nearest neighbour
}

TEST(SemiDiameters, CrossingsOfStraightStretchesCount) {
  Lens lens;
  lens.surfaces = {surface(0, 10, 1.5)};
  const DrawnRay ray{{{-10, 0}, {10, 4}}, ""};
  EXPECT_NEAR(drawn_semi_diameters_mm(lens, {ray}, {})[0], 2 * 1.04, 1e-12);
}

TEST(SemiDiameters, StayInsideTheRimOfASphere) {
  Lens lens;
  lens.surfaces = {surface(5, 10, 1.5, 50)};
  EXPECT_LT(drawn_semi_diameters_mm(lens, {}, {})[0], 5);
}

TEST(LensDrawing, HoldsEveryPart) {
  LensDrawingOptions options;
  options.title = "a < b";
  options.legend = {{"0°", "#0072b2"}, {"14°", "#d55e00"}};
  const std::vector<DrawnRay> rays{{{{-10, 2}, {40, 0}}, "#0072b2"}, {{{-10, -2}, {NAN, 3}, {40, 0}}, ""}};
  const std::string svg = draw_lens(three_elements(), rays, options);
  EXPECT_EQ(markup_fault(svg), "");
  EXPECT_FALSE(test::has_non_finite_numbers(svg));
  EXPECT_EQ(occurrences(svg, "class=\"pz-glass\""), 3);
  EXPECT_EQ(occurrences(svg, "stroke-opacity=\"0.9\""), 2);  // rays
  EXPECT_EQ(occurrences(svg, "stroke-width=\"2.4\""), 2);    // both sides of the stop
  for (const char* number : {">0<", ">1<", ">2<", ">3<", ">4<", ">5<"})
    EXPECT_EQ(occurrences(svg, number), 1) << number;
  EXPECT_EQ(occurrences(svg, " mm</text>"), 1);  // the scale bar
  EXPECT_EQ(occurrences(svg, ">14°<"), 1);
  EXPECT_EQ(svg, draw_lens(three_elements(), rays, options));
}

TEST(LensDrawing, DrawsAirGapsAsDashesAndImmersionAsGlass) {
  Lens lens;
  lens.surfaces = {surface(0, 2, 1), surface(20, 30, 1.33, 5)};
  const std::string svg = draw_lens(lens, {});
  EXPECT_EQ(occurrences(svg, "stroke-dasharray=\"3 3\""), 1);  // the dummy surface
  EXPECT_EQ(occurrences(svg, "class=\"pz-glass\""), 1);        // the water up to the image
}

// Rays that come in from far outside are cut at the left edge of the picture, not at its lower one.
TEST(LensDrawing, MakesRoomForSlantedRays) {
  Lens lens;
  lens.surfaces = {surface(0, 10, 1.5, 5)};
  const auto height = [](const std::string& svg) {
    const std::size_t at = svg.find("height=\"") + 8;
    return std::stod(svg.substr(at, svg.find('"', at) - at));
  };
  const DrawnRay slanted{{{-1000, -500}, {0, 0}, {10, 0}}, ""};  // half a mm up for each mm along
  LensDrawingOptions options;
  options.lead_mm = 12;  // there the ray is 6 mm below the axis, the lens only 5 mm
  options.image_half_height_mm = 1;
  EXPECT_GT(height(draw_lens(lens, {slanted}, options)), height(draw_lens(lens, {}, options)));
  options.lead_mm = 8;  // 4 mm
  EXPECT_EQ(height(draw_lens(lens, {slanted}, options)), height(draw_lens(lens, {}, options)));
}

TEST(LensDrawing, StandsAbsurdLenses) {
  const Lens empty;
  EXPECT_THROW(draw_lens(empty, {}), InputError);
  for (const double size : {1e-300, 1e-12, 1e12, 1e200}) {
    Lens lens = three_elements();
    for (Surface& s : lens.surfaces) {
      s.curvature_per_mm /= size;
      s.thickness_mm *= -size;
      s.semi_diameter_mm = size;
      s.asphere = {{20, 1e30}};
    }
    const std::string svg = draw_lens(lens, {{{{-INFINITY, NAN}, {1e308, -1e308}}, ""}, {{}, ""}});
    EXPECT_EQ(markup_fault(svg), "") << size;
    EXPECT_FALSE(test::has_non_finite_numbers(svg)) << size;
  }
}

}  // namespace
}  // namespace petzval
