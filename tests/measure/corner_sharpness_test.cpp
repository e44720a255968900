// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/measure/sfr/corner_sharpness.h>

#include <cmath>

namespace petzval {
namespace {

/// An edge whose middle is at a place of the picture.
MeasuredEdge edge_at(double x_px, double y_px, double mtf50_cpp, const std::string& channel = "") {
  MeasuredEdge edge;
  edge.channel = channel;
  edge.exact.line.centre_x = x_px, edge.exact.line.centre_y = y_px;
  edge.exact.mtf.assign(9, {});
  edge.exact.mtf[4] = {0.5, mtf50_cpp, 0.01};
  return edge;
}

TEST(CornerSharpness, IsTheMeanOfEachCornersEdges) {
  const std::vector<MeasuredEdge> edges{edge_at(10, 10, 0.2),   edge_at(30, 20, 0.3),
                                        edge_at(190, 10, 0.2),  edge_at(5, 145, 0.15),
                                        edge_at(195, 140, 0.3), edge_at(100, 75, 0.01)};
  const CornerSharpness corners = corner_sharpness(edges, 200, 150);
  EXPECT_DOUBLE_EQ(corners.mtf50_cpp[0], 0.25);  // top left: rows run down
  EXPECT_DOUBLE_EQ(corners.mtf50_cpp[1], 0.2);
  EXPECT_DOUBLE_EQ(corners.mtf50_cpp[2], 0.15);
  EXPECT_DOUBLE_EQ(corners.mtf50_cpp[3], 0.3);
  EXPECT_DOUBLE_EQ(corners.least_cpp, 0.15);
  EXPECT_DOUBLE_EQ(corners.symmetry, 0.5);
  EXPECT_FALSE(corners.colour_px) << "of one colour";
}

TEST(CornerSharpness, SaysWhatIsMissingAndHowFarColoursLieOff) {
  std::vector<MeasuredEdge> edges{edge_at(10, 10, 0.2, "green"), edge_at(10, 10, 0.1, "red"),
                                  edge_at(10, 10, 0.1, "blue")};
  edges[1].lateral_offset_px = 0.3, edges[2].lateral_offset_px = -0.4;
  const CornerSharpness corners = corner_sharpness(edges, 200, 150);
  EXPECT_DOUBLE_EQ(corners.mtf50_cpp[0], 0.2);
  EXPECT_TRUE(std::isnan(corners.mtf50_cpp[3]));
  EXPECT_TRUE(std::isnan(corners.least_cpp));
  EXPECT_DOUBLE_EQ(*corners.colour_px, std::sqrt((0.09 + 0.16) / 2));
}

}  // namespace
}  // namespace petzval
