// SPDX-License-Identifier: BSD-3-Clause
// Fans of rays from points of the film.
#include <gtest/gtest.h>
#include <petzval/analysis/film_fan.h>
#include <petzval/lens/lens_file.h>

#include <cmath>

namespace petzval {
namespace {

TEST(FilmFan, RunsFromRimToRimOfThePupil) {
  const Lens lens = read_lens("dgauss-50mm").lens;
  const Tracer tracer(lens, 587.5618);
  for (const double height : {0.0, 12.0}) {
    const auto fan = film_fan(tracer, height, FilmSection::meridional, 7, 20);
    ASSERT_EQ(fan.size(), 7u);
    for (const FilmRay& ray : fan) {
      // Film, 11 surfaces and the start in front of them.
      ASSERT_EQ(ray.size(), lens.surfaces.size() + 2);
      EXPECT_NEAR(ray.back()[0], tracer.image_z_mm(), 1e-12);
      EXPECT_NEAR(ray.back()[1], height, 1e-12);
      EXPECT_NEAR(ray.front()[0], -20, 1e-9);
    }
    // The outermost graze an aperture: sent the other way, a little inside they pass, a little outside not.
    for (const std::size_t i : {std::size_t{0}, std::size_t{6}}) {
      const auto& [z0, y0] = fan[i][0];
      const auto& [z1, y1] = fan[i][1];
      const double length = std::hypot(z1 - z0, y1 - y0);
      const Ray ray{{0, y0, z0}, {0, (y1 - y0) / length, (z1 - z0) / length}};
      EXPECT_NEAR(tracer.clearance(ray, false).worst, 0, 1e-6) << height;
    }
  }
  // On the axis both sections are one.
  const auto upright = film_fan(tracer, 0, FilmSection::meridional, 5, 20),
             across = film_fan(tracer, 0, FilmSection::sagittal, 5, 20);
  for (std::size_t i = 0; i < 5; ++i)
    for (std::size_t k = 0; k < upright[i].size(); ++k) EXPECT_NEAR(upright[i][k][1], across[i][k][1], 1e-9);
}

TEST(FilmFan, IsSymmetricalAcross) {
  const Tracer tracer(read_lens("dgauss-50mm").lens, 587.5618);
  const auto fan = film_fan(tracer, 12, FilmSection::sagittal, 5, 20);
  ASSERT_EQ(fan.size(), 5u);
  for (std::size_t k = 0; k < fan[0].size(); ++k) {
    EXPECT_NEAR(fan[0][k][1], -fan[4][k][1], 1e-9);
    EXPECT_NEAR(fan[2][k][1], 0, 1e-9);
  }
  EXPECT_TRUE(film_fan(tracer, 500, FilmSection::sagittal, 5, 20).empty());
}

}  // namespace
}  // namespace petzval
