// SPDX-License-Identifier: BSD-3-Clause
// Test charts of any size, at any wavelengths. Edges are antialiased by exact area.
#pragma once

#include <petzval/scene/chart_canvas.h>

#include <cstdint>

namespace petzval {

/// Squares of reflectance 1 and 0, `squares_across` from edge to edge; the middle of the picture is a corner
/// of four of them if that number is even, the middle of one if it is odd. (Fig. 10 of Maeda, Catrysse &
/// Wandell 2005.)
Scene checkerboard_chart(const ChartOptions& options, int squares_across = 16);

/// The 24 patches of a ColorChecker, measured reflectances, six by four on a black board on grey, as large as
/// fits.
Scene colorchecker_chart(const ChartOptions& options);

/// White single samples on black, `points_across` × `points_across` in the middles of equal cells.
Scene point_chart(const ChartOptions& options, int points_across = 9);

/// Dark lines on white, `squares_across` squares between those at the left and right edges: what is straight
/// in the scene. Lines run through the middle of the picture if that number is even. They are a tenth of a
/// square wide.
Scene grid_chart(const ChartOptions& options, int squares_across = 16);

/// White everywhere.
Scene wall_chart(const ChartOptions& options);

/// Dark (0.2, left) and light (0.8, right) halves: the contrast of 4:1 of ISO 12233. The edge goes through
/// the middle of the picture and leans by an angle from the vertical, its upper end to the right.
Scene slanted_edge_chart(const ChartOptions& options, double angle_deg = 5);

/// A chart in which every defect of a lens shows: a line grid to the corners (distortion, field curvature),
/// Siemens stars, slanted squares and bars (blur, lateral colour), ColorChecker and grey steps (colour,
/// veiling light), lettering, on an even grey texture (shading). All reflectances are measured ones or
/// multiples of them. Laid out for 4:3; other shapes get more background.
Scene studio_chart(const ChartOptions& options);

/// Three cards one in front of the other, at 0.6, 1 and 1.8 times the chart's distance (1 m unless given),
/// and at 4 times it a dark wall with small lamps. It has depth.
Scene cards_chart(const ChartOptions& options);

/// A checkerboard on a plane that recedes from 2/3 of the chart's distance (1 m unless given) on the left to
/// twice that on the right, in perspective. It has depth.
Scene slanted_plane_chart(const ChartOptions& options);

/// Grey discs that cover each other as fallen leaves do, with radii from 1.5 samples to a quarter of the
/// shorter side in the density r^-3 and reflectances evenly from 0.1 to 0.9: texture whose statistics are
/// those of natural pictures and the same at every scale (Lee, Mumford & Huang 2001; ISO/TS 19567-2). A seed,
/// a picture.
Scene dead_leaves_chart(const ChartOptions& options, std::uint64_t seed = 1);

/// Paints a ColorChecker into a rectangle [pixels] whose width is 1.45 times its height
/// (colorchecker_aspect).
void draw_colorchecker(ChartCanvas& canvas, Point corner, double width);
inline constexpr double colorchecker_aspect = 6.3 / 4.3;

}  // namespace petzval
