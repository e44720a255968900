// SPDX-License-Identifier: BSD-3-Clause
// Panoramas through lenses that see half of space and more.
#include "imaging/synthetic_table.h"

#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/imaging/field_of_view.h>
#include <petzval/imaging/image_formation.h>

#include <array>
#include <cmath>

namespace petzval {
namespace {

using namespace testing;
using Direction = std::array<double, 3>;  // to the right, up, ahead

/// 3 mm of image a radian, to 110° from the axis.
LensDataTable wide_table() {
  TableRecipe recipe;
  recipe.fields.clear();
  for (int field = 0; field <= 110; field += 10) recipe.fields.push_back(field);
  recipe.height_mm = [](double field, double) { return 3 * radians(field); };
  return make_table(recipe);
}

Direction direction_of(double longitude_deg, double latitude_deg) {
  const double lon = radians(longitude_deg), lat = radians(latitude_deg);
  return {std::cos(lat) * std::sin(lon), std::sin(lat), std::cos(lat) * std::cos(lon)};
}

/// A panorama with the radiance that a function of the direction says.
template <typename Radiance>
Scene panorama_of(int rows, PanoramaView view, const Radiance& radiance) {
  Scene scene(2 * rows, rows, {550}, 90, std::nullopt);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < 2 * rows; ++column)
      scene.band(0)[static_cast<std::size_t>(row * 2 * rows + column)] = static_cast<float>(
          radiance(direction_of((column + 0.5) * 180.0 / rows - 180, 90 - (row + 0.5) * 180.0 / rows)));
  scene.make_panorama(view);
  return scene;
}

/// A Gaussian star of a degree and a half about a direction.
auto star_at(Direction star) {
  return [star](const Direction& d) {
    const double cosine = star[0] * d[0] + star[1] * d[1] + star[2] * d[2];
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0)) / radians(1.5);
    return std::exp(-angle * angle / 2);
  };
}

ImagingOptions unblurred() {
  ImagingOptions options;
  options.method = BlurMethod::none;
  return options;
}

constexpr SensorGeometry panorama_frame{300, 300, 40};  // ±6 mm: 115°

Centroid image_of(const Scene& scene) {
  const SpectralImage image = form_image(scene, wide_table(), panorama_frame, unblurred());
  CellPlane plane(panorama_frame);
  std::copy(image.values().begin(), image.values().end(), plane.values.begin());
  return centroid(plane);
}

TEST(Panorama, PutsStarsWhereTheTableSaysBehindTheCameraToo) {
  for (const double angle_deg : {12.0, 45.0, 80.0, 90.0, 102.0})
    for (const double azimuth_deg : {0.0, 37.0, 90.0, 161.0, 200.0, 305.0}) {
      // Azimuth counts from the right upwards.
      const double a = radians(azimuth_deg), w = radians(angle_deg);
      const Direction star{std::sin(w) * std::cos(a), std::sin(w) * std::sin(a), std::cos(w)};
      const Centroid at = image_of(panorama_of(540, {}, star_at(star)));
      const double height = 3 * w / 0.040;
      // The map from the sphere to the plane is curved: the middle of a star of 1.5° moves by up to 0.1
      // pixel.
      EXPECT_NEAR(at.column, 150 + height * std::cos(a), 0.12) << angle_deg << ' ' << azimuth_deg;
      EXPECT_NEAR(at.row, 150 - height * std::sin(a), 0.12) << angle_deg << ' ' << azimuth_deg;
    }
}

TEST(Panorama, LooksWhereItIsTurned) {
  for (const auto& [yaw, pitch] : {std::pair{40.0, 20.0}, {-150.0, 65.0}, {0.0, 90.0}, {180.0, -30.0}}) {
    const Centroid ahead = image_of(panorama_of(360, {yaw, pitch}, star_at(direction_of(yaw, pitch))));
    EXPECT_NEAR(ahead.column, 150, 0.05) << yaw << ' ' << pitch;
    EXPECT_NEAR(ahead.row, 150, 0.05) << yaw << ' ' << pitch;
  }
  // Tilted up by 30°, the horizon ahead lies 30° below the middle; turned right by 30°, 30° to the left.
  const Centroid below = image_of(panorama_of(360, {0, 30}, star_at(direction_of(0, 0))));
  EXPECT_NEAR(below.row, 150 + 3 * radians(30) / 0.040, 0.05);
  const Centroid left = image_of(panorama_of(360, {30, 0}, star_at(direction_of(0, 0))));
  EXPECT_NEAR(left.column, 150 - 3 * radians(30) / 0.040, 0.05);
}

TEST(Panorama, EvenRadianceIsAnEvenWall) {
  const Scene scene = panorama_of(90, {25, 80}, [](const Direction&) { return 2.0; });
  const LensDataTable table = wide_table();
  for (const BlurMethod method : {BlurMethod::none, BlurMethod::product}) {
    ImagingOptions options;
    options.method = method;
    const SpectralImage image = form_image(scene, table, panorama_frame, options);
    for (int row = 0; row < panorama_frame.rows; ++row)
      for (int column = 0; column < panorama_frame.columns; ++column) {
        const double height = std::hypot(panorama_frame.x_mm(column + 0.5), panorama_frame.y_mm(row + 0.5));
        if (height > table.real_image_height_mm.back() - 0.2) continue;  // the last field's light fades here
        ASSERT_NEAR(image.at(0, row, column), 2 * 0.25, 0.5 * 1e-3) << row << ' ' << column;
      }
  }
}

/// Stripes a sample wide from pole to pole: at the equator a pixel covers many, at the zenith all of them.
/// Their mean must come out, not their aliases.
TEST(Panorama, NothingAliasesWhereSamplesCrowd) {
  for (const double pitch : {0.0, 90.0}) {
    Scene scene(4000, 2000, {550}, 90, std::nullopt);
    for (std::size_t i = 0; i < scene.band_size(); ++i) scene.band(0)[i] = i % 2 == 0 ? 2.0F : 0.0F;
    scene.make_panorama({0, pitch});
    const SpectralImage image = form_image(scene, wide_table(), panorama_frame, unblurred());
    // A pixel covers 8.5 samples of the equator along the radius, 4.5 and more across it: that is no whole
    // number of stripes, and what is left over is a part of one.
    for (int row = 0; row < panorama_frame.rows; ++row)
      for (int column = 0; column < panorama_frame.columns; ++column) {
        if (std::hypot(panorama_frame.x_mm(column + 0.5), panorama_frame.y_mm(row + 0.5)) > 5.5)
          continue;  // the last field ends
        ASSERT_NEAR(image.at(0, row, column), 0.25, 0.25 / 4.5) << row << ' ' << column;
      }
  }
}

TEST(Panorama, WhatDoesNotFitIsRefused) {
  Scene square(100, 100, {550}, 90, std::nullopt), near(200, 100, {550}, 90, 2.0);
  EXPECT_THROW(square.make_panorama(), InputError);
  EXPECT_THROW(near.make_panorama(), InputError);
  Scene scene = panorama_of(20, {}, [](const Direction&) { return 1.0; });
  EXPECT_THROW(scene.set_distance_m(3.0), InputError);
  EXPECT_THROW(scene.set_horizontal_angle_deg(40), InputError);
  EXPECT_THROW(natural_sensor(scene, wide_table(), {}), InputError);
  EXPECT_TRUE(scene.resampled(std::vector<double>{550}).is_panorama());
}

}  // namespace
}  // namespace petzval
