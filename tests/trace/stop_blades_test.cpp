// SPDX-License-Identifier: BSD-3-Clause
// A stop of blades lets through what falls into its polygon, one ray at a time and in batches.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/trace/kernel_path.h>
#include <petzval/trace/radiance_tracer.h>
#include <petzval/trace/tracer.h>

#include <cmath>

namespace petzval {
namespace {

/// Nothing but a stop of 5 mm radius: rays along the axis meet it where they start.
Lens stop_alone() {
  Lens lens;
  lens.name = "stop";
  Surface stop;
  stop.stop = true;
  stop.thickness_mm = 10;
  lens.surfaces = {stop};
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 5};
  return lens;
}

/// Whether a point lies inside of a polygon, by the winding of its corners: no normals, no apothem.
bool inside(const StopBlades& blades, double radius, double x, double y) {
  for (int i = 0; i < blades.count; ++i) {
    const double a = (blades.rotation_deg + 360.0 * i / blades.count) * M_PI / 180,
                 b = (blades.rotation_deg + 360.0 * (i + 1) / blades.count) * M_PI / 180;
    // The first corner at the top, the next ones anticlockwise.
    const double ax = -radius * std::sin(a), ay = radius * std::cos(a), bx = -radius * std::sin(b),
                 by = radius * std::cos(b);
    if ((bx - ax) * (y - ay) - (by - ay) * (x - ax) < 0) return false;
  }
  return true;
}

TEST(StopBlades, LetThroughWhatFallsIntoThePolygon) {
  const Tracer round(stop_alone(), 550);
  for (const StopBlades& blades :
       {StopBlades{3, 0}, StopBlades{5, 11}, StopBlades{6, 0}, StopBlades{9, -25}}) {
    const Tracer tracer = round.with_blades(blades);
    constexpr int side = 200;
    RayBatch batch(side * side);
    RadianceRays floats(side * side);
    std::vector<bool> expected;
    int count = 0;
    for (std::size_t i = 0; i < side * side; ++i) {
      const double x = 10 * ((static_cast<double>(i % side) + 0.5) / side - 0.5),
                   y = 10 * ((static_cast<double>(i / side) + 0.5) / side - 0.5);
      expected.push_back(inside(blades, 5, x, y));
      count += expected.back();
      batch.x_mm[i] = x, batch.y_mm[i] = y, batch.z_mm[i] = 3, batch.n[i] = -1;
      floats.x_mm[i] = static_cast<float>(x), floats.y_mm[i] = static_cast<float>(y);
      floats.z_mm[i] = -3, floats.n[i] = 1;
      const Ray ray{{x, y, -3}};
      ASSERT_EQ(tracer.trace(ray).status == RayStatus::ok, expected[i]) << x << ", " << y;
      ASSERT_EQ(tracer.clearance(ray, false).worst <= 0, expected[i]);
      ASSERT_EQ(tracer.trace(ray, Tracer::Clip::none).status, RayStatus::ok);
    }
    tracer.trace_backward(batch);
    RadianceTracer(tracer, RadianceTracer::Direction::forward).trace(floats);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      ASSERT_EQ(batch.status[i] == RayStatus::ok, expected[i]);
      ASSERT_EQ(floats.passes[i] == 1, expected[i]);
    }
    // The grid's error: a row of cells, of which the outline crosses at most 4 · 200, at random.
    EXPECT_NEAR(count * 100.0 / (side * side) / (25 * M_PI), blades.area_share(), 3e-3);
  }
}

TEST(StopBlades, MeasureTheClearanceFromTheirEdges) {
  const Tracer tracer = Tracer(stop_alone(), 550).with_blades({6, 0});
  // A hexagon with a corner at the top: its edges are upright left and right, 5 cos 30° away.
  const double apothem = 5 * std::cos(M_PI / 6);
  EXPECT_NEAR(tracer.clearance(Ray{{0.5 * apothem, 0, -1}}, false).worst, 0.25 - 1, 1e-8);
  EXPECT_NEAR(tracer.clearance(Ray{{0, 4.999, -1}}, false).worst, 4.999 * 4.999 / 25 - 1, 1e-8);
  EXPECT_EQ(tracer.trace(Ray{{1.001 * apothem, 0, -1}}).status, RayStatus::vignetted);
}

TEST(StopBlades, RefuseWhatIsNoPolygon) {
  const Tracer round(stop_alone(), 550);
  for (const StopBlades& blades : {StopBlades{1, 0}, StopBlades{2, 0}, StopBlades{-3, 0}, StopBlades{65, 0},
                                   StopBlades{5, std::nan("")}})
    EXPECT_THROW(round.with_blades(blades), InputError);
  EXPECT_EQ(round.with_blades({}).trace(Ray{{4.99, 0, -1}}).status, RayStatus::ok);
}

}  // namespace
}  // namespace petzval
