// SPDX-License-Identifier: BSD-3-Clause
// Charts that are nothing but flat figures: scenes paint them in reflectances, exact targets in levels.
#pragma once

#include <petzval/scene/shape.h>

#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// What may follow a chart's name and a colon: a text, and the number that it is, if it is one.
struct ChartParameter {
  std::string text = {};
  std::optional<double> number = {};
};

/// Polygons of one level that do not overlap each other.
struct ChartFigure {
  std::vector<std::vector<Point>> outlines;
  double level = 0;  ///< 0 is black, 1 is white
};

/// Later figures cover earlier ones.
struct FigureChart {
  double ground = 1;
  std::vector<ChartFigure> figures;
};

/// The picture that a chart is laid out for [samples or pixels].
struct ChartFrame {
  double width = 0, height = 0;
  Point centre() const { return {0.5 * width, 0.5 * height}; }
  double side() const { return width < height ? width : height; }
};

/// A Siemens star of N (36) dark sectors. At a radius r the frequency is N/(2πr).
FigureChart siemens_figures(ChartFrame frame, const ChartParameter& sectors);

/// The resolution test target of MIL-STD-150A (USAF 1951): element e of group g has bars for 2^(g + (e −
/// 1)/6) line pairs per mm, five times as long as they are wide. Groups stand side by side, the first one (−2
/// unless told) on the left, until bars are finer than a third of a sample. A picture of 4:3 that is 24/2^g
/// mm wide shows the first group g at its size.
FigureChart usaf_figures(ChartFrame frame, const ChartParameter& first_group);

/// After ISO 12233: slanted squares of a contrast of 4:1, turned by 5°, in the middle, the corners and
/// between them, and hyperbolic wedges, upright and level, whose frequency grows evenly from 100 line widths
/// per picture height to N (a line width a sample), with figures beside them in hundreds.
FigureChart iso12233_figures(ChartFrame frame, const ChartParameter& most);

/// Dark discs on white for calibration, N (16) across, half as wide as their pitch.
FigureChart dots_figures(ChartFrame frame, const ChartParameter& across);

/// A chessboard for calibration, N (10) squares across within a white margin of a square. One of its two
/// numbers of squares is odd, so that no turn of 180° looks the same.
FigureChart chessboard_figures(ChartFrame frame, const ChartParameter& across);

/// Edges all over the frame: squares of a contrast of 4:1, N (12) across, side by side as on a checkerboard
/// and turned by 5° (clockwise in the picture). A light one has its middle in that of the frame.
FigureChart slanted_board_figures(ChartFrame frame, const ChartParameter& across);

/// A QR code (error correction M) or a Data Matrix that says a text, with its quiet zone as large as fits.
FigureChart qr_figures(ChartFrame frame, const ChartParameter& text);
FigureChart datamatrix_figures(ChartFrame frame, const ChartParameter& text);

}  // namespace petzval
