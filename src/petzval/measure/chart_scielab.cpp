// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/measure/chart_scielab.h>
#include <petzval/measure/scielab.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// Half the side of the square about a patch's centre that is looked at: a fifth of the way to the nearest
/// neighbour's, within the patch at every angle of the chart.
int half_side_px(const ChartCorners& corners) {
  constexpr double share = 0.2, columns_between = 5, rows_between = 3;
  const auto distance = [&](std::size_t a, std::size_t b) {
    return std::hypot(corners.xy[a][0] - corners.xy[b][0], corners.xy[a][1] - corners.xy[b][1]);
  };
  const double pitch = std::min({distance(0, 1) / columns_between, distance(3, 2) / columns_between,
                                 distance(0, 3) / rows_between, distance(1, 2) / rows_between});
  return static_cast<int>(share * pitch);
}

ViewedPicture square_about(const ViewedPicture& picture, const PatchDifference& patch, int half,
                           double exposure) {
  const int left = static_cast<int>(patch.x) - half, top = static_cast<int>(patch.y) - half,
            side = 2 * half + 1;
  if (left < 0 || top < 0 || left + side > picture.columns || top + side > picture.rows)
    throw InputError(
        fmt::format("the patch {} at ({:.0f}, {:.0f}) reaches beyond the picture of {} x {} pixels",
                    patch.name, patch.x, patch.y, picture.columns, picture.rows));
  ViewedPicture square{side, side, {}};
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      square.pixels.push_back(exposure * picture.at(top + row, left + column));
  return square;
}

}  // namespace

std::vector<double> chart_scielab(const ViewedPicture& picture, const ChartCorners& corners,
                                  const ChartDifference& difference, const Spectrum& light,
                                  double pixels_per_degree) {
  const int half = half_side_px(corners);
  if (half < 1)
    throw InputError("patches of the chart are less than three pixels wide: too few to see noise in");
  const std::vector<Xyz> wanted = chart_colours(light);
  std::vector<double> means;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const ViewedPicture square = square_about(picture, difference.patches[i], half, difference.exposure);
    const ViewedPicture even{square.columns, square.rows, std::vector<Xyz>(square.pixels.size(), wanted[i])};
    means.push_back(scielab(square, even, pixels_per_degree).mean);
  }
  return means;
}

}  // namespace petzval
