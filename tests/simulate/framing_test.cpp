// SPDX-License-Identifier: BSD-3-Clause
// How much of a chart or a photograph a frame shows.
#include <gtest/gtest.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>
#include <petzval/simulate/image.h>

#include <cmath>
#include <string>

namespace petzval {
namespace {

struct FramingCase {
  const char *lens, *sensor;
};
class Framing : public testing::TestWithParam<FramingCase> {
 protected:
  Framing() {
    camera_.lens = read_lens(GetParam().lens).lens;
    camera_.sensor = read_sensor(GetParam().sensor);
  }
  ImagePlan planned(double tolerance) const {
    ImageOptions options;
    options.imaging.product.tolerance = tolerance;
    return plan_image(SceneRequest{.name = "studio", .options = {.wavelengths_nm = {550}}}, camera_, options);
  }

  Camera camera_;
};

// Pictures of other tolerances and stops differ by their errors and by their blur alone.
TEST_P(Framing, DoesNotFollowToleranceOrStop) {
  const double finest = planned(1e-4).scene.horizontal_angle_deg();
  // A hundredth of a pixel at the edge of 640.
  constexpr double same = 3e-5;
  for (const double tolerance : {2e-2, 5e-3, 3e-3, 1e-3})
    EXPECT_NEAR(planned(tolerance).scene.horizontal_angle_deg() / finest, 1, same) << tolerance;
  camera_.f_number = 11;
  // The fields of a table reach as far as PSFs do, and its distortion lies between them: a tenth of a pixel.
  EXPECT_NEAR(planned(1e-3).scene.horizontal_angle_deg() / finest, 1, 10 * same);
}

// The ray of the scene's edge lands 2 % of half the frame beyond the frame.
TEST_P(Framing, IsWhereTheChiefRayOfTheEdgeLands) {
  camera_.sensor->geometry.rows = 1;  // nothing of the frame lies farther aside than the edge's middle
  const ImagePlan plan = planned(1e-3);
  const double edge_deg = plan.scene.horizontal_angle_deg() / 2;
  FieldTracer tracer(plan.lens->lens, 550);
  const auto chief = tracer.chief_ray(edge_deg);
  ASSERT_TRUE(chief);
  const double half_mm = camera_.sensor->geometry.width_mm() / 2;
  EXPECT_NEAR(std::abs(chief->image_height_mm) / half_mm, 1.02, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Bundled, Framing,
                         testing::Values(FramingCase{"dgauss-50mm", "64x48@540"},
                                         FramingCase{"edmund-54852", "64x48@75"},
                                         FramingCase{"m12-4.5mm", "64x48@75"},
                                         FramingCase{"cooke-triplet", "64x48@400"}),
                         [](const auto& of) {
                           std::string name = of.param.lens;
                           std::erase_if(name, [](char c) { return !std::isalnum(c); });
                           return name;
                         });

}  // namespace
}  // namespace petzval
