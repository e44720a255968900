// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/isp/demosaic.h>

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
