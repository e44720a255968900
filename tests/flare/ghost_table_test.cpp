// SPDX-License-Identifier: BSD-3-Clause
// The list of ghosts about a real chief ray: of lenses that are as good as centred against paraxial optics,
// and of a wedge against its angles.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/flare/ghost_table.h>
#include <petzval/lens/lens_file.h>

#include <algorithm>
#include <cmath>

namespace petzval {
namespace {

/// Differences of rays over 1e-4 of the stop are off by 1e-6 at most where a ghost is focused near the
/// sensor.
void expect_paraxial_ghosts(const Lens& lens, const Lens& as_good_as_centred, const GhostOptions& options) {
  const std::vector<Ghost> paraxial = ghosts(lens, options);
  const std::vector<PosedGhost> real = ghosts_about_chief_ray(as_good_as_centred, options);
  ASSERT_EQ(real.size(), paraxial.size());
  for (const PosedGhost& each : real) {
    const auto same = std::ranges::find_if(paraxial, [&](const Ghost& ghost) {
      return ghost.first == each.ghost.first && ghost.second == each.ghost.second &&
             ghost.third == each.ghost.third && ghost.fourth == each.ghost.fourth;
    });
    ASSERT_NE(same, paraxial.end());
    const std::string where = std::to_string(same->first) + " " + std::to_string(same->second);
    EXPECT_NEAR(each.ghost.focus_mm / same->focus_mm, 1, 1e-4) << where;
    EXPECT_NEAR(each.ghost.diameter_mm / same->diameter_mm, 1, 1e-4) << where;
    EXPECT_NEAR(each.ghost.magnification / same->magnification, 1, 1e-4) << where;
    EXPECT_NEAR(each.ghost.transmittance / same->transmittance, 1, 1e-6) << where;
    EXPECT_NEAR(each.ghost.relative_irradiance / same->relative_irradiance, 1, 2e-4) << where;
    EXPECT_NEAR(each.x_mm, 0, 1e-6) << where;
    EXPECT_NEAR(each.y_mm, 0, 1e-6) << where;
  }
}

TEST(GhostsAboutChiefRay, AreParaxialOnesOfLensesThatAreAsGoodAsCentred) {
  GhostOptions options;
  options.sensor_reflectance = 0.05;
  for (const char* name : {"cooke-triplet", "double-gauss"}) {
    const Lens lens = read_lens(name).lens;
    Lens nearly = lens, moved = lens;
    nearly.groups = {{2, 3, {0, 0, 0, 1e-10, 0, 0}, 0}};
    expect_paraxial_ghosts(lens, nearly, options);
    // With the sensor, and for light from infinity, it does not matter where the lens stands.
    moved.groups = {{0, lens.surfaces.size(), {0.7, -0.4, 0, 0, 0, 0}, 0}};
    expect_paraxial_ghosts(lens, moved, options);
    // A plane mirror behind it, and the sensor beside the axis.
    Lens folded = lens;
    constexpr double to_mirror_mm = 20;
    Surface mirror = Surface::sphere(INFINITY, to_mirror_mm - lens.surfaces.back().thickness_mm);
    mirror.mirror = true;
    mirror.pose.tilt_x_deg = -45;
    folded.surfaces.back().thickness_mm = to_mirror_mm;
    folded.surfaces.push_back(mirror);
    folded.groups = {{lens.surfaces.size(), lens.surfaces.size() + 1, {0, 0, 0, 90, 0, 0}, 0}};
    GhostOptions of_glass;
    expect_paraxial_ghosts(lens, folded, of_glass);
    // Thrown straight back, it is centred.
    folded.groups.clear();
    folded.surfaces.back().pose = {};
    expect_paraxial_ghosts(lens, folded, of_glass);
  }
  options.reflections = 4;
  const Lens lens = read_lens("cooke-triplet").lens;
  Lens nearly = lens;
  nearly.groups = {{2, 3, {0, 0, 0, 1e-10, 0, 0}, 0}};
  EXPECT_EQ(ghosts_about_chief_ray(nearly, options).size(), ghosts(lens, options).size());
}

TEST(GhostsAboutChiefRay, OfAWedgeLieByItsAngleTimesThreeIndicesLessOne) {
  // A face that is turned by a throws light by (n − 1) a, and what both faces have reflected by (3n − 1) a.
  constexpr double index = 1.5, far_mm = 100, angle_deg = 0.01;
  Lens lens;
  lens.surfaces = {Surface::sphere(INFINITY, 1e-3, Material(Material::Constant{index})),
                   Surface::sphere(INFINITY, far_mm)};
  lens.surfaces[0].stop = true;
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 3};
  for (const bool about_x : {true, false}) {
    (about_x ? lens.surfaces[1].pose.tilt_x_deg : lens.surfaces[1].pose.tilt_y_deg) = angle_deg;
    const std::vector<PosedGhost> all = ghosts_about_chief_ray(lens);
    ASSERT_EQ(all.size(), 1u);
    const double apart = 2 * index * radians(angle_deg) * far_mm;
    // Turned about x its normal leans to −y, about y to +x; light turns away from the thin side.
    EXPECT_NEAR(about_x ? std::abs(all[0].y_mm) : std::abs(all[0].x_mm), apart, 1e-3 * apart);
    EXPECT_NEAR(about_x ? all[0].x_mm : all[0].y_mm, 0, 1e-6 * apart);
    EXPECT_NEAR(all[0].ghost.relative_irradiance, 0.04 * 0.04, 1e-8);
    EXPECT_NEAR(all[0].ghost.diameter_mm, 6, 1e-5);
    lens.surfaces[1].pose = {};
  }
}

TEST(GhostsAboutChiefRay, OfWhatAnApertureStopsHaveNoLight) {
  Lens lens = read_lens("cooke-triplet").lens;
  lens.surfaces[1].pose.decentre_y_mm = 9;
  lens.surfaces[1].semi_diameter_mm = 8;
  for (const PosedGhost& each : ghosts_about_chief_ray(lens)) EXPECT_EQ(each.ghost.irradiance, 0);
}

TEST(GhostsAboutChiefRay, SaysWhatWouldBeRight) {
  Lens lens = read_lens("cooke-triplet").lens;
  lens.groups = {{2, 3, {0, 0.1, 0, 0, 0, 0}, 0}};
  GhostOptions options;
  options.reflections = 3;
  EXPECT_THROW(ghosts_about_chief_ray(lens, options), InputError);
}

}  // namespace
}  // namespace petzval
