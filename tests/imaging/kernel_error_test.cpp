// SPDX-License-Identifier: BSD-3-Clause
#include "imaging/synthetic_table.h"

#include <gtest/gtest.h>
#include <petzval/imaging/distortion.h>
#include <petzval/imaging/exact_blur.h>
#include <petzval/imaging/kernel_error.h>
#include <petzval/imaging/product_blur.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

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

/// PSFs that hardly change but at the very rim, where they do from cell to cell.
LensDataTable wild_at_the_rim() {
  TableRecipe recipe;
  recipe.fields = {0, 4, 8, 12, 16, 18, 19, 19.6, 20};
  recipe.height_mm = [](double field, double) { return height_mm_per_tangent * std::tan(radians(field)); };
  recipe.psf = [](double field, double) {
    const double wide = 2 + 0.05 * field + 3 * std::pow(field / 20, 60);
    return psf_of_spots({{0, 0, wide, wide, 1}}, 129, 0.5);
  };
  return make_table(recipe);
}

struct WildRim {
  LensDataTable table = wild_at_the_rim();
  LightCentres centres{table};
  SensorGeometry cells{288, 216, 2000 * table.real_image_height_mm.back() / std::hypot(288, 216)};
  PsfField psfs{table, 550, cells.pitch_um, PsfInterpolation::psf, centres};
};

struct TilesAndNodes {
  int tile, nodes;
};
constexpr std::array layouts{TilesAndNodes{72, 2}, TilesAndNodes{48, 3}, TilesAndNodes{24, 2},
                             TilesAndNodes{24, 4}, TilesAndNodes{12, 3}, TilesAndNodes{6, 4},
                             TilesAndNodes{3, 3}};

// What was looked at before, and where a look ended, changes no verdict and no error that is within.
TEST(KernelError, DoesNotDependOnWhatWasLookedAtBefore) {
  const WildRim rim;
  for (const double limit : {1e-4, 1e-3, 1e-2}) {
    LayoutErrors errors(rim.psfs, rim.cells);
    int within = 0;
    for (const auto& [tile, nodes] : layouts) {
      const double alone = kernel_error(rim.psfs, rim.cells, tile, nodes).rms,
                   in_turn = errors.at_places(tile, nodes, limit).rms;
      EXPECT_EQ(in_turn > limit, alone > limit) << tile << " " << nodes << " at " << limit;
      if (alone > limit) continue;
      EXPECT_NEAR(in_turn / alone, 1, 1e-12);
      ++within;
    }
    std::printf("%d of %zu layouts within %g\n", within, layouts.size(), limit);
  }
}

// Who does with a smaller ring than another is never turned away, and somebody is.
TEST(KernelError, TellsWhoDoesWithASmallerRing) {
  const WildRim rim;
  int turned_away = 0, smaller = 0;
  for (const double limit : {1e-4, 3e-4, 1e-3}) {
    LayoutErrors errors(rim.psfs, rim.cells);
    for (const auto& [tile, nodes] : layouts) {
      const CellRing ring = errors.at_rim(tile, nodes, limit).ring;
      if (ring.empty()) continue;
      for (const auto& [other_tile, other_nodes] : layouts) {
        const RimError other = errors.at_rim(other_tile, other_nodes, limit);
        const bool does = errors.does_with_less(other_tile, other_nodes, limit, ring);
        if (other.within && (other.ring.empty() || other.ring.from > ring.from)) {
          EXPECT_TRUE(does) << other_tile << " " << other_nodes << " beside " << tile << " " << nodes;
          ++smaller;
        }
        turned_away += does ? 0 : 1;
      }
    }
  }
  EXPECT_GT(smaller, 0);
  EXPECT_GT(turned_away, 0);
}

// A cell whose middle lies beyond the last height of a lens has the light of its part within.
TEST(HeightLook, CutsCellsAtTheLastHeight) {
  const LensDataTable table = make_table(comatic_recipe());
  constexpr double nm = 550;
  const double height_mm = table.real_image_height_mm.back();
  const SceneMap map(table, LightCentres(table), {}, nm, Scene(64, 48, {nm}, 4, {}), 2 * height_mm);
  const double last_mm = map.look().last_height_mm(), pitch_mm = last_mm / 20;
  const auto light_at = [&](double x_mm, double y_mm) {
    std::vector<ScenePart> parts;
    map.look().cut(x_mm, y_mm, pitch_mm, 64, parts);
    double light = 0;
    for (const ScenePart& part : parts) light += part.place.g_source_sr;
    return light / double(parts.size());
  };
  const double whole = light_at(last_mm - pitch_mm, 0);
  EXPECT_GT(whole, 0);
  EXPECT_NEAR(light_at(last_mm + pitch_mm / 4, 0) / whole, 0.25, 0.1);
  // Its corner alone lies within: a right triangle whose height over its longest side is a fifth of the
  // diagonal.
  const double along = (last_mm + 0.3 * std::sqrt(2.0) * pitch_mm) / std::sqrt(2.0);
  EXPECT_NEAR(light_at(along, along) / whole, 0.08, 0.06);
  EXPECT_EQ(light_at(last_mm + 1.5 * pitch_mm, 0), 0);
}

}  // namespace
}  // namespace petzval
