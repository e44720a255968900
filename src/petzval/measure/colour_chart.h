// SPDX-License-Identifier: BSD-3-Clause
// How far the colours of a ColorChecker in a picture are from those of the chart.
#pragma once

#include <petzval/colour/cielab.h>
#include <petzval/colour/spectrum.h>
#include <petzval/measure/viewed_picture.h>

#include <array>
#include <string>
#include <vector>

namespace petzval {

/// Patches of the chart, the six greys along the bottom.
inline constexpr int chart_columns = 6, chart_rows = 4;

/// Where the chart is: the centres of its corner patches, in pixels (pixel centres at half-integers): dark
/// skin, bluish green, black, white, which is top left, top right, bottom right, bottom left of an upright
/// chart.
struct ChartCorners {
  std::array<std::array<double, 2>, 4> xy{};
};

struct PatchDifference {
  std::string name;
  double x = 0, y = 0;  ///< its centre
  Lab seen, wanted;
  double delta_e_ab = 0, delta_e_2000 = 0;
};

struct ChartDifference {
  std::vector<PatchDifference> patches;  ///< the 24, row by row
  double exposure = 1;                   ///< what luminances were multiplied by
  double mean_delta_e_ab = 0, mean_delta_e_2000 = 0, max_delta_e_2000 = 0;
};

/// The colours that the chart has under a light, adapted (Bradford) to the display's white. Y of white is 1.
std::vector<Xyz> chart_colours(const Spectrum& light);

/// Compares the means over the middle half of each patch with the chart under `light`.
/// \param match_exposure  multiply luminances so that the six greys agree best (least squares in Y).
/// \throws InputError for corners outside the picture.
ChartDifference compare_chart(const ViewedPicture& picture, const ChartCorners& corners,
                              const Spectrum& light, bool match_exposure = true);

/// Finds a ColorChecker: patches of even colour are sought, every two that could be neighbours in a row
/// propose a grid, and the grid whose colours come nearest to the chart's is taken and fitted to the patches
/// found. Perspective up to a few per cent. \throws InputError if no grid comes within ΔE 25 on average.
ChartCorners find_chart(const ViewedPicture& picture, const Spectrum& light);

}  // namespace petzval
