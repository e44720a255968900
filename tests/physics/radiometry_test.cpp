// SPDX-License-Identifier: BSD-3-Clause
// g_sensor and g_source against an independent backward ray count, and against each other by the divergence
// law.
#include <gtest/gtest.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>

#include <cmath>

#include "physics/independent_tracer.h"

namespace petzval {
namespace {

using independent::IndependentRay;
using independent::Real;
using independent::SphereTracer;

ChiefRay chief_at_height(FieldTracer& tracer, double height_mm) {
  return *tracer.chief_ray(*tracer.object_field_at_image_height(height_mm));
}

/// ∬ dα dβ by counting backward rays on a fine square grid with the independent tracer.
double counted_solid_angle(const Lens& lens, double wavelength_nm, double height_mm, int grid) {
  const SphereTracer tracer(lens, wavelength_nm, stop_radius_mm(lens));
  long passed = 0;
  for (int i = 0; i < grid; ++i)
    for (int j = 0; j < grid; ++j) {
      const Real a = -1 + 2 * (i + Real(0.5)) / grid, b = -1 + 2 * (j + Real(0.5)) / grid;
      if (a * a + b * b >= 1) continue;
      const IndependentRay ray{{0, height_mm, tracer.image_z()}, {-a, -b, -std::sqrt(1 - a * a - b * b)}};
      passed += tracer.trace(ray, true).has_value();
    }
  return 4.0 * static_cast<double>(passed) / (static_cast<double>(grid) * grid);
}

class EdmundHeights : public testing::TestWithParam<std::pair<double, double>> {};

TEST_P(EdmundHeights, SensorGEqualsPublishedFiguresAndARayCount) {
  const auto [height, expected] = GetParam();
  const Lens lens = read_lens("edmund-54852").lens;
  FieldTracer tracer(lens, 587.5618);
  const double g = tracer.g_sensor_sr(chief_at_height(tracer, height));
  // Figures of an independent prototype, at heights that it gives to 0.01 mm; g changes by up to 0.03 sr/mm.
  EXPECT_NEAR(g, expected, 0.03 * 0.005);
  // A square grid of N² points counts an area A with perimeter P to about P·(2/N)^1.5/√P ≈ 2e-4 A here.
  EXPECT_NEAR(counted_solid_angle(lens, 587.5618, height, 1600) / g, 1, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Heights, EdmundHeights,
                         testing::Values(std::pair{0.0, 0.22123}, std::pair{1.40, 0.21868},
                                         std::pair{2.37, 0.22200}, std::pair{2.75, 0.23078}));

TEST(SensorG, CountsVignettedPupilsRight) {
  // Both lenses vignet strongly towards their corners.
  for (const auto& [name, field] : {std::pair{"dgauss-50mm", 15.0}, std::pair{"wide-22mm", 30.0}}) {
    const Lens lens = read_lens(name).lens;
    FieldTracer tracer(lens, 587.5618);
    const ChiefRay axis = *tracer.chief_ray(0), chief = *tracer.chief_ray(field);
    const double g = tracer.g_sensor_sr(chief);
    EXPECT_LT(g, 0.9 * std::pow(std::cos(radians(field)), 4) * tracer.g_sensor_sr(axis))
        << name << " vignets";
    EXPECT_NEAR(counted_solid_angle(lens, 587.5618, chief.image_height_mm, 2200) / g, 1, 1e-3) << name;
  }
}

TEST(SensorG, OnAxisIsPiSineSquared) {
  // The marginal ray's sine, traced by the independent tracer from the image point outwards by bisection.
  for (const char* name : {"edmund-54852", "dgauss-50mm", "telephoto-250mm", "cooke-triplet"}) {
    const Lens lens = read_lens(name).lens;
    FieldTracer tracer(lens, 587.5618);
    const SphereTracer second(lens, 587.5618, stop_radius_mm(lens));
    Real low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
      const Real sine = (low + high) / 2;
      const IndependentRay ray{{0, 0, second.image_z()}, {0, -sine, -std::sqrt(1 - sine * sine)}};
      (second.trace(ray, true) ? low : high) = sine;
    }
    const double expected = pi * static_cast<double>(low * low);
    EXPECT_NEAR(tracer.g_sensor_sr(*tracer.chief_ray(0)) / expected, 1, 1e-8) << name;
  }
}

TEST(Radiometry, BlurringSourceGGivesSensorG) {
  // docs/CONVENTIONS.md: g_sensor = g_source − div(centroid offset × g_source), here in its radial form, with
  // second-order blur terms left out: (blur radius / field scale)² ≈ (10 µm / 1 mm)² = 1e-4.
  const Lens lens = read_lens("edmund-54852").lens;
  FieldTracer tracer(lens, 587.5618);
  const auto moment = [&](double height) {  // r · offset · g_source
    const ChiefRay chief = chief_at_height(tracer, height);
    const PupilBoundary pupil = *tracer.object_pupil(chief);
    const Pencil pencil = Pencil::from_object(lens, chief.object_field);
    double sum = 0, weight = 0;
    for (const PupilNode& node : pupil_nodes(pupil, 24)) {
      const Ray ray = tracer.tracer().trace(*pencil.ray(node.u, node.v), Tracer::Clip::none);
      sum += node.weight * (ray.point_mm[1] - chief.image_height_mm);
      weight += node.weight;
    }
    return height * sum / weight * tracer.g_source_sr(chief);
  };
  double largest_gap = 0;
  for (const double height : {0.7, 1.4, 2.0, 2.37}) {
    const ChiefRay chief = chief_at_height(tracer, height);
    const double step = 0.05;
    const double divergence = (moment(height + step) - moment(height - step)) / (2 * step * height);
    const double source = tracer.g_source_sr(chief), sensor = tracer.g_sensor_sr(chief);
    EXPECT_NEAR((source - divergence) / sensor, 1, 2e-4) << height;
    largest_gap = std::max(largest_gap, std::abs(source / sensor - 1));
  }
  EXPECT_GT(largest_gap, 1e-3) << "the two must differ, or this test shows nothing";
}

}  // namespace
}  // namespace petzval
