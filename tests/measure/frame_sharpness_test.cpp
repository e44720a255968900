// SPDX-License-Identifier: BSD-3-Clause
// What many edges say about a lens over the frame, from edges that were made up.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/measure/sfr/frame_sharpness.h>

#include <cmath>

namespace petzval {
namespace {

constexpr int frame_columns = 1200, frame_rows = 800;

/// An edge at a place of the picture, its normal turned from +x towards +y.
MeasuredEdge made_up(double x, double y, double normal_deg, double mtf50) {
  MeasuredEdge edge;
  edge.exact.line.centre_x = x, edge.exact.line.centre_y = y;
  edge.exact.line.normal_rad = normal_deg * M_PI / 180;
  edge.exact.mtf.assign(9, {});
  edge.exact.mtf[4] = {0.5, mtf50, 0.001};
  return edge;
}

TEST(FrameSharpness, EdgesAreNamedByTheWayTheyBlur) {
  const std::vector<MeasuredEdge> edges{
      made_up(1100, 400, 3, 0.3),     // upright, right of the middle: it lies along a circle
      made_up(1100, 400, 93, 0.3),    // level, right of the middle: it points to the middle
      made_up(600, 100, 88, 0.3),     // level, above the middle
      made_up(600, 100, -178, 0.3),   // upright, above the middle
      made_up(900, 100, 0, 0.3),      // upright, at 45°
      made_up(900, 100, -45, 0.3),    // its normal points to the upper right, as the place does
      made_up(1100, 400, 183, NAN)};  // not measured
  const std::vector<EdgeInFrame> placed = edges_in_frame(edges, frame_columns, frame_rows);
  ASSERT_EQ(placed.size(), 6u);
  const EdgeDirection expected[] = {EdgeDirection::meridional, EdgeDirection::sagittal,
                                    EdgeDirection::meridional, EdgeDirection::sagittal,
                                    EdgeDirection::oblique,    EdgeDirection::meridional};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(placed[i].direction, expected[i]) << i;
  EXPECT_DOUBLE_EQ(placed[0].height_px, 500);
  EXPECT_DOUBLE_EQ(placed[2].y_px, 300);
  EXPECT_NEAR(placed[5].outward, 1, 1e-12);
  EXPECT_NEAR(placed[2].outward, -std::cos(2 * M_PI / 180), 1e-12);
}

std::vector<MeasuredEdge> many_edges(double (*mtf50)(double x, double y)) {
  std::vector<MeasuredEdge> edges;
  for (double x = 60; x < frame_columns; x += 90)
    for (double y = 50; y < frame_rows; y += 75)
      edges.push_back(made_up(x, y, 5, mtf50(x - 0.5 * frame_columns, 0.5 * frame_rows - y)));
  return edges;
}

TEST(FrameSharpness, ASurfaceFollowsTheLens) {
  // A tilted plane comes back but for the little that slopes are held down; of a bowl, local planes lose half
  // its curvature times the mean square of the distance within the neighbourhood: below 0.005 here.
  const auto plane = [](double x, double y) { return 0.3 + 1e-4 * x - 5e-5 * y; };
  const auto bowl = [](double x, double y) { return 0.35 - 2e-7 * (x * x + y * y); };
  for (const auto& [truth, tolerance] :
       {std::pair<double (*)(double, double), double>{plane, 0.004}, {bowl, 0.008}}) {
    const auto placed = edges_in_frame(many_edges(truth), frame_columns, frame_rows);
    const SharpnessSurface surface = sharpness_surface(placed, frame_columns, frame_rows);
    ASSERT_EQ(surface.columns, 60);
    ASSERT_EQ(surface.rows, 40);
    for (int r = 0; r < surface.rows; ++r)
      for (int c = 0; c < surface.columns; ++c)
        EXPECT_NEAR(surface.mtf50_cpp[static_cast<std::size_t>(r * surface.columns + c)],
                    truth((c - 29.5) * 20, (19.5 - r) * 20), tolerance)
            << c << " " << r;
  }
  const auto placed = edges_in_frame(many_edges(bowl), frame_columns, frame_rows);
  const std::vector<double> heights{100, 300, 600};
  const std::vector<double> values = sharpness_over_height(placed, heights);
  for (std::size_t i = 0; i < heights.size(); ++i) EXPECT_NEAR(values[i], bowl(heights[i], 0), 0.005);
}

TEST(FrameSharpness, WhereNoEdgesAreThereIsNoValue) {
  const std::vector<MeasuredEdge> one{made_up(100, 100, 5, 0.3)};
  const auto placed = edges_in_frame(one, frame_columns, frame_rows);
  const SharpnessSurface surface = sharpness_surface(placed, frame_columns, frame_rows);
  EXPECT_NEAR(surface.mtf50_cpp[static_cast<std::size_t>(5 * surface.columns + 5)], 0.3, 1e-6);
  EXPECT_TRUE(std::isnan(surface.mtf50_cpp.back()));
  EXPECT_TRUE(std::isnan(sharpness_surface({}, frame_columns, frame_rows).mtf50_cpp.front()));
  EXPECT_THROW(sharpness_surface(placed, 0, 10), InputError);
}

TEST(FrameSharpness, LateralColourComesFromEdgesOfAnyDirection) {
  // Red lies 0.8 h + 0.3 h³ pixels farther out; an edge sees the part along its normal.
  std::vector<MeasuredEdge> edges = many_edges([](double, double) { return 0.3; });
  const double half = 0.5 * std::hypot(frame_columns, frame_rows);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    MeasuredEdge& edge = edges[i];
    edge.channel = "red";
    edge.exact.line.normal_rad = 0.7 * static_cast<double>(i);
    const std::vector<EdgeInFrame> at = edges_in_frame(std::span(&edge, 1), frame_columns, frame_rows);
    const double h = at[0].height_px / half;
    edge.lateral_offset_px = at[0].outward * (0.8 * h + 0.3 * h * h * h);
  }
  const auto placed = edges_in_frame(edges, frame_columns, frame_rows);
  const std::optional<LateralColour> red = lateral_colour(placed, "red", half);
  ASSERT_TRUE(red);
  EXPECT_NEAR(red->linear_px, 0.8, 1e-4);
  EXPECT_NEAR(red->cubic_px, 0.3, 2e-4);
  EXPECT_NEAR(red->at(1), 1.1, 1e-4);
  EXPECT_LT(red->rms_residual_px, 1e-4);
  EXPECT_FALSE(lateral_colour(placed, "blue", half));
}

}  // namespace
}  // namespace petzval
