// SPDX-License-Identifier: BSD-3-Clause
// Light of ghosts against photons that are reflected at random, and against the unfolded lens.
#include <gtest/gtest.h>
#include <petzval/analysis/ghosts.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/flare/ghost_light.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "reflected_photons.h"

namespace petzval {
namespace {

constexpr double ghost_nm = 587.5618;

BrightSource point_at(double right, double up) {
  BrightSource source;
  source.name = "point";
  source.right = right;
  source.up = up;
  source.irradiance = {1};
  return source;
}

/// Anywhere on a square that holds the first surface, of any polarisation.
test::ReflectingLens::Photon photon_from(const std::array<double, 3>& along, double half_mm,
                                         std::mt19937_64& random) {
  std::uniform_real_distribution<double> even(-1, 1);
  test::ReflectingLens::Photon photon{{half_mm * even(random), half_mm * even(random), 0}, along, {}};
  const double turn = pi * even(random), level = std::hypot(along[0], along[2]);
  const std::array<double, 3> side{along[2] / level, 0, -along[0] / level};
  const std::array<double, 3> over{-along[0] * along[1] / level, level, -along[1] * along[2] / level};
  for (std::size_t k = 0; k < 3; ++k) photon.field[k] = std::cos(turn) * side[k] + std::sin(turn) * over[k];
  return photon;
}

struct GhostCase {
  const char* lens;
  double right, up;
  int blades;
  double decentre_mm = 0;  ///< of the second element, along both axes
};

class GhostLight : public testing::TestWithParam<GhostCase> {};

// Counts are binomial: the sum within three standard errors, the pairs together by χ², which chance exceeds
// once in 10⁴.
TEST_P(GhostLight, IsThatOfPhotonsReflectedAtRandom) {
  const auto [name, right, up, blades, decentre_mm] = GetParam();
  Lens lens = read_lens(name).lens;
  if (decentre_mm != 0) lens.groups = {{2, 3, {decentre_mm, -decentre_mm, 0, 0, 0, 0}, 0}};
  lens.surfaces[lens.stop_index()].blades = {blades, 17};
  const SensorGeometry frame{360, 240, 100};
  const BrightSource source = point_at(right, up);
  GhostLightOptions options;
  options.neglected_share = 0;
  GhostLightReport report;
  const SpectralImage light = ghost_light(lens, frame, {ghost_nm}, {&source, 1}, options, {}, &report);

  const test::ReflectingLens photons(lens, ghost_nm);
  std::mt19937_64 random(11);
  const double half = 1.3 * *lens.surfaces[0].semi_diameter_mm;
  const double length = std::sqrt(right * right + up * up + 1);
  const std::array<double, 3> along{-right / length, -up / length, 1 / length};
  constexpr int count = 1000000;
  std::map<std::pair<std::size_t, std::size_t>, int> hits;
  int all = 0, seen = 0, left_hits = 0;
  for (int i = 0; i < count; ++i) {
    if (const auto end = photons.follow(photon_from(along, half, random), random)) {
      ++hits[{end->turned[0], end->turned[1]}];
      ++all;
      const double x = end->x_mm / 0.1, y = end->y_mm / 0.1;
      if (std::abs(x) < frame.columns / 2.0 && std::abs(y) < frame.rows / 2.0) ++seen, left_hits += x > 0;
    }
  }
  ASSERT_GT(all, 1000);
  // What one photon carries [W/nm].
  const double each_w = 4 * half * half * along[2] * 1e-6 / count;
  EXPECT_NEAR(report.ghost_flux_w / each_w, all, 3 * std::sqrt(all));
  EXPECT_NEAR(report.frame_flux_w / each_w, seen, 3 * std::sqrt(seen));
  double left_w = 0;
  for (int row = 0; row < frame.rows; ++row)
    for (int column = 0; column < frame.columns / 2; ++column) left_w += light.at(0, row, column) * 1e-8;
  EXPECT_NEAR(left_w / each_w, left_hits, 3 * std::sqrt(left_hits));
  double chi_sq = 0;
  int pairs = 0;
  for (const GhostPairReport& pair : report.pairs) {
    const double expected = pair.flux_w / each_w;
    if (expected < 20) continue;
    chi_sq += std::pow(hits[{pair.pair.first, pair.pair.second}] - expected, 2) / expected;
    ++pairs;
  }
  ASSERT_GT(pairs, 5);
  // Wilson and Hilferty's normal deviate of χ²; 3.72 is exceeded once in 10⁴.
  const double deviate = (std::cbrt(chi_sq / pairs) - (1 - 2.0 / (9 * pairs))) / std::sqrt(2.0 / (9 * pairs));
  EXPECT_LT(deviate, 3.72) << chi_sq << " of " << pairs;
}

INSTANTIATE_TEST_SUITE_P(
    ThreeLenses, GhostLight,
    testing::Values(GhostCase{"cooke-triplet", 0, 0, 0}, GhostCase{"cooke-triplet", 0.2, 0.13, 6},
                    GhostCase{"double-gauss", 0, 0, 0}, GhostCase{"double-gauss", -0.12, 0.1, 0},
                    GhostCase{"tessar", 0, 0, 5}, GhostCase{"tessar", 0.1, -0.2, 0},
                    GhostCase{"cooke-triplet", 0.2, 0.1, 0, 0.5}, GhostCase{"double-gauss", 0, 0, 6, 0.7}),
    [](const auto& info) {
      std::string name = info.param.lens;
      std::ranges::replace(name, '-', '_');
      name += info.param.right == 0 ? "_on_axis" : "_off_axis";
      return name + (info.param.decentre_mm == 0 ? "" : "_decentred");
    });

// Glass of a high index, for enough of what is reflected four times. Three standard errors, as with two.
TEST(GhostLightOfFourReflections, IsThatOfPhotonsReflectedAtRandom) {
  Lens lens = read_lens("cooke-triplet").lens;
  for (Surface& surface : lens.surfaces)
    if (!surface.material.is_air()) surface.material = Material(Material::Constant{1.8});
  const SensorGeometry frame{120, 80, 500};
  const BrightSource source = point_at(0.05, 0.03);
  GhostLightOptions options;
  GhostLightReport two, four;
  options.neglected_share = 0;
  ghost_light(lens, frame, {ghost_nm}, {&source, 1}, options, {}, &two);
  options.neglected_share = 1e-5;
  options.reflections = 4;
  ghost_light(lens, frame, {ghost_nm}, {&source, 1}, options, {}, &four);
  double flux_w = 0;
  for (const GhostPairReport& way : four.pairs)
    if (way.pair.reflections() == 4) flux_w += way.flux_w;
  EXPECT_NEAR(four.ghost_flux_w - flux_w, two.ghost_flux_w, 1e-4 * two.ghost_flux_w);

  const test::ReflectingLens photons(lens, ghost_nm);
  std::mt19937_64 random(5);
  const double half = 1.3 * *lens.surfaces[0].semi_diameter_mm;
  const double length = std::sqrt(0.05 * 0.05 + 0.03 * 0.03 + 1);
  const std::array<double, 3> along{-0.05 / length, -0.03 / length, 1 / length};
  constexpr int count = 8000000;
  int hits = 0;
  for (int i = 0; i < count; ++i)
    if (photons.follow(photon_from(along, half, random), random, 4)) ++hits;
  ASSERT_GT(hits, 500);
  EXPECT_NEAR(flux_w / (4 * half * half * along[2] * 1e-6 / count), hits, 3 * std::sqrt(hits));
}

// A pane before a sensor with microlenses: unfolded, by hand.
TEST(GhostWay, LeavesTheSensorInTheOrdersOfItsGrating) {
  Lens lens = read_lens("cooke-triplet").lens;
  const Surface pane = lens.surfaces[0];
  lens.surfaces.assign(2, pane);
  for (Surface& surface : lens.surfaces) surface.curvature_per_mm = 0, surface.semi_diameter_mm = 100;
  lens.surfaces[0].stop = true;
  lens.surfaces[0].thickness_mm = 2, lens.surfaces[1].thickness_mm = 7;
  lens.surfaces[1].material = Material();
  const SensorReflection sensor(0.1, 4, 0.6);
  const GhostTracer tracer(lens, ghost_nm, {}, sensor);
  Ray ray;
  ray.direction = {0.12, -0.05, std::sqrt(1 - 0.12 * 0.12 - 0.05 * 0.05)};
  const double straight_x = tracer.follow(ray, GhostPair::straight()).x_mm,
               straight_y = tracer.follow(ray, GhostPair::straight()).y_mm;
  const double per_order = ghost_nm * 1e-3 / 4;
  int ways = 0;
  double light = 0;
  for (const GhostPair& way : tracer.pairs()) {
    if (way.first != 2 || way.second != 1) continue;
    const double l = 0.12 + way.order.right * per_order, m = -0.05 + way.order.up * per_order;
    const GhostLanding end = tracer.follow(ray, way);
    if (l * l + m * m >= 1) {
      EXPECT_FALSE(end.arrives);
      continue;
    }
    ASSERT_TRUE(end.arrives);
    const double n = std::sqrt(1 - l * l - m * m);
    EXPECT_NEAR(end.x_mm, straight_x + 2 * 7 * l / n, 1e-9 / n);
    EXPECT_NEAR(end.y_mm, straight_y + 2 * 7 * m / n, 1e-9 / n);
    light += way.order.share;
    ++ways;
  }
  EXPECT_GT(ways, 20);
  EXPECT_GT(light, 0.9);
}

TEST(GhostWay, EndsWhereASecondTracerSays) {
  for (const char* name : {"cooke-triplet", "double-gauss", "tessar", "petzval-lens"}) {
    const Lens lens = read_lens(name).lens;
    const GhostTracer tracer(lens, ghost_nm, {}, 0);
    const test::ReflectingLens second(lens, ghost_nm);
    int compared = 0;
    for (const GhostPair& pair : tracer.pairs())
      for (const auto& [x, y] : {std::array{0.3, -0.2}, std::array{2.0, 1.0}, std::array{-3.0, 2.5}}) {
        Ray ray;
        ray.point_mm = {x, y, 0};
        const double length = std::sqrt(1 + 0.1 * 0.1 + 0.05 * 0.05);
        ray.direction = {-0.1 / length, 0.05 / length, 1 / length};
        const auto there = second.along_pair(ray.point_mm, ray.direction, pair.first, pair.second);
        const GhostLanding here = tracer.follow(ray, pair);
        if (!here.arrives || !there) continue;
        ++compared;
        const double scale = 1 + std::hypot((*there)[0], (*there)[1]);
        EXPECT_NEAR(here.x_mm, (*there)[0], 1e-9 * scale) << name << pair.first << " " << pair.second;
        EXPECT_NEAR(here.y_mm, (*there)[1], 1e-9 * scale) << name << pair.first << " " << pair.second;
      }
    EXPECT_GT(compared, 15) << name;
  }
}

// Close to the axis, sizes, places and light are those of the unfolded lens (analysis/ghosts.h).
TEST(GhostWay, CloseToTheAxisIsThatOfTheUnfoldedLens) {
  for (const char* name : {"cooke-triplet", "double-gauss", "tessar"}) {
    const Lens lens = read_lens(name).lens;
    GhostOptions options;
    options.wavelengths_nm = {ghost_nm};
    options.sensor_reflectance = 0.05;
    const GhostTracer tracer(lens, ghost_nm, {}, options.sensor_reflectance);
    const std::vector<Ghost> all = ghosts(lens, options);
    EXPECT_EQ(tracer.pairs().size(), all.size());
    constexpr double tiny_mm = 1e-5;
    for (const Ghost& ghost : all) {
      Ray ray;
      ray.point_mm = {0, tiny_mm, 0};
      std::vector<std::array<double, 3>> places;
      const GhostLanding end = tracer.follow(ray, {ghost.first, ghost.second}, &places);
      ASSERT_TRUE(end.arrives);
      // At the height at which the first aperture that it fills would stop it.
      double filled = 0;
      std::size_t met = 0;
      const auto meet = [&](std::size_t surface) {
        const double y_mm = places[met++][1];
        if (surface == lens.surfaces.size()) return;
        double clear_mm = lens.surfaces[surface].semi_diameter_mm.value_or(INFINITY);
        if (lens.surfaces[surface].stop) clear_mm = std::min(clear_mm, stop_radius_mm(lens));
        filled = std::max(filled, std::abs(y_mm) / clear_mm);
      };
      for (std::size_t i = 0; i <= ghost.first; ++i) meet(i);
      for (std::size_t i = ghost.first; i-- > ghost.second;) meet(i);
      for (std::size_t i = ghost.second + 1; i <= lens.surfaces.size(); ++i) meet(i);
      ASSERT_EQ(met, places.size());
      EXPECT_NEAR(2 * std::abs(end.y_mm) / filled / ghost.diameter_mm, 1, 1e-9) << name;
      EXPECT_NEAR(end.share / ghost.transmittance, 1, 1e-9) << name;
    }
  }
}

TEST(GhostLightBytes, DoNotDependOnThreads) {
  const Lens lens = read_lens("tessar").lens;
  BrightSource source = point_at(0.1, 0.05);
  source.radius_rad = 0.0047;
  const auto with = [&](int threads) {
    const ThreadLimit limit(threads);
    return ghost_light(lens, {96, 64, 250}, {ghost_nm}, {&source, 1});
  };
  const SpectralImage one = with(1), two = with(2);
  EXPECT_TRUE(std::ranges::equal(one.values(), two.values()));
}

// A disc sends as much light as a point of the same irradiance; vignetting alters over its width alone.
TEST(GhostLightOfADisc, IsAsMuchAsThatOfAPoint) {
  const Lens lens = read_lens("cooke-triplet").lens;
  BrightSource source = point_at(0.1, 0.05);
  GhostLightReport point, disc;
  ghost_light(lens, {96, 64, 250}, {ghost_nm}, {&source, 1}, {}, {}, &point);
  source.radius_rad = radians(0.25);
  ghost_light(lens, {96, 64, 250}, {ghost_nm}, {&source, 1}, {}, {}, &disc);
  EXPECT_NEAR(disc.ghost_flux_w / point.ghost_flux_w, 1, 5e-3);
}

// The image of a far point on the axis holds what the entrance pupil takes; off it, the tangent of the angle
// times the focal length, within the distortion of a triplet, is where it is.
TEST(StraightLight, IsWhatTheEntrancePupilTakes) {
  const Lens lens = read_lens("cooke-triplet").lens;
  const FirstOrder first = first_order(lens);
  const SensorGeometry frame{400, 300, 100};
  const auto seen = [&](const BrightSource& source) {
    return straight_light(lens, frame, {lens.reference_wavelength_nm}, {&source, 1});
  };
  const SpectralImage axis = seen(point_at(0, 0));
  double flux_w = 0;
  for (const float value : axis.values()) flux_w += value * 1e-8;
  const double pupil_m2 = pi / 4 * std::pow(first.entrance_pupil.diameter_mm * 1e-3, 2);
  // The polygon of the edge is within its cells' curvature of a circle: (1/96)² of its radius squared.
  EXPECT_NEAR(flux_w / pupil_m2, 1, 2e-3);
  const SpectralImage off = seen(point_at(0.1, 0.05));
  double sum = 0, column = 0, row = 0;
  for (int r = 0; r < frame.rows; ++r)
    for (int c = 0; c < frame.columns; ++c) {
      const double value = off.at(0, r, c);
      sum += value, column += value * (c + 0.5), row += value * (r + 0.5);
    }
  EXPECT_NEAR(column / sum - 200, 0.1 * first.efl_mm / 0.1, 1);
  EXPECT_NEAR(row / sum - 150, -0.05 * first.efl_mm / 0.1, 1);
}

TEST(GhostLightInput, IsRefusedWithAWordOfWhatWouldBeRight) {
  const Lens lens = read_lens("tessar").lens;
  const auto made = [&](const BrightSource& source, GhostLightOptions options = {}) {
    return ghost_light(lens, {9, 6, 1000}, {ghost_nm}, {&source, 1}, options);
  };
  BrightSource source = point_at(0.1, 0);
  source.irradiance = {1, 1};
  EXPECT_THROW(made(source), InputError);
  source = point_at(INFINITY, 0);
  EXPECT_THROW(made(source), InputError);
  source = point_at(0.1, 0);
  source.distance_mm = -5;
  EXPECT_THROW(made(source), InputError);
  GhostLightOptions options;
  options.sensor = 2;
  EXPECT_THROW(made(point_at(0, 0), options), InputError);
  options = {};
  options.neglected_share = 1;
  EXPECT_THROW(made(point_at(0, 0), options), InputError);
}

}  // namespace
}  // namespace petzval
