// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/colour/display.h>
#include <petzval/colour/spectra_files.h>
#include <petzval/measure/colour_chart.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

constexpr std::size_t first_grey = 18;

/// Bilinear between the corners.
std::array<double, 2> patch_centre(const ChartCorners& corners, double row, double column) {
  const double u = column / (chart_columns - 1), v = row / (chart_rows - 1);
  std::array<double, 2> at{};
  for (std::size_t k = 0; k < 2; ++k)
    at[k] = (1 - v) * ((1 - u) * corners.xy[0][k] + u * corners.xy[1][k]) +
            v * ((1 - u) * corners.xy[3][k] + u * corners.xy[2][k]);
  return at;
}

/// Mean over the parallelogram between ±share of the way to the neighbours' centres.
Xyz patch_mean(const ViewedPicture& picture, const ChartCorners& corners, int row, int column) {
  constexpr double share = 0.2;  // patches fill about 0.85 of the pitch; the middle half of them is wanted
  constexpr int steps = 40;
  Xyz sum;
  int count = 0;
  for (int i = 0; i < steps; ++i)
    for (int k = 0; k < steps; ++k) {
      const auto at = patch_centre(corners, row + share * (2.0 * i / (steps - 1) - 1),
                                   column + share * (2.0 * k / (steps - 1) - 1));
      if (!(at[0] >= 0 && at[1] >= 0 && at[0] < picture.columns && at[1] < picture.rows))
        throw InputError(
            fmt::format("a patch of the chart at ({:.0f}, {:.0f}) lies outside the picture of {} x {} pixels",
                        at[0], at[1], picture.columns, picture.rows));
      sum = sum + picture.at(static_cast<int>(at[1]), static_cast<int>(at[0]));
      ++count;
    }
  return (1.0 / count) * sum;
}

/// \throws InputError unless the corners span a convex figure whose patches have a few pixels.
void check_corners(const ChartCorners& corners) {
  constexpr int cells = (chart_columns - 1) * (chart_rows - 1);
  constexpr double least_px2 = 4;  // of a patch with its border
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto &a = corners.xy[i], &b = corners.xy[(i + 1) % 4], &c = corners.xy[(i + 2) % 4];
    const double turn = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
    least = std::min(least, turn), greatest = std::max(greatest, turn);
  }
  // Twice the area of a triangle, as the chart is twice the triangles: the least is no more than its area.
  if (least < cells * least_px2 && -greatest < cells * least_px2)
    throw InputError(
        fmt::format("the corners of the chart span no patches of {:g} pixels; the centres of dark skin, "
                    "bluish green, black and white, in this order, would be right",
                    least_px2));
}

double grey_exposure(const std::vector<Xyz>& seen, const std::vector<Xyz>& wanted) {
  double sw = 0, ss = 0;
  for (std::size_t i = first_grey; i < seen.size(); ++i)
    sw += seen[i].y * wanted[i].y, ss += seen[i].y * seen[i].y;
  return ss > 0 ? sw / ss : 1;
}

}  // namespace

std::vector<Xyz> chart_colours(const Spectrum& light) {
  const SpectrumSet chart = read_spectrum_set("colorchecker_reflectance");
  const Observer& eye = Observer::cie_1931();
  const Xyz white = eye.xyz(light);
  if (!(white.y > 0)) throw InputError("a chart needs light that the eye sees");
  const ColourMatrix adapt = bradford_adaptation((1 / white.y) * white, display_white());
  std::vector<Xyz> colours;
  for (const NamedSpectrum& patch : chart.spectra) {
    std::vector<double> values;
    for (const double nm : light.wavelengths_nm())
      values.push_back(light.at(nm) * patch.spectrum.at_extended(nm));
    colours.push_back(adapt * ((1 / white.y) * eye.xyz(Spectrum(light.wavelengths_nm(), values))));
  }
  return colours;
}

ChartDifference compare_chart(const ViewedPicture& picture, const ChartCorners& corners,
                              const Spectrum& light, bool match_exposure) {
  check_corners(corners);
  const std::vector<Xyz> wanted = chart_colours(light);
  const SpectrumSet chart = read_spectrum_set("colorchecker_reflectance");
  std::vector<Xyz> seen;
  for (int row = 0; row < chart_rows; ++row)
    for (int column = 0; column < chart_columns; ++column)
      seen.push_back(patch_mean(picture, corners, row, column));
  ChartDifference result;
  if (match_exposure) result.exposure = grey_exposure(seen, wanted);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const auto at =
        patch_centre(corners, static_cast<double>(i / chart_columns), static_cast<double>(i % chart_columns));
    PatchDifference patch{chart.spectra[i].name,
                          at[0],
                          at[1],
                          cielab(result.exposure * seen[i], display_white()),
                          cielab(wanted[i], display_white()),
                          0,
                          0};
    patch.delta_e_ab = delta_e_ab(patch.seen, patch.wanted);
    patch.delta_e_2000 = delta_e_2000(patch.seen, patch.wanted);
    result.mean_delta_e_ab += patch.delta_e_ab / static_cast<double>(seen.size());
    result.mean_delta_e_2000 += patch.delta_e_2000 / static_cast<double>(seen.size());
    result.max_delta_e_2000 = std::max(result.max_delta_e_2000, patch.delta_e_2000);
    result.patches.push_back(patch);
  }
  return result;
}

}  // namespace petzval
