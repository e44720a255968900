// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/stop_aim.h>

#include <cmath>

#include "golden_lenses.h"

namespace petzval {
namespace {

class GoldenStopAim : public GoldenLensTest {};

TEST_P(GoldenStopAim, LandsWhereAnotherTracersRaysLand) {
  // Rays of the reference are named by the point of the stop that they cross.
  int compared = 0;
  for (const nlohmann::json& row : reference["rays"]["rows"]) {
    FieldTracer tracer(lens, row["wavelength_um"].get<double>() * 1000, Tracer::Clip::stop_only);
    const ChiefRay chief = *tracer.chief_ray(row["field_deg"]);
    StopAim aim = *StopAim::of(tracer, chief);
    const std::optional<PupilRay> ray = aim.ray(row["stop_px"], row["stop_py"]);
    ASSERT_TRUE(ray) << row.dump();
    // The reference aimed to about 1e-9 of the stop, and a spot is 1e-2 of it: mm.
    EXPECT_NEAR(ray->x_mm, row["image_xyz"][0], 1e-9);
    EXPECT_NEAR(ray->y_mm + chief.image_height_mm, row["image_xyz"][1], 1e-9);
    EXPECT_NEAR(ray->beta, row["image_dir"][1], 1e-9);
    ++compared;
  }
  EXPECT_GT(compared, 40);
}

INSTANTIATE_TEST_SUITE_P(Lenses, GoldenStopAim, golden_lenses());

TEST(StopAim, KnowsTheApertures) {
  const Lens lens = read_lens("double-gauss").lens;
  const double field = 14;  // the outer elements take a part of this beam
  FieldTracer open(lens, 587.5618, Tracer::Clip::stop_only), clipped(lens, 587.5618);
  StopAim all = *StopAim::of(open, *open.chief_ray(field)),
          some = *StopAim::of(clipped, *clipped.chief_ray(field));
  const PupilBoundary boundary = *clipped.object_pupil(*clipped.chief_ray(field));
  const PupilBoundary whole = *open.object_pupil(*open.chief_ray(field));
  int passed = 0, asked = 0;
  for (double y = -1; y <= 1.0001; y += 0.05)
    for (double x = -1; x <= 1.0001; x += 0.05) {
      if (x * x + y * y > 1) continue;
      ++asked;
      EXPECT_TRUE(all.ray(x, y)) << x << ", " << y;
      passed += some.ray(x, y).has_value();
    }
  // Counting on a grid of 1257 places is good to about a hundredth; areas on the beam and on the stop differ
  // by as much.
  EXPECT_NEAR(static_cast<double>(passed) / asked, boundary.area() / whole.area(), 0.02);
}

TEST(StopAim, FollowsTheWanderingPupilOfAFisheye) {
  const Lens lens = read_lens("fisheye-10mm").lens;
  FieldTracer tracer(lens, lens.reference_wavelength_nm, Tracer::Clip::stop_only);
  for (const double field : {0.0, 40.0, 70.0}) {
    const std::optional<ChiefRay> chief = tracer.chief_ray(field);
    ASSERT_TRUE(chief) << field;
    StopAim aim = *StopAim::of(tracer, *chief);
    const PupilRay centre = *aim.ray(0, 0);
    EXPECT_NEAR(centre.y_mm, 0, 1e-9);
    for (const double y : {-0.9, 0.3, 0.9}) {
      const std::optional<PupilRay> ray = aim.ray(0.2, y);
      ASSERT_TRUE(ray) << field << ", " << y;
      EXPECT_NEAR(ray->stop_y_mm, y * tracer.tracer().stop_radius_mm(), 1e-8);
      EXPECT_NEAR(ray->stop_x_mm, 0.2 * tracer.tracer().stop_radius_mm(), 1e-8);
    }
  }
}

}  // namespace
}  // namespace petzval
