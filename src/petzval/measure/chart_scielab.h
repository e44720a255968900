// SPDX-License-Identifier: BSD-3-Clause
// A ColorChecker in a picture as an eye at a distance sees it.
#pragma once

#include <petzval/measure/colour_chart.h>

#include <vector>

namespace petzval {

/// Mean S-CIELAB difference of each of the 24 patches from the colour that the chart has under `light`:
/// unlike the difference of the patch's mean it has in it what the eye sees of noise and artefacts. The
/// middle of each patch is compared with an even surface, both mirrored at their edges. \param difference  of
/// compare_chart(), whose exposure the picture is multiplied by. \param pixels_per_degree  as scielab().
/// \throws InputError for patches of less than three pixels.
std::vector<double> chart_scielab(const ViewedPicture& picture, const ChartCorners& corners,
                                  const ChartDifference& difference, const Spectrum& light,
                                  double pixels_per_degree);

}  // namespace petzval
