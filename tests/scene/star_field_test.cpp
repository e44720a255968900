// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/colour/observer.h>
#include <petzval/scene/scene_file.h>
#include <petzval/scene/star_field.h>

#include <algorithm>
#include <cmath>

namespace petzval {
namespace {

TEST(Stars, AreWhereTheyAreAndAsBright) {
  const std::vector<Star> stars = bright_stars();
  ASSERT_GT(stars.size(), 4500u);
  const auto star = [&](int hipparcos) {
    return *std::find_if(stars.begin(), stars.end(),
                         [&](const Star& each) { return each.hipparcos == hipparcos; });
  };
  // Sirius, by the SIMBAD data base: 06 45 08.92 −16 42 58.0, B − V 0.00; V −1.46, Hipparcos −1.44.
  const Star sirius = star(32349);
  EXPECT_NEAR(sirius.place.right_ascension_deg, 15 * (6 + 45 / 60.0 + 8.92 / 3600), 0.001);
  EXPECT_NEAR(sirius.place.declination_deg, -(16 + 42 / 60.0 + 58.0 / 3600), 0.001);
  EXPECT_NEAR(sirius.magnitude, -1.45, 0.02);
  EXPECT_EQ(stars.front().hipparcos, 32349);
  EXPECT_NEAR(star_temperature_k(0.65), 5772, 60) << "the Sun";
}

TEST(Stars, OfMagnitudeZeroGiveTwoAndAHalfMicrolux) {
  // Allen's Astrophysical Quantities: V = 0 is 2.54e-6 lx above the atmosphere; the monochromatic zero point
  // and the visual band make 5 %.
  std::vector<double> wavelengths;
  for (int nm = 380; nm <= 780; nm += 5) wavelengths.push_back(nm);
  const std::vector<double> irradiance = star_irradiance({0, {}, 0, 0}, wavelengths);
  const std::vector<Xyz> weights = Observer::cie_1931().weights(wavelengths);
  double lux = 0;
  for (std::size_t i = 0; i < wavelengths.size(); ++i) lux += 683 * irradiance[i] * weights[i].y;
  EXPECT_NEAR(lux, 2.54e-6, 0.06 * 2.54e-6);
}

struct Spot {
  double column = 0, row = 0, light = 0;
};

/// Centre and light over the sky in a square about a place.
Spot spot_at(const Scene& scene, double column, double row, double sky) {
  Spot spot;
  for (int r = static_cast<int>(row) - 2; r <= row + 2; ++r)
    for (int c = static_cast<int>(column) - 2; c <= column + 2; ++c) {
      const double value = scene.band(0)[static_cast<std::size_t>(r * scene.columns() + c)] - sky;
      spot.light += value, spot.column += value * (c + 0.5), spot.row += value * (r + 0.5);
    }
  spot.column /= spot.light, spot.row /= spot.light;
  return spot;
}

/// The unit vector to a place of the sky.
std::array<double, 3> direction(double ra_deg, double dec_deg) {
  const double a = radians(ra_deg), d = radians(dec_deg);
  return {std::cos(d) * std::cos(a), std::cos(d) * std::sin(a), std::sin(d)};
}

TEST(Stars, OfOrionStandRightAndSendTheirLight) {
  ChartOptions options;
  options.columns = 1024, options.rows = 768, options.wavelengths_nm = {550};
  const Scene scene = star_field(options, sky_place("orion"));
  const double step = scene.tangent_per_sample();
  std::vector<float> values(scene.band(0).begin(), scene.band(0).end());
  const float sky = *std::min_element(values.begin(), values.end());
  // The two brightest: Rigel (V 0.13 to 0.18, 05 14 32.27 −08 12 05.9) and Betelgeuse (0.42 to 0.5,
  // 05 55 10.31 +07 24 25.4).
  const auto brightest = [&] {
    return static_cast<int>(std::max_element(values.begin(), values.end()) - values.begin());
  };
  const auto clear_about = [&](int at) {
    for (int r = at / 1024 - 3; r <= at / 1024 + 3; ++r)
      for (int c = at % 1024 - 3; c <= at % 1024 + 3; ++c) values[static_cast<std::size_t>(r * 1024 + c)] = 0;
  };
  const int first = brightest();
  clear_about(first);
  const int second = brightest();
  Spot rigel = spot_at(scene, first % 1024, first / 1024, sky),
       betelgeuse = spot_at(scene, second % 1024, second / 1024, sky);
  if (rigel.row < betelgeuse.row) std::swap(rigel, betelgeuse);
  EXPECT_LT(betelgeuse.column, rigel.column) << "north up, east on the left";
  const auto line_of_sight = [&](const Spot& spot) {
    const double x = (spot.column - 512) * step, y = (384 - spot.row) * step;
    const double length = std::sqrt(x * x + y * y + 1);
    return std::array<double, 3>{x / length, y / length, 1 / length};
  };
  const auto angle_deg = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return degrees(std::acos(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]));
  };
  EXPECT_NEAR(angle_deg(line_of_sight(rigel), line_of_sight(betelgeuse)),
              angle_deg(direction(78.63447, -8.20164), direction(88.79294, 7.40706)), 0.002);
  // The light of a sample is its radiance times its solid angle.
  const double cosine = line_of_sight(rigel)[2];
  const double irradiance = rigel.light * step * step * cosine * cosine * cosine;
  EXPECT_NEAR(-2.5 * std::log10(irradiance / 3.63e-11), 0.15, 0.06);
}

TEST(Stars, RefuseLightAndPlacesThatAreNone) {
  EXPECT_THROW(sky_place("nowhere"), InputError);
  EXPECT_THROW(sky_place("12"), InputError);
  EXPECT_THROW(sky_place("0,100"), InputError);
  EXPECT_THROW(read_scene("stars", {.illuminant = "A"}), InputError);
  EXPECT_THROW(read_scene("stars", {.distance_m = 3.0}), InputError);
  EXPECT_NO_THROW(read_scene("stars:266,-29", {.columns = 64, .rows = 48, .wavelengths_nm = {500, 600}}));
}

}  // namespace
}  // namespace petzval
