// SPDX-License-Identifier: BSD-3-Clause
// Objects a hundred metres to a thousand kilometres away: their pencils are so slender that direction cosines
// have few digits within a pupil.
#include <gtest/gtest.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/wave_rays.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>

#include <cmath>
#include <optional>

namespace petzval {
namespace {

Lens placed(const std::string& name, std::optional<double> object_mm) {
  Lens lens = read_lens(name).lens;
  lens.object_distance_mm = object_mm;
  lens.fields = {Fields::Kind::angle_deg, {0}};
  return lens;
}

class FarObject : public ::testing::TestWithParam<const char*> {};

// A chief ray of a distant point leaves the object at the angle at which a parallel one arrives, if both are
// measured at the centre of the entrance pupil. Where the pupil wanders by Δz, that point's ray is tilted by
// Δz·tan θ/D: images differ by less than (focal length)·(length of the lens)/D.
TEST_P(FarObject, HasTheImageHeightsOfOneAtInfinity) {
  const Lens infinite = placed(GetParam(), {});
  const FirstOrder facts = first_order(infinite);
  FieldTracer parallel(infinite, 550);
  for (double object_mm = 1e4; object_mm < 2e10; object_mm *= 10) {
    const Lens lens = placed(GetParam(), object_mm);
    FieldTracer tracer(lens, 550);
    const double allowed_mm = facts.efl_mm * lens.total_track_mm() / object_mm + 1e-8 * facts.efl_mm;
    for (const double angle_deg : {0.5, 3.0, 8.0}) {
      const auto near =
          tracer.chief_ray(-(object_mm + facts.entrance_pupil.position_mm) * std::tan(radians(angle_deg)));
      const auto far = parallel.chief_ray(angle_deg);
      ASSERT_TRUE(near && far) << object_mm << ' ' << angle_deg;
      EXPECT_NEAR(near->image_height_mm, far->image_height_mm, allowed_mm) << object_mm << ' ' << angle_deg;
    }
  }
}

// Solid angles of the pupil, times the square of the distance, become areas of the beam.
TEST_P(FarObject, HasTheLightOfOneAtInfinity) {
  const Lens infinite = placed(GetParam(), {});
  FieldTracer parallel(infinite, 550);
  for (double object_mm = 1e7; object_mm < 2e9; object_mm *= 10) {
    const Lens lens = placed(GetParam(), object_mm);
    FieldTracer tracer(lens, 550);
    for (const double angle_deg : {0.0, 5.0}) {
      const auto near = tracer.chief_ray(-object_mm * std::tan(radians(angle_deg)));
      const auto far = parallel.chief_ray(angle_deg);
      ASSERT_TRUE(near && far);
      // 1e-5: what half a lens's length makes of a field at 10 km.
      EXPECT_NEAR(tracer.g_source_sr(*near) / parallel.g_source_sr(*far), 1, 1e-5)
          << object_mm << ' ' << angle_deg;
      EXPECT_NEAR(tracer.g_sensor_sr(*near) / parallel.g_sensor_sr(*far), 1, 1e-5)
          << object_mm << ' ' << angle_deg;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Lenses, FarObject,
                         ::testing::Values("edmund-54852", "cooke-triplet", "double-gauss", "dgauss-50mm",
                                           "telephoto-250mm", "wide-22mm", "fisheye-10mm"));

// Between the waves of a point at distance D and flat ones lies the sag r²/2D at the plane through vertex 1.
// (To 2 %: a ray that is tilted by r/D is displaced where aberrations have bent it.) From 10 km on all of it
// goes as 1/D to 2e-6 waves, where paths of 10⁹ mm have steps of 2e-4.
TEST(FarObjectWaves, DifferFromFlatOnesByTheirSag) {
  const double lambda_mm = 550e-6;
  const Lens infinite = placed("telephoto-250mm", {});
  FieldTracer parallel(infinite, 550);
  const auto phases = [&](FieldTracer& tracer, const std::vector<PupilNode>& nodes) {
    const ChiefRay chief = *tracer.chief_ray(0);
    std::vector<double> waves;
    for (const WaveRay& ray : trace_wave_rays(tracer, chief, *tracer.object_pupil(chief, 32), nodes)) {
      EXPECT_TRUE(ray.passes);
      waves.push_back(ray.phase_waves);
    }
    return waves;
  };
  const double heights_mm[] = {5, 10, 15, 20};
  std::vector<PupilNode> flat;
  for (const double r : heights_mm) flat.push_back({r, 0, 1});
  const std::vector<double> wanted = phases(parallel, flat);
  std::vector<double> at_10_km;
  for (const double object_mm : {1e7, 1e8, 1e9}) {
    const Lens lens = placed("telephoto-250mm", object_mm);
    FieldTracer tracer(lens, 550);
    std::vector<PupilNode> round;
    for (const double r : heights_mm) round.push_back({r / std::hypot(r, object_mm), 0, 1});
    const std::vector<double> got = phases(tracer, round);
    for (std::size_t i = 0; i < got.size(); ++i) {
      const double sag_waves = heights_mm[i] * heights_mm[i] / (2 * object_mm * lambda_mm);
      if (object_mm == 1e7) {
        EXPECT_NEAR((got[i] - wanted[i]) / sag_waves, 1, 0.02) << heights_mm[i];
        at_10_km.push_back(got[i] - wanted[i]);
      }
      EXPECT_NEAR(got[i] - wanted[i], at_10_km[i] * 1e7 / object_mm, 2e-6)
          << object_mm << ' ' << heights_mm[i];
    }
  }
}

}  // namespace
}  // namespace petzval
