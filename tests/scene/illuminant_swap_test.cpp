// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/colour/illuminants.h>
#include <petzval/colour/observer.h>
#include <petzval/scene/charts.h>
#include <petzval/scene/illuminant_swap.h>
#include <petzval/scene/scene_light.h>

#include <algorithm>

namespace petzval {
namespace {

ChartOptions small_chart(const char* light) {
  ChartOptions options;
  options.columns = 60, options.rows = 40;
  options.illuminant = light;
  return options;
}

/// A chart as read_scene() gives it.
Scene settled_chart(const char* light) {
  Scene scene = colorchecker_chart(small_chart(light));
  settle_illuminant(scene, {});
  return scene;
}

double white_luminance(const Scene& scene) {
  std::vector<double> light;
  for (const double nm : scene.wavelengths_nm()) light.push_back(scene.illuminant->at(nm));
  return luminance(Spectrum(scene.wavelengths_nm(), light));
}

/// The chart made under one light and swapped to another is the chart made under the other.
TEST(IlluminantSwap, IsTheChartUnderTheOtherLight) {
  Scene swapped = settled_chart("A");
  const double before = white_luminance(swapped);
  swap_illuminant(swapped, illuminant("D65").scaled(17));
  EXPECT_NEAR(white_luminance(swapped) / before, 1, 1e-12);
  const Scene made = settled_chart("D65");
  const double level = white_luminance(swapped) / white_luminance(made);
  for (std::size_t i = 0; i < made.values().size(); ++i)
    EXPECT_NEAR(swapped.values()[i], level * made.values()[i], 1e-6 * level * made.values()[i] + 1e-12) << i;
}

TEST(IlluminantSwap, ThereAndBackIsWhereItWas) {
  const Scene original = settled_chart("D50");
  Scene scene = original;
  swap_illuminant(scene, illuminant("A"));
  swap_illuminant(scene, illuminant("D50"));
  for (std::size_t i = 0; i < scene.values().size(); ++i)
    EXPECT_NEAR(scene.values()[i], original.values()[i], 1e-6 * original.values()[i]);
}

TEST(IlluminantSwap, WhatCannotBeIsRefused) {
  Scene scene = colorchecker_chart(small_chart("D65"));
  EXPECT_THROW(swap_illuminant(scene, Spectrum({1000, 1100}, {1, 1})), InputError);
  scene.illuminant = Spectrum({500, 600}, {1, 1});  // none at 400 nm, where the chart shines
  EXPECT_THROW(swap_illuminant(scene, illuminant("A")), InputError);
  scene.illuminant.reset();
  EXPECT_THROW(swap_illuminant(scene, illuminant("A")), InputError);
}

}  // namespace
}  // namespace petzval
