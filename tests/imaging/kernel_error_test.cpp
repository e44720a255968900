// SPDX-License-Identifier: BSD-3-Clause
#include "imaging/synthetic_table.h"

#include <gtest/gtest.h>
#include <petzval/imaging/distortion.h>
#include <petzval/imaging/exact_blur.h>
#include <petzval/imaging/kernel_error.h>
#include <petzval/imaging/product_blur.h>

#include <algorithm>
#include <cmath>

namespace petzval {
namespace {

using namespace testing;

constexpr double height_mm_per_tangent = 0.5;

/// Widths of light turn over from field to field where hardly any light falls.
LensDataTable unruly_where_it_is_dark() {
  TableRecipe recipe;
  recipe.fields = {0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20};
  recipe.height_mm = [](double field, double) { return height_mm_per_tangent * std::tan(radians(field)); };
  recipe.g_source_sr = [](double field) { return field < 13 ? 0.25 : 0.0025; };
  recipe.psf = [](double field, double) {
    const bool odd = std::fmod(field, 4) > 1;
    const double wide = 3 + 0.05 * field, further = field < 17 ? 0 : odd ? 3 : -1;
    return psf_of_spots({{0, 0, wide + further, wide - further / 2, 1}}, 129, 0.5);
  };
  return make_table(recipe);
}

// The estimate is of noise whose deviation is its mean, as the lens lets it in: such light is blurred with
// and without tiles. Without regard to the lens's light the dark part counts as the bright one does.
TEST(KernelError, CountsPlacesByTheirLight) {
  const LensDataTable table = unruly_where_it_is_dark();
  constexpr double nm = 550;
  const double height_mm = table.real_image_height_mm.back();
  const SensorGeometry cells{144, 108, 2000 * height_mm / std::hypot(144, 108)};
  const LightCentres centres(table);
  const SceneMap map(table, centres, {}, nm, Scene(64, 48, {nm}, 4, {}), height_mm);
  const PsfField psfs(table, nm, cells.pitch_um, PsfInterpolation::psf, centres);
  CellPlane source = texture(cells);
  for (std::size_t row = 0; row < source.rows(); ++row)
    for (std::size_t column = 0; column < source.columns(); ++column) {
      const ScenePlace place = map.place(cells.x_mm(double(column) + 0.5), cells.y_mm(double(row) + 0.5));
      float& light = source.row(row)[column];
      light = -std::log(std::max(1e-6F, light)) * static_cast<float>(place.g_source_sr);
    }
  ProductOptions layout;
  layout.tile = 18;
  layout.nodes = 2;
  const auto plan = plan_product(psfs, cells, layout);
  ASSERT_TRUE(plan);
  const double measured =
      relative_l2(ProductBlur(psfs, cells, *plan).blur(source, 0), blur_exact(source, psfs, 0));
  const double lit = kernel_error(psfs, {cells, 0, &map.look()}, layout.tile, layout.nodes).rms,
               blind = kernel_error(psfs, cells, layout.tile, layout.nodes).rms;
  // RMS over 64 places.
  EXPECT_NEAR(lit / measured, 1, 0.5) << lit << " for " << measured;
  EXPECT_GT(blind, 3 * measured);
}

// Half of the frame is dark: what is found of the other half is what is found of a frame that ends with it.
TEST(KernelError, IsOfWhatIsLit) {
  const LensDataTable table = make_table(comatic_recipe());
  constexpr double nm = 550;
  const LightCentres centres(table);
  const double height_mm = table.real_image_height_mm.back();
  const SceneMap map(table, centres, {}, nm, Scene(64, 48, {nm}, 4, {}), height_mm);
  const PsfField psfs(table, nm, 10, PsfInterpolation::psf, centres);
  const auto side = static_cast<int>(200 * height_mm);  // of a square about the image circle
  const double far = kernel_error(psfs, {{4 * side, 4 * side, 10}, 0, &map.look()}, 12, 3).rms,
               near = kernel_error(psfs, {{side, side, 10}, 0, &map.look()}, 12, 3).rms;
  EXPECT_GT(near, 0);
  EXPECT_NEAR(far / near, 1, 0.35);
}

}  // namespace
}  // namespace petzval
