// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/colour/display.h>
#include <petzval/colour/illuminants.h>
#include <petzval/measure/chart_scielab.h>
#include <petzval/measure/colour_chart.h>
#include <petzval/numeric/random.h>

#include <cmath>
#include <random>

namespace petzval {
namespace {

/// A chart of the right colours on grey, turned by an angle, its patches 0.8 of a pitch wide.
ViewedPicture drawn_chart(int columns, int rows, double x, double y, double pitch, double angle,
                          double exposure) {
  const std::vector<Xyz> colours = chart_colours(illuminant("D65"));
  ViewedPicture picture{columns, rows, {}};
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const double dx = c + 0.5 - x, dy = r + 0.5 - y;
      const double u = (std::cos(angle) * dx + std::sin(angle) * dy) / pitch,
                   v = (-std::sin(angle) * dx + std::cos(angle) * dy) / pitch;
      const double column = std::floor(u + 0.5), row = std::floor(v + 0.5);
      Xyz colour = 0.3 * display_white();
      if (column >= 0 && column < 6 && row >= 0 && row < 4) {
        const bool inside = std::abs(u - column) < 0.4 && std::abs(v - row) < 0.4;
        colour = inside ? colours[static_cast<std::size_t>(6 * row + column)] : 0.02 * display_white();
      }
      picture.pixels.push_back(exposure * colour);
    }
  return picture;
}

TEST(ChartColours, WhiteIsNearlyWhiteAndBlackNearlyBlack) {
  const std::vector<Xyz> colours = chart_colours(illuminant("D65"));
  ASSERT_EQ(colours.size(), 24u);
  // Charts differ and fade: this white reflects 0.82, where the maker states 0.9.
  EXPECT_GT(colours[18].y, 0.8);
  EXPECT_LT(colours[18].y, 0.95);
  EXPECT_LT(colours[23].y, 0.05);
  // Paint's white is yellowish; the grey in the middle is neutral, after adaptation.
  const Lab grey = cielab(colours[21], display_white());
  EXPECT_LT(std::hypot(grey.a, grey.b), 2);
}

TEST(FindChart, FindsDrawnCharts) {
  for (const double angle : {0.0, 0.3, -1.2, 3.0})
    for (const double exposure : {1.0, 0.4}) {
      const double pitch = 50;
      const double x = 320 - pitch * (2.5 * std::cos(angle) - 1.5 * std::sin(angle));
      const double y = 240 - pitch * (2.5 * std::sin(angle) + 1.5 * std::cos(angle));
      const ViewedPicture picture = drawn_chart(640, 480, x, y, pitch, angle, exposure);
      const ChartCorners corners = find_chart(picture, illuminant("D65"));
      // Patches of 40 px; the picture is halved for the search.
      EXPECT_NEAR(corners.xy[0][0], x, 4) << angle;
      EXPECT_NEAR(corners.xy[0][1], y, 4) << angle;
      const ChartDifference difference = compare_chart(picture, corners, illuminant("D65"));
      EXPECT_LT(difference.max_delta_e_2000, 1e-6) << angle;
      EXPECT_NEAR(difference.exposure, 1 / exposure, 1e-9);
    }
}

// A patch is 40 px wide: its centre is to be told from its quarter.
TEST(FindChart, FindsChartsInTheDarkAndInNoise) {
  std::mt19937 random(7);
  for (const double exposure : {1.0, 0.01})
    for (const double deviation : {0.0, 0.005, 0.01}) {
      ViewedPicture picture = drawn_chart(640, 480, 195, 165, 50, 0, exposure);
      std::normal_distribution<double> noise(0, deviation * exposure);
      for (Xyz& colour : picture.pixels) colour = colour + Xyz{noise(random), noise(random), noise(random)};
      SCOPED_TRACE(fmt::format("exposure {}, noise {}", exposure, deviation));
      ChartCorners corners;
      ASSERT_NO_THROW(corners = find_chart(picture, illuminant("D65")));
      EXPECT_NEAR(corners.xy[2][0], 445, 10);
      EXPECT_NEAR(corners.xy[2][1], 315, 10);
    }
}

TEST(FindChart, DoesNotFindWhatIsNotThere) {
  ViewedPicture picture{64, 48, std::vector<Xyz>(64 * 48, display_white())};
  EXPECT_THROW(find_chart(picture, illuminant("D65")), InputError);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i)
    if ((i / 8 + i / (64 * 8)) % 2) picture.pixels[i] = {0, 0, 0};
  EXPECT_THROW(find_chart(picture, illuminant("D65")), InputError);
}

TEST(CompareChart, RefusesCornersThatSpanNoChart) {
  const ViewedPicture picture = drawn_chart(640, 480, 195, 165, 50, 0, 1);
  const ChartCorners wrong[] = {{{{{0, 0}, {0, 0}, {0, 0}, {0, 0}}}},                   // a point
                                {{{{195, 165}, {445, 165}, {345, 165}, {245, 165}}}},   // a line
                                {{{{195, 165}, {445, 315}, {445, 165}, {195, 315}}}},   // crossed
                                {{{{195, 165}, {200, 165}, {200, 168}, {195, 168}}}}};  // a pixel a patch
  for (const ChartCorners& corners : wrong)
    EXPECT_THROW(compare_chart(picture, corners, illuminant("D65")), InputError);
}

TEST(CompareChart, GivesTheDifferenceOfAKnownShift) {
  ViewedPicture picture = drawn_chart(640, 480, 195, 165, 50, 0, 1);
  const ChartCorners corners{{{{195, 165}, {445, 165}, {445, 315}, {195, 315}}}};
  for (Xyz& pixel : picture.pixels) {
    Lab lab = cielab(pixel, display_white());
    lab.a += 3, lab.b += 4;
    pixel = xyz_of(lab, display_white());
  }
  const ChartDifference difference = compare_chart(picture, corners, illuminant("D65"));
  for (const PatchDifference& patch : difference.patches) EXPECT_NEAR(patch.delta_e_ab, 5, 1e-6);
  EXPECT_EQ(difference.patches[0].name, "dark skin");
  EXPECT_THROW(
      compare_chart(picture, {{{{-195, 165}, {445, 165}, {445, 315}, {195, 315}}}}, illuminant("D65")),
      InputError);
}

TEST(ChartScielab, SeesWhatMeansOfPatchesDoNot) {
  const double pitch = 50;
  const Spectrum light = illuminant("D65");
  ViewedPicture picture = drawn_chart(400, 300, 75, 75, pitch, 0, 1);
  const ChartCorners corners{{{{75, 75}, {325, 75}, {325, 225}, {75, 225}}}};
  const auto seen = [&](double per_degree) {
    const ChartDifference difference = compare_chart(picture, corners, light, false);
    return chart_scielab(picture, corners, difference, light, per_degree);
  };
  constexpr double near = 10, far = 300;
  for (const double patch : seen(near)) EXPECT_LT(patch, 1e-3);  // floats
  // An even shift of an even surface is what CIELAB says, at any distance.
  for (Xyz& pixel : picture.pixels) pixel = 1.1 * pixel;
  const ChartDifference shifted = compare_chart(picture, corners, light, false);
  for (const double per_degree : {near, far}) {
    const std::vector<double> patches = seen(per_degree);
    for (std::size_t i = 0; i < patches.size(); ++i)
      EXPECT_NEAR(patches[i], shifted.patches[i].delta_e_ab, 1e-3) << i;
  }
  // Noise of mean zero is seen from near and not from far.
  picture = drawn_chart(400, 300, 75, 75, pitch, 0, 1);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i)
    picture.pixels[i] = std::max(0.0, 1 + 0.1 * RandomStream(1, 1, i).normal()) * picture.pixels[i];
  const std::vector<double> from_near = seen(near), from_far = seen(far);
  for (std::size_t i = 0; i < from_near.size(); ++i) {
    EXPECT_GT(from_near[i], 0.5) << i;
    EXPECT_LT(from_far[i], 0.5 * from_near[i]) << i;
  }
  EXPECT_THROW(seen(2), InputError);
}

}  // namespace
}  // namespace petzval
