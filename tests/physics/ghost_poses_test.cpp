// SPDX-License-Identifier: BSD-3-Clause
// Ghosts, suns and stars of lenses with poses: of a lens moved as a whole, folded, or hardly moved they are
// those of the centred lens. (Photons through decentred elements: ghost_light_test.cpp.)
#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/flare/ghost_light.h>
#include <petzval/flare/starburst.h>
#include <petzval/lens/lens_file.h>

#include <algorithm>
#include <cmath>

namespace petzval {
namespace {

constexpr double stray_nm = 550;
const SensorGeometry stray_frame{180, 120, 200};

BrightSource sun_at(double right, double up) {
  BrightSource source;
  source.right = right, source.up = up;
  source.radius_rad = radians(0.25);
  source.irradiance = {1};
  return source;
}

Lens flared_triplet() {
  Lens lens = read_lens("cooke-triplet").lens;
  lens.surfaces[lens.stop_index()].blades = {6, 10};
  return lens;
}

/// All of it, the sensor too.
Lens moved_triplet(const Pose& pose) {
  Lens lens = flared_triplet();
  lens.groups = {{0, lens.surfaces.size(), pose, 0}};
  return lens;
}

/// Thrown back by a plane mirror on its way to the sensor, a little aside: steep light of ghosts meets it
/// too.
Lens folded_flared_triplet() {
  Lens lens = flared_triplet();
  constexpr double to_mirror_mm = 20;
  Surface mirror = Surface::sphere(INFINITY, to_mirror_mm - lens.surfaces.back().thickness_mm);
  mirror.mirror = true;
  mirror.pose.tilt_x_deg = -10;
  lens.surfaces.back().thickness_mm = to_mirror_mm;
  lens.surfaces.push_back(mirror);
  lens.groups = {{6, 7, {0, 0, 0, 20, 0, 0}, 0}};
  lens.validate();
  return lens;
}

struct StrayLight {
  SpectralImage ghosts, sun, star;
  double ghost_w;
};

StrayLight stray_light(const Lens& lens, const BrightSource& source, double reflectance = 1) {
  GhostLightOptions options;
  options.neglected_share = 0;
  options.sensor = 0;
  if (lens.has_mirrors()) options.losses.surfaces[6] = Coating::constant(reflectance);
  GhostLightReport report;
  SpectralImage ghosts = ghost_light(lens, stray_frame, {stray_nm}, {&source, 1}, options, {}, &report);
  return {std::move(ghosts), straight_light(lens, stray_frame, {stray_nm}, {&source, 1}, options),
          starburst_light(lens, stray_frame, {stray_nm}, {&source, 1}, options), report.ghost_flux_w};
}

double largest(const SpectralImage& image) {
  float most = 0;
  for (const float value : image.values()) most = std::max(most, std::abs(value));
  return static_cast<double>(most);
}

double largest_difference(const SpectralImage& a, const SpectralImage& b, double scale = 1) {
  double most = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i)
    most = std::max(most, std::abs(double(a.values()[i]) - scale * double(b.values()[i])));
  return most;
}

double total_of(const SpectralImage& image) {
  double sum = 0;
  for (const float value : image.values()) sum += double(value);
  return sum;
}

/// The same rays but for rounding: single precision of pixels, and facets whose edges fall the other way.
void expect_alike(const StrayLight& a, const StrayLight& b, double share = 1) {
  constexpr double rounding = 2e-5;
  ASSERT_GT(largest(a.ghosts), 0);
  EXPECT_NEAR(b.ghost_w / a.ghost_w / share, 1, 1e-6);
  EXPECT_LT(largest_difference(b.ghosts, a.ghosts, share), rounding * largest(a.ghosts));
  EXPECT_LT(largest_difference(b.sun, a.sun, share), rounding * largest(a.sun));
  EXPECT_LT(largest_difference(b.star, a.star, share), rounding * largest(a.star));
}

TEST(GhostPoses, TooSmallToMatterDoNotMatter) {
  Lens lens = flared_triplet();
  const BrightSource source = sun_at(0.15, 0.1);
  const StrayLight centred = stray_light(lens, source);
  for (Surface& surface : lens.surfaces) surface.pose = {1e-12, -1e-12, 1e-12, 1e-12, -1e-12, 1e-12};
  lens.sensor_pose.tilt_x_deg = 1e-12;
  expect_alike(centred, stray_light(lens, source));
}

TEST(GhostPoses, ALensShiftedAsAWholeHasTheSameGhostsOfFarLight) {
  const BrightSource source = sun_at(0.15, 0.1);
  expect_alike(stray_light(flared_triplet(), source),
               stray_light(moved_triplet({1.5, -2, 0, 0, 0, 0}), source));
}

TEST(GhostPoses, AFoldedLensHasTheGhostsOfTheUnfoldedOne) {
  const BrightSource source = sun_at(-0.1, 0.2);
  const StrayLight straight = stray_light(flared_triplet(), source);
  // Ghosts of the sensor would pass the mirror three times; this sensor reflects nothing.
  const StrayLight folded = stray_light(folded_flared_triplet(), source, 0.9);
  expect_alike(straight, folded, 0.9);
}

TEST(GhostPoses, ALensTiltedAsAWholeSeesTheSunMoved) {
  // The tilt about x turns +y towards +z: the lens looks up by so much, and the sun stands lower for it. Rays
  // are others, for cells lie on another plane: a thousandth in all, two per cent of the light elsewhere.
  constexpr double tilt_deg = 4, seen_deg = 5;
  const StrayLight one = stray_light(flared_triplet(), sun_at(0, std::tan(radians(seen_deg))));
  const StrayLight other = stray_light(moved_triplet({0, 0, 0, tilt_deg, 0, 0}),
                                       sun_at(0, std::tan(radians(seen_deg + tilt_deg))));
  EXPECT_NEAR(other.ghost_w / one.ghost_w, 1, 1e-3);
  EXPECT_NEAR(total_of(other.sun) / total_of(one.sun), 1, 1e-3);
  double moved = 0;
  for (std::size_t i = 0; i < one.ghosts.values().size(); ++i)
    moved += std::abs(double(one.ghosts.values()[i]) - double(other.ghosts.values()[i])) / 2;
  EXPECT_LT(moved, 0.02 * total_of(one.ghosts));
}

TEST(GhostPoses, MirrorsOfTheLensMakeNone) {
  const Lens lens = folded_flared_triplet();
  for (const GhostPair& pair : GhostTracer(lens, stray_nm, {}, 0.1).pairs())
    EXPECT_TRUE(pair.first != 6 && pair.second != 6);
  // The sensor's light goes back over the mirror, twice more: 0.9³ of what it is unfolded.
  Losses losses;
  losses.surfaces[6] = Coating::constant(0.9);
  const GhostTracer folded(lens, stray_nm, losses, 0.1), straight(flared_triplet(), stray_nm, {}, 0.1);
  Ray ray;
  ray.point_mm = {0.3, 0.5, 0};
  const GhostLanding a = straight.follow(ray, {6, 1}), b = folded.follow(ray, {7, 1});
  ASSERT_TRUE(a.arrives && b.arrives);
  EXPECT_NEAR(b.share / a.share, 0.9 * 0.9 * 0.9, 1e-12);
  EXPECT_NEAR(b.x_mm, a.x_mm, 1e-10);
  EXPECT_NEAR(b.y_mm, a.y_mm, 1e-10);
  EXPECT_NEAR(b.clearance, a.clearance, 1e-10);
}

}  // namespace
}  // namespace petzval
