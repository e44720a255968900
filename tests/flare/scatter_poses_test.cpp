// SPDX-License-Identifier: BSD-3-Clause
// Scatter in lenses with poses: moved as a whole, folded or hardly moved it is that of the centred lens.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/flare/veiling_glare.h>
#include <petzval/lens/lens_file.h>

#include <cmath>

namespace petzval {
namespace {

constexpr double posed_scatter_nm = 550;

Lens rough_triplet() {
  return with_scatter(read_lens("cooke-triplet").lens, Scatter{.roughness_nm = 2});
}

Lens moved_rough_triplet(const Pose& pose) {
  Lens lens = rough_triplet();
  lens.groups = {{0, lens.surfaces.size(), pose, 0}};
  return lens;
}

Lens folded_rough_triplet() {
  Lens lens = rough_triplet();
  constexpr double to_mirror_mm = 20;
  Surface mirror = Surface::sphere(INFINITY, to_mirror_mm - lens.surfaces.back().thickness_mm);
  mirror.mirror = true;
  mirror.pose.tilt_x_deg = -45;
  lens.surfaces.back().thickness_mm = to_mirror_mm;
  lens.surfaces.push_back(mirror);
  lens.groups = {{6, 7, {0, 0, 0, 90, 0, 0}, 0}};
  lens.validate();
  return lens;
}

ScatterSpread posed_spread(const Lens& lens, double right, double up) {
  Losses losses;
  losses.fresnel = true;
  const ScatterTracer tracer(lens, posed_scatter_nm, losses);
  BrightSource source;
  source.right = right, source.up = up;
  source.irradiance = {1};
  const std::vector<std::array<double, 2>> places{{0, 0}, {2, -3}, {-6, 4}, {1, 9}};
  return scatter_spread(tracer, source, places, {.across = 24});
}

/// The same rays but for rounding and the steps of Newton's method: 1e-6 of the direction each.
void expect_same_scatter(const ScatterSpread& a, const ScatterSpread& b) {
  ASSERT_GT(a.image.flux_mm2, 0);
  EXPECT_NEAR(b.image.flux_mm2 / a.image.flux_mm2, 1, 1e-9);
  EXPECT_NEAR(b.image.x_mm, a.image.x_mm, 1e-8);
  EXPECT_NEAR(b.image.y_mm, a.image.y_mm, 1e-8);
  for (std::size_t i = 0; i < a.by_surface.size(); ++i)
    for (std::size_t k = 0; k < 6; ++k)
      EXPECT_NEAR(b.by_surface[i][k] / a.by_surface[i][k], 1, 1e-5) << "place " << i << ", surface " << k;
}

TEST(ScatterPoses, TooSmallToMatterDoNotMatter) {
  Lens lens = rough_triplet();
  const ScatterSpread centred = posed_spread(lens, 0.1, -0.05);
  for (Surface& surface : lens.surfaces) surface.pose = {1e-12, -1e-12, 1e-12, 1e-12, -1e-12, 1e-12};
  lens.sensor_pose.tilt_y_deg = 1e-12;
  expect_same_scatter(centred, posed_spread(lens, 0.1, -0.05));
}

TEST(ScatterPoses, ALensShiftedAsAWholeScattersFarLightAsBefore) {
  expect_same_scatter(posed_spread(rough_triplet(), 0.1, -0.05),
                      posed_spread(moved_rough_triplet({1.5, -2, 0, 0, 0, 0}), 0.1, -0.05));
}

TEST(ScatterPoses, AFoldedLensScattersAsTheUnfoldedOne) {
  expect_same_scatter(posed_spread(rough_triplet(), 0.1, -0.05),
                      posed_spread(folded_rough_triplet(), 0.1, -0.05));
}

TEST(ScatterPoses, ASurfaceThatDoesNothingChangesNothing) {
  Lens lens = rough_triplet();
  const ScatterSpread alone = posed_spread(lens, 0.1, -0.05);
  constexpr double behind_mm = 10;
  lens.surfaces.push_back(Surface::sphere(INFINITY, lens.surfaces.back().thickness_mm - behind_mm));
  lens.surfaces[lens.surfaces.size() - 2].thickness_mm = behind_mm;
  expect_same_scatter(alone, posed_spread(lens, 0.1, -0.05));
}

TEST(ScatterPoses, ALensTiltedAsAWholeSeesTheSourceMoved) {
  // Cells of light lie on another plane, 24 across the pupil: a hundredth.
  constexpr double tilt_deg = 4, seen_deg = 5;
  const ScatterSpread one = posed_spread(rough_triplet(), 0, std::tan(radians(seen_deg)));
  const ScatterSpread other =
      posed_spread(moved_rough_triplet({0, 0, 0, tilt_deg, 0, 0}), 0, std::tan(radians(seen_deg + tilt_deg)));
  EXPECT_NEAR(other.image.flux_mm2 / one.image.flux_mm2, 1, 0.01);
  EXPECT_NEAR(other.image.y_mm, one.image.y_mm, 1e-3);
  for (std::size_t i = 0; i < one.by_surface.size(); ++i) EXPECT_NEAR(other.at(i) / one.at(i), 1, 0.02) << i;
}

TEST(ScatterPoses, ASourceIsFoundThatAPosedLensImagesThere) {
  Lens lens = rough_triplet();
  lens.groups = {{2, 3, {0.3, -0.5, 0, 1, 0, 0}, 0}};
  lens.sensor_pose.tilt_z_deg = 30;
  const ScatterTracer tracer(lens, posed_scatter_nm, {});
  for (const auto& [x, y] : {std::array{0.0, 0.0}, std::array{5.0, -3.0}, std::array{-8.0, 8.0}}) {
    SourceImage image;
    tracer.light(SourceBeam(source_imaged_at(lens, tracer, x, y)), 10, &image);
    // A thousandth of the distance from the axis, or of half a millimetre.
    const double close = 1e-3 * std::max(std::hypot(x, y), 0.5);
    EXPECT_NEAR(image.x_mm, x, close);
    EXPECT_NEAR(image.y_mm, y, close);
  }
}

TEST(ScatterPoses, AMirrorThatScattersIsRefused) {
  Lens lens = folded_rough_triplet();
  lens.surfaces[6].scatter = Scatter{.roughness_nm = 1};
  EXPECT_THROW(ScatterTracer(lens, posed_scatter_nm, {}), InputError);
}

/// Above the axis, where the grids of rays are their own mirror images.
VeilingGlare posed_glare(const Lens& lens) {
  const GlareOptions options{.hole_mm = 4, .surround_deg = 50, .across = 12, .rings = 10, .spokes = 6};
  return veiling_glare(lens, ScatterTracer(lens, posed_scatter_nm, {}), {0, 8}, 0.02, options);
}

TEST(VeilingGlareOfPosedLenses, HardlyMovedIsThatOfTheCentredLens) {
  // Whole circles of the surround, where the centred lens needs halves. Edges of the hole are found to 1e-5
  // of their heights, which is 4e-5 of its width; scatter goes about as its inverse square there.
  const VeilingGlare centred = posed_glare(rough_triplet());
  const VeilingGlare posed = posed_glare(moved_rough_triplet({0, 0, 0, 1e-9, 0, 0}));
  EXPECT_NEAR(posed.scatter_sr / centred.scatter_sr, 1, 1e-4);
  EXPECT_NEAR(posed.white_sr / centred.white_sr, 1, 1e-4);
  EXPECT_NEAR(posed.scattered_share / centred.scattered_share, 1, 1e-4);
}

TEST(VeilingGlareOfPosedLenses, FoldedIsThatOfTheStraightLens) {
  const VeilingGlare straight = posed_glare(rough_triplet()), folded = posed_glare(folded_rough_triplet());
  EXPECT_NEAR(folded.scatter_sr / straight.scatter_sr, 1, 1e-4);
  EXPECT_NEAR(folded.white_sr / straight.white_sr, 1, 1e-4);
}

TEST(VeilingGlareOfPosedLenses, TurnedAsAWholeIsThatOfTheCentredLens) {
  // But for the rim of the surround, 50 degrees from an axis that is another.
  const VeilingGlare centred = posed_glare(rough_triplet());
  const VeilingGlare turned = posed_glare(moved_rough_triplet({0.4, -0.3, 0, 4, -3, 0}));
  EXPECT_NEAR(turned.scatter_sr / centred.scatter_sr, 1, 0.02);
  EXPECT_NEAR(turned.scattered_share / centred.scattered_share, 1, 1e-3);
}

TEST(VeilingGlareOfPosedLenses, CountsTheGhostsOfTheWholeSurround) {
  // Few sources on each ring, in place of the mean over the places that one source lights.
  const Lens lens = rough_triplet();
  const GlareOptions options{.hole_mm = 4, .surround_deg = 20, .ghost_rings = 12};
  const std::array<std::array<double, 2>, 3> places{{{0, 0}, {-3, 6}, {8, 2}}};
  const std::vector<double> centred = ghost_veil(lens, posed_scatter_nm, places, options);
  const std::vector<double> posed =
      ghost_veil(moved_rough_triplet({0, 0, 0, 1e-9, 0, 0}), posed_scatter_nm, places, options);
  for (std::size_t i = 0; i < places.size(); ++i) EXPECT_NEAR(posed[i] / centred[i], 1, 0.1) << i;
}

}  // namespace
}  // namespace petzval
