// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/ray_steps.h>
#include <petzval/base/units.h>

#include <cmath>

#include "golden_lenses.h"

namespace petzval {
namespace {

class GoldenSteps : public GoldenLensTest {};

TEST_P(GoldenSteps, MeetTheSurfacesWhereAnotherTracersRaysDo) {
  int compared = 0;
  for (const nlohmann::json& row : reference["rays"]["rows"]) {
    FieldTracer tracer(lens, row["wavelength_um"].get<double>() * 1000, Tracer::Clip::stop_only);
    const ChiefRay chief = *tracer.chief_ray(row["field_deg"]);
    const std::vector<RayStep> steps = ray_steps(tracer, chief, row["stop_px"], row["stop_py"]);
    ASSERT_EQ(steps.size(), lens.surfaces.size() + 1);
    for (std::size_t i = 0; i < steps.size(); ++i) {
      ++compared;
      EXPECT_NEAR(steps[i].point_mm[0], row["surface_x"][i], 1e-9);  // the reference's aim
      EXPECT_NEAR(steps[i].point_mm[1], row["surface_y"][i], 1e-9);
    }
  }
  EXPECT_GT(compared, 300);
}

TEST_P(GoldenSteps, ObeySnellsLawInThePlaneOfIncidence) {
  FieldTracer tracer(lens, lens.reference_wavelength_nm);
  const ChiefRay chief = *tracer.chief_ray(lens.fields.values[1]);
  const std::vector<RayStep> steps = ray_steps(tracer, chief, 0.3, -0.5);
  double opl = 0;
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
    const RayStep& step = steps[i];
    opl += step.index_before * step.path_mm;
    EXPECT_NEAR(step.opl_mm, opl, 1e-12);
    EXPECT_NEAR(step.index_before * std::sin(radians(step.incidence_deg)),
                step.index_after * std::sin(radians(step.refraction_deg)), 1e-9);  // acos near 1
    // n' d' − n d is along the normal.
    std::array<double, 3> change{};
    for (std::size_t k = 0; k < 3; ++k)
      change[k] = step.index_after * step.direction_after[k] - step.index_before * step.direction_before[k];
    const auto& n = step.normal;
    EXPECT_NEAR(std::hypot(change[1] * n[2] - change[2] * n[1], change[2] * n[0] - change[0] * n[2],
                           change[0] * n[1] - change[1] * n[0]),
                0, 1e-12);
  }
  EXPECT_TRUE(ray_steps(tracer, chief, 0, 1.2).empty());
}

TEST_P(GoldenSteps, RunBackwardsOnTheSameWay) {
  FieldTracer tracer(lens, lens.reference_wavelength_nm);
  const ChiefRay chief = *tracer.chief_ray(lens.fields.values[1]);
  const std::vector<RayStep> chief_forth = ray_steps(tracer, chief, 0, 0);
  const std::vector<RayStep> back =
      ray_steps_from_film(tracer.tracer(), chief_forth.back().point_mm[1], 0, 0);
  ASSERT_EQ(back.size() + 1, chief_forth.size());
  for (std::size_t i = 0; i < back.size(); ++i) {
    const RayStep &here = back[i], &there = chief_forth[back.size() - 1 - i];
    EXPECT_EQ(here.surface, there.surface);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(here.point_mm[k], there.point_mm[k], 1e-7);  // the aims at the stop
      EXPECT_NEAR(here.direction_after[k], -there.direction_before[k], 1e-8);
    }
    EXPECT_NEAR(here.incidence_deg, there.refraction_deg, 1e-5);
  }
}

TEST_P(GoldenSteps, SayWhereARayEnds) {
  const Tracer tracer(lens, lens.reference_wavelength_nm);
  const double rim = lens.surfaces[0].semi_diameter_mm.value_or(0);
  ASSERT_GT(rim, 0);
  // Along the axis, a millimetre beyond the rim of the first surface.
  const auto end = blocked(tracer, {{0, rim + 1, -5}, {0, 0, 1}});
  ASSERT_TRUE(end);
  EXPECT_EQ(end->surface, 0);
  EXPECT_NEAR(end->radius_mm, rim + 1, 1e-12);
  EXPECT_NEAR(end->beyond_mm(), 1, 1e-6);  // rims are a rounding wider
  EXPECT_NE(end->text().find("surfaces[0]"), std::string::npos);
  EXPECT_FALSE(blocked(tracer, {{0, 0, -5}, {0, 0, 1}}));
}

INSTANTIATE_TEST_SUITE_P(Lenses, GoldenSteps, golden_lenses());

}  // namespace
}  // namespace petzval
