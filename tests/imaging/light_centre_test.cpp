// SPDX-License-Identifier: BSD-3-Clause
#include "imaging/synthetic_table.h"

#include <gtest/gtest.h>
#include <petzval/imaging/light_centre.h>

namespace petzval {
namespace {

using namespace testing;

/// The centre of the light lies bend·h³ beyond the chief ray at h.
constexpr double bend_per_mm2 = 0.002;

LensDataTable leaning_table() {
  TableRecipe recipe;
  recipe.fields.clear();
  for (int i = 0; i <= 20; ++i) recipe.fields.push_back(i);
  recipe.g_source_sr = [](double field) { return 0.25 * std::pow(std::cos(radians(field)), 4); };
  recipe.psf = [&](double field, double nm) {
    const double offset_um = bend_per_mm2 * std::pow(recipe.height_mm(field, nm), 3) * um_per_mm;
    return psf_of_spots({{0, offset_um, 2, 2, 1}}, 129, 0.5);
  };
  return make_table(recipe);
}

// The same flux on the ring about the centres as on that about the chief rays: from the formulas.
TEST(LightCentre, KeepsTheFluxOfEveryRing) {
  const LensDataTable table = leaning_table();
  const LightProfile light(RadialProfiles(table).at_wavelength(550), table, LightCentres(table), 550);
  for (const double chief_mm : {0.02, 0.3, 0.9, 1.5, 2.1}) {
    const double centre_mm = chief_mm * (1 + bend_per_mm2 * chief_mm * chief_mm);
    const double tangent = chief_mm / 6, g_source = 0.25 / std::pow(1 + tangent * tangent, 2);
    EXPECT_NEAR(light.object_field(centre_mm), degrees(std::atan(tangent)), 1e-4) << chief_mm;
    const double square = chief_mm * chief_mm;
    const double area = (1 + bend_per_mm2 * square) * (1 + 3 * bend_per_mm2 * square);
    EXPECT_NEAR(light.g_source_sr(centre_mm) / (g_source / area), 1, 2e-5) << chief_mm;
  }
  const double last_mm = 6 * std::tan(radians(20));
  EXPECT_NEAR(light.max_height_mm(), last_mm * (1 + bend_per_mm2 * last_mm * last_mm), 1e-6);
}

TEST(LightCentre, KeepsItsOrderWhateverThePsfs) {
  TableRecipe recipe;
  recipe.psf = [](double field, double) {  // beyond 15 degrees the centre turns back by 0.1 mm
    return psf_of_spots({{0, field > 15 ? -100.0 : 0.0, 20, 20, 1}}, 65, 5 * (field > 15 ? 2.0 : 1.0));
  };
  recipe.height_mm = [](double field, double) { return field / 100; };
  const LensDataTable table = make_table(recipe);
  const LightCentres centres(table);
  for (std::size_t f = 0; f < 4; ++f) EXPECT_NEAR(centres.offset_mm(f), 0, 1e-8) << f;
  EXPECT_NEAR(centres.offset_mm(4), -0.025, 1e-8);  // half a step from field to field
}

}  // namespace
}  // namespace petzval
