// SPDX-License-Identifier: BSD-3-Clause
// Large tiles about the axis and small ones at the rim.
#include "imaging/synthetic_table.h"

#include <gtest/gtest.h>
#include <petzval/imaging/exact_blur.h>
#include <petzval/imaging/product_blur.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace petzval {
namespace {

using namespace testing;

/// Light that spreads ever faster with height.
LensDataTable soft_at_the_rim() {
  TableRecipe recipe;
  recipe.fields = {0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20};
  recipe.height_mm = [](double field, double) { return 0.5 * std::tan(radians(field)); };
  recipe.psf = [](double field, double) {
    const double wide = 2 + 4 * std::pow(field / 20, 8);
    return psf_of_spots({{0, 0, wide, wide, 1}}, 129, 0.5);
  };
  return make_table(recipe);
}

struct Zones {
  LensDataTable table = soft_at_the_rim();
  LightCentres centres{table};
  SensorGeometry cells{144, 108, 2000 * table.real_image_height_mm.back() / std::hypot(144, 108)};
  PsfField psfs{table, 550, cells.pitch_um, PsfInterpolation::psf, centres};

  ProductPlan tiles(int tile, int nodes, const CellRing& zone) const {
    ProductPlan plan;
    plan.tile = tile;
    plan.nodes = nodes;
    plan.zone = zone;
    plan.transform = *std::ranges::find_if(TileTransform::sizes,
                                           [&](int size) { return size >= tile + 2 * psfs.radius(); });
    return plan;
  }
  ProductPlan two_zones(double radius) const {
    ProductPlan plan = tiles(9, 4, {radius - ProductPlan::fade, INFINITY});
    plan.inner = {tiles(36, 3, {0, radius})};
    return plan;
  }
  double error_of(const ProductPlan& plan, const CellPlane& source) const {
    return relative_l2(ProductBlur(psfs, cells, plan).blur(source, 0), blur_exact(source, psfs, 0));
  }
};

double sum_of(const CellPlane& plane) {
  return std::accumulate(plane.values.begin(), plane.values.end(), 0.0);
}

// Where both zones have the same tiles, it does not matter which of them a cell's light takes.
TEST(ProductZones, WithTheSameTilesAreOne) {
  const Zones zones;
  const CellPlane source = texture(zones.cells);
  for (const double radius : {30.0, 50.0}) {
    ProductPlan plan = zones.tiles(12, 3, {radius - ProductPlan::fade, INFINITY});
    plan.inner = {zones.tiles(12, 3, {0, radius})};
    const CellPlane one =
        ProductBlur(zones.psfs, zones.cells, zones.tiles(12, 3, whole_frame)).blur(source, 0);
    EXPECT_LT(relative_l2(ProductBlur(zones.psfs, zones.cells, plan).blur(source, 0), one), 1e-6) << radius;
  }
}

// Large tiles are at their worst at the rim: small ones there bring the error down, to no less than small
// ones everywhere.
TEST(ProductZones, MendTheRim) {
  const Zones zones;
  const CellPlane source = texture(zones.cells);
  const double small = zones.error_of(zones.tiles(9, 4, whole_frame), source),
               large = zones.error_of(zones.tiles(36, 3, whole_frame), source),
               both = zones.error_of(zones.two_zones(50), source);
  EXPECT_LT(small, both);
  EXPECT_LT(both, large);
}

// Blur is linear: zones are what large tiles make of the light within, and small ones of the rest.
TEST(ProductZones, BlurTheLightOfEachByItsOwnTiles) {
  const Zones zones;
  constexpr double radius = 50;
  CellPlane inner = texture(zones.cells), outer = inner;
  const CellPlane source = inner;
  for (std::size_t row = 0; row < source.rows(); ++row)
    for (std::size_t column = 0; column < source.columns(); ++column) {
      const double from_axis = std::hypot(double(column) - 71.5, double(row) - 53.5);
      const double share = std::clamp((radius - from_axis) / ProductPlan::fade, 0.0, 1.0);
      inner.row(row)[column] *= static_cast<float>(share);
      outer.row(row)[column] *= static_cast<float>(1 - share);
    }
  const auto blurred = [&](int tile, int nodes, const CellPlane& light) {
    return ProductBlur(zones.psfs, zones.cells, zones.tiles(tile, nodes, whole_frame)).blur(light, 0);
  };
  CellPlane sum = blurred(36, 3, inner);
  const CellPlane rest = blurred(9, 4, outer);
  for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += rest.values[i];
  EXPECT_LT(relative_l2(ProductBlur(zones.psfs, zones.cells, zones.two_zones(radius)).blur(source, 0), sum),
            1e-6);
}

// All light is in one zone or the other: shares add up to 1 for every cell, wherever the zones meet.
TEST(ProductZones, KeepAllLight) {
  const Zones zones;
  const int reach = zones.psfs.radius();
  CellPlane source(zones.cells);
  for (std::size_t row = 0; row < source.rows(); ++row)
    for (std::size_t column = 0; column < source.columns(); ++column)
      if (std::min({static_cast<int>(row), static_cast<int>(column),
                    zones.cells.rows - 1 - static_cast<int>(row),
                    zones.cells.columns - 1 - static_cast<int>(column)}) >= reach)
        source.row(row)[column] = 1;
  for (const double radius : {20.0, 47.5, 60.0}) {
    const CellPlane image = ProductBlur(zones.psfs, zones.cells, zones.two_zones(radius)).blur(source, 0);
    EXPECT_NEAR(sum_of(image) / sum_of(source), 1, 1e-6) << radius;
  }
}

// Transfer functions of some rows at a time are those of all.
TEST(ProductZones, AreTheSameRowByRow) {
  const Zones zones;
  const CellPlane source = texture(zones.cells);
  ProductPlan plan = zones.two_zones(50);
  const CellPlane all = ProductBlur(zones.psfs, zones.cells, plan).blur(source, 0);
  plan.rows_held = 2;
  plan.inner.front().rows_held = 1;
  EXPECT_LT(relative_l2(ProductBlur(zones.psfs, zones.cells, plan).blur(source, 0), all), 1e-6);
}

TEST(MirroredBlur, IsTheExactOne) {
  const Zones zones;
  for (const int columns : {61, 64}) {
    const CellPlane source = texture({columns, 49, zones.cells.pitch_um});
    EXPECT_LT(relative_l2(blur_mirrored(source, zones.psfs, 3), blur_exact(source, zones.psfs, 3)), 1e-6);
  }
}

}  // namespace
}  // namespace petzval
