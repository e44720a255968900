// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/isp/demosaic.h>

#include <numeric>
#include <random>

#include "mosaic_samples.h"

namespace petzval {
namespace {

using test::bayer;
using test::rms_error;

const char* const orders[] = {"RGGB", "BGGR", "GRBG", "GBRG"};
/// Every method that there is; those added later are held to the same.
std::vector<std::string> all_names() {
  std::vector<std::string> names;
  for (const DemosaicMethod& method : demosaic_methods()) names.push_back(method.name);
  return names;
}
const std::vector<std::string> all = all_names();

TEST(Demosaic, UniformColoursAreExact) {
  const test::Picture picture = [](int channel, int, int) { return 0.2 + 0.3 * channel; };
  for (const char* order : orders)
    for (const std::string& method : all)
      for (const auto& [columns, rows] : {std::pair(40, 150), std::pair(7, 5), std::pair(2, 2)})
        EXPECT_LT(rms_error(demosaiced(bayer(columns, rows, order, picture), method), picture, 0), 1e-6)
            << order << " " << method << " " << columns;
}

TEST(Demosaic, GreyRampsAreExactInside) {
  // All three kinds of filters reproduce polynomials of the first degree; 1e-6: floats.
  const test::Picture picture = [](int, int r, int c) { return 0.1 + 0.004 * c + 0.003 * r; };
  for (const char* order : orders)
    for (const std::string& method : all)
      EXPECT_LT(rms_error(demosaiced(bayer(60, 90, order, picture), method), picture, 8), 1e-6)
          << order << " " << method;
}

TEST(Demosaic, MeasuredValuesAreKept) {
  const test::Picture picture = [](int channel, int r, int c) {
    return 0.5 + 0.4 * std::sin(r * 1.3 + c * 2.1 + channel);
  };
  for (const char* order : orders)
    for (const std::string& method : all) {
      const LinearMosaic mosaic = bayer(30, 20, order, picture);
      const Planes planes = demosaiced(mosaic, method);
      for (int r = 0; r < 20; ++r)
        for (int c = 0; c < 30; ++c) {
          const auto at = static_cast<std::size_t>(30 * r + c);
          EXPECT_EQ(planes.values[static_cast<std::size_t>(mosaic.mosaic.channel(r, c))][at],
                    mosaic.values[at]);
        }
    }
}

TEST(Demosaic, MalvarIsThePublishedFilter) {
  // Figure 2 of the paper, times 8: an impulse at every place of the 5 x 5 neighbourhood of one pixel in
  // turn.
  const double green_at_red[5][5] = {
      {0, 0, -1, 0, 0}, {0, 0, 2, 0, 0}, {-1, 2, 4, 2, -1}, {0, 0, 2, 0, 0}, {0, 0, -1, 0, 0}};
  const double red_at_green_in_red_row[5][5] = {
      {0, 0, 0.5, 0, 0}, {0, -1, 0, -1, 0}, {-1, 4, 5, 4, -1}, {0, -1, 0, -1, 0}, {0, 0, 0.5, 0, 0}};
  const double red_at_blue[5][5] = {
      {0, 0, -1.5, 0, 0}, {0, 2, 0, 2, 0}, {-1.5, 0, 6, 0, -1.5}, {0, 2, 0, 2, 0}, {0, 0, -1.5, 0, 0}};
  const auto response = [](int row, int column, std::size_t plane, int r, int c) {
    LinearMosaic mosaic = bayer(12, 12, "RGGB", [](int, int, int) { return 0.0; });
    mosaic.values[static_cast<std::size_t>(12 * (row + r - 2) + column + c - 2)] = 1;
    return 8 * static_cast<double>(
                   demosaiced(mosaic, "malvar").values[plane][static_cast<std::size_t>(12 * row + column)]);
  };
  for (int r = 0; r < 5; ++r)
    for (int c = 0; c < 5; ++c) {
      EXPECT_NEAR(response(6, 6, 1, r, c), green_at_red[r][c], 1e-6);
      EXPECT_NEAR(response(6, 7, 0, r, c), red_at_green_in_red_row[r][c], 1e-6);
      EXPECT_NEAR(response(6, 7, 2, r, c), red_at_green_in_red_row[c][r], 1e-6);  // blue lies in the column
      EXPECT_NEAR(response(7, 7, 0, r, c), red_at_blue[r][c], 1e-6);
    }
}

TEST(Demosaic, BetterMethodsAreBetter) {
  // A grey zone plate up to 0.35 cycles a pixel on a ground whose colour changes slowly: what makes detail in
  // photographs is mostly the same in all channels. Each method must beat the one before it by a fifth at
  // least.
  const test::Picture picture = [](int channel, int r, int c) {
    const double y = r - 100, x = c - 100;
    return 0.5 + 0.3 * std::cos(3.14159265 * 0.35 / 100 * (x * x + y * y) / 2) +
           0.1 * std::sin(0.05 * c + 2 * channel);
  };
  const LinearMosaic mosaic = bayer(200, 200, "GRBG", picture);
  const double bilinear = rms_error(demosaiced(mosaic, "bilinear"), picture, 10);
  const double malvar = rms_error(demosaiced(mosaic, "malvar"), picture, 10);
  const double gradient = rms_error(demosaiced(mosaic, "gradient"), picture, 10);
  EXPECT_LT(malvar, 0.8 * bilinear);
  EXPECT_LT(gradient, 0.8 * malvar);
}

/// Rms of what a display's square-root curve makes of the difference, without `border` pixels.
double displayed_error(const Planes& planes, const test::Picture& picture, int border) {
  double sum = 0;
  int count = 0;
  for (int channel = 0; channel < 3; ++channel)
    for (int r = border; r < planes.rows - border; ++r)
      for (int c = border; c < planes.columns - border; ++c, ++count) {
        const auto found = static_cast<double>(
            planes
                .values[static_cast<std::size_t>(channel)][static_cast<std::size_t>(planes.columns * r + c)]);
        sum += std::pow(std::sqrt(std::max(0.0, found)) - std::sqrt(picture(channel, r, c)), 2);
      }
  return std::sqrt(sum / count);
}

TEST(Demosaic, RootsSuitColoursThatShadeInProportion) {
  // A coloured surface under light that falls to a twentieth between stripes: channels keep their ratios, and
  // differ most where it is bright. As in BetterMethodsAreBetter, a fifth at least, in light and as
  // displayed.
  const test::Picture picture = [](int channel, int r, int c) {
    const double reflectance[] = {0.8, 0.4, 0.15};
    const double shade = std::exp(1.5 * std::cos(1.1 * r + 0.6 * c) - 1.5);
    return reflectance[channel] * shade;
  };
  const LinearMosaic mosaic = bayer(120, 100, "GBRG", picture);
  const Planes root = demosaiced(mosaic, "root-gradient"), light = demosaiced(mosaic, "gradient");
  EXPECT_LT(rms_error(root, picture, 10), 0.8 * rms_error(light, picture, 10));
  EXPECT_LT(displayed_error(root, picture, 10), 0.8 * displayed_error(light, picture, 10));
}

TEST(Demosaic, LongerExposuresComeOutBrighterByAsMuch) {
  // 1e-5: the noise of single precision, a few operations long.
  const test::Picture picture = [](int channel, int r, int c) {
    return 0.5 + 0.45 * std::sin(r * 1.3 + c * 0.4 + channel);
  };
  const test::Picture darker = [&](int channel, int r, int c) { return picture(channel, r, c) / 64; };
  const Planes whole = demosaiced(bayer(60, 50, "RGGB", picture), "root-gradient");
  const Planes part = demosaiced(bayer(60, 50, "RGGB", darker), "root-gradient");
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < whole.values[k].size(); ++i)
      EXPECT_NEAR(64 * part.values[k][i], whole.values[k][i], 1e-5);
}

TEST(Demosaic, RootsOfNoiseAreTooDarkByNoMoreThanTheirCurvature) {
  // The mean of roots, squared, lies below the mean by at most variance / (4 level) to second order (Jensen);
  // a tenth of it more for the orders beyond at this noise of a fifth. Four standard errors: 1e-3 of the
  // level in 40,000 values, of which neighbours share some of their noise.
  std::mt19937 generator(7);
  std::normal_distribution<double> noise(0, 0.06);
  constexpr double level = 0.3;
  LinearMosaic mosaic = bayer(200, 200, "RGGB", [](int, int, int) { return level; });
  for (float& value : mosaic.values) value += static_cast<float>(noise(generator));
  const double measured = std::accumulate(mosaic.values.begin(), mosaic.values.end(), 0.0) / 40000;
  for (const std::vector<float>& plane : demosaiced(mosaic, "root-gradient").values) {
    const double mean = std::accumulate(plane.begin(), plane.end(), 0.0) / 40000;
    EXPECT_LT(mean, measured + 4 * 0.001 * level);
    EXPECT_GT(mean, measured - 1.1 * 0.06 * 0.06 / (4 * level) - 4 * 0.001 * level);
  }
}

TEST(Demosaic, ValuesBelowBlackStayFinite) {
  const test::Picture picture = [](int channel, int r, int c) {
    return 0.02 * std::sin(5.0 * r + 3.0 * c + channel);
  };
  for (const std::string& method : all)
    for (const std::vector<float>& plane : demosaiced(bayer(40, 30, "BGGR", picture), method).values)
      for (const float value : plane) EXPECT_LT(std::abs(value), 0.2f) << method;
  for (const std::vector<float>& plane :
       demosaiced(bayer(40, 30, "BGGR", [](int, int, int) { return 0.0; }), "root-gradient").values)
    for (const float value : plane) EXPECT_EQ(value, 0);
}

TEST(Demosaic, AnyMosaicComesOutFull) {
  const std::vector<std::string> names = {"red", "green", "blue", "white", "infrared"};
  const Mosaic mosaics[] = {{1, 2, {0, 1}},
                            {3, 3, {0, 1, 2, 3, 4, 0, 1, 2, 3}},
                            {4, 4, {0, 0, 1, 1, 0, 0, 1, 1, 1, 1, 2, 2, 1, 1, 2, 2}}};
  const test::Picture picture = [](int channel, int, int) { return 0.2 + 0.1 * channel; };
  for (const Mosaic& cells : mosaics) {
    const std::size_t channels =
        1 + static_cast<std::size_t>(*std::max_element(cells.cells.begin(), cells.cells.end()));
    for (const char* const method : {"bilinear", "general"}) {
      const LinearMosaic mosaic = test::mosaic_of(
          23, 17, cells, {names.begin(), names.begin() + static_cast<std::ptrdiff_t>(channels)}, picture);
      EXPECT_LT(rms_error(demosaiced(mosaic, method), picture, 0), 1e-6) << cells.rows << " " << method;
    }
    EXPECT_THROW(demosaiced(test::mosaic_of(23, 17, cells, names, picture), "gradient"), InputError);
  }
}

TEST(Demosaic, BytesDoNotDependOnThreads) {
  const test::Picture picture = [](int channel, int r, int c) {
    return std::sin(r * 0.7 + c * 0.3 + channel);
  };
  const LinearMosaic mosaic = bayer(90, 200, "RGGB", picture);
  for (const std::string& method : all) {
    const ThreadLimit one(1);
    const Planes a = demosaiced(mosaic, method);
    const ThreadLimit two(2);
    EXPECT_EQ(a.values, demosaiced(mosaic, method).values);
  }
}

}  // namespace
}  // namespace petzval
