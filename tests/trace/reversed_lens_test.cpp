// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/lens/lens_file.h>
#include <petzval/lens/reversed_lens.h>
#include <petzval/trace/tracer.h>

#include <cmath>

namespace petzval {
namespace {

Lens off_its_places() {
  Lens lens = read_lens("cooke-triplet").lens;
  lens.surfaces[0].pose = {0.3, -0.2, 0.1, 1.5, -0.7, 20};
  lens.surfaces[4].pose = {-0.1, 0.25, -0.05, -0.8, 0.4, 0};
  lens.groups = {{2, 3, {0.2, 0.1, 0.15, 0.9, -0.6, 3}, 1.2}, {0, 3, {-0.1, 0.3, 0, -0.5, 0.8, 0}, 4}};
  return lens;
}

/// Light goes back the way it came: a ray that leaves a lens, sent back into the lens turned round, is the
/// ray that entered it. Places of the lens turned round are (−x, y, length − z).
TEST(ReversedLens, SendsRaysBackThroughPoses) {
  constexpr double nm = 550;
  const Lens lens = off_its_places(), turned = reversed_lens(lens);
  const Tracer there(lens, nm), back(turned, nm);
  const std::size_t last = lens.surfaces.size() - 1;
  const double length_mm = there.vertex_z_mm(last);
  const auto swapped = [](const std::array<double, 3>& direction) {
    return std::array<double, 3>{direction[0], -direction[1], direction[2]};
  };
  for (const std::array<double, 2> at :
       {std::array{0.0, 0.0}, std::array{2.0, -1.0}, std::array{-1.5, 2.5}}) {
    const double l = 0.05, m = -0.08;
    const Ray start{{at[0], at[1], -3}, {l, m, std::sqrt(1 - l * l - m * m)}};
    std::vector<Intersection> met, met_back;
    const Ray end = there.trace(start, Tracer::Clip::none, &met);
    ASSERT_EQ(end.status, RayStatus::ok);
    const Ray sent{{-end.point_mm[0], end.point_mm[1], length_mm - end.point_mm[2]}, swapped(end.direction)};
    ASSERT_EQ(back.trace(sent, Tracer::Clip::none, &met_back).status, RayStatus::ok);
    ASSERT_EQ(met.size(), met_back.size());
    for (std::size_t i = 0; i <= last; ++i) {
      const auto &one = met[i].point_mm, &other = met_back[last - i].point_mm;
      EXPECT_NEAR(other[0], -one[0], 1e-9) << i;
      EXPECT_NEAR(other[1], one[1], 1e-9) << i;
      EXPECT_NEAR(other[2], length_mm - one[2], 1e-9) << i;
    }
    const auto &out = met_back[last].direction_after, wanted = swapped(start.direction);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(out[i], wanted[i], 1e-9) << i;
  }
}

TEST(ReversedLens, RefusesASensorOffItsPlace) {
  Lens lens = off_its_places();
  lens.sensor_pose.tilt_x_deg = 1;
  EXPECT_THROW(reversed_lens(lens), InputError);
  lens = off_its_places();
  lens.groups[0].last = lens.surfaces.size();
  EXPECT_THROW(reversed_lens(lens), InputError);
}

}  // namespace
}  // namespace petzval
