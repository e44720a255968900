// SPDX-License-Identifier: BSD-3-Clause
// Aiming at half fields up to 85 degrees, against the independent tracer.
#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>
#include <petzval/trace/passing_region.h>
#include <petzval/trace/pencil.h>
#include <petzval/trace/pupil.h>

#include <cmath>

#include "physics/independent_tracer.h"
#include "physics/wide_angle_lenses.h"

namespace petzval {
namespace {

using independent::IndependentRay;
using independent::Real;
using independent::SphereTracer;

constexpr double light_nm = 587.5618;

struct WideLens {
  Lens lens;
  double half_field_deg;
};
void PrintTo(const WideLens& wide, std::ostream* out) {
  *out << wide.lens.name;
}

IndependentRay independent_ray(const Pencil& pencil, double u, double v) {
  const Ray ray = *pencil.ray(u, v);
  IndependentRay other{};
  for (std::size_t a = 0; a < 3; ++a) other.point[a] = ray.point_mm[a], other.direction[a] = ray.direction[a];
  return other;
}

class WideAngle : public testing::TestWithParam<WideLens> {
 protected:
  const Lens& lens() const { return GetParam().lens; }
  std::vector<double> fields() const {
    std::vector<double> all;
    for (int i = 0; i <= 12; ++i) all.push_back(GetParam().half_field_deg * i / 12);
    return all;
  }
};

TEST_P(WideAngle, ChiefRaysPassTheCentreOfTheStop) {
  Lens front = lens();
  front.surfaces.resize(front.stop_index() + 1);
  const SphereTracer to_stop(front, light_nm, 1e9L);
  const Tracer tracer(lens(), light_nm);
  ChiefRayMarch march(lens(), tracer), other_way(lens(), tracer);
  std::vector<double> outwards;
  for (const double field : fields()) {
    const auto v = march.v_at(field);
    ASSERT_TRUE(v) << field;
    outwards.push_back(*v);
    const auto at = to_stop.trace(independent_ray(Pencil::from_object(lens(), field), 0, *v), false, false);
    ASSERT_TRUE(at) << field;
    EXPECT_LT(std::abs(double(at->point[1])), 1e-9 * tracer.stop_radius_mm()) << field;
  }
  // The order in which fields are asked does not matter, nor does the sign of the field.
  for (std::size_t i = fields().size(); i-- > 0;) {
    EXPECT_NEAR(*other_way.v_at(fields()[i]), outwards[i], 1e-9) << fields()[i];
    EXPECT_NEAR(*other_way.v_at(-fields()[i]), -outwards[i], 1e-9) << fields()[i];
  }
}

TEST_P(WideAngle, TheBoundaryIsWhereRaysBeginToBeLost) {
  const Tracer tracer(lens(), light_nm);
  const SphereTracer second(lens(), light_nm, tracer.stop_radius_mm());
  ChiefRayMarch march(lens(), tracer);
  for (const double field : fields()) {
    const Pencil pencil = Pencil::from_object(lens(), field);
    const auto pupil = find_pupil(tracer, pencil, *march.v_at(field), 64);
    ASSERT_TRUE(pupil) << field;
    for (std::size_t i = 0; i < pupil->radius.size(); ++i) {
      const double azimuth = pupil->azimuth(i);
      const auto passes = [&](double radius) {
        return second
            .trace(independent_ray(pencil, radius * std::sin(azimuth),
                                   pupil->centre_v + radius * std::cos(azimuth)),
                   false)
            .has_value();
      };
      EXPECT_TRUE(passes(pupil->radius[i] * (1 - 1e-9))) << field << " at " << azimuth;
      EXPECT_FALSE(passes(pupil->radius[i] * (1 + 3e-9))) << field << " at " << azimuth;
    }
    const auto region = find_passing_region(tracer, pencil);
    ASSERT_TRUE(region);
    EXPECT_EQ(region->parts(), 1);
    // The grid's cells on the rim, about 500 of 20,000, are in or out by chance.
    EXPECT_NEAR(region->area / pupil->area(), 1, 1e-2) << field;
  }
}

TEST_P(WideAngle, ThePupilIsTheSameFromTheImage) {
  // The pupil grown around the backward chief ray of the same image point: its chief ray is the forward one.
  const Tracer tracer(lens(), light_nm);
  ChiefRayMarch march(lens(), tracer), from_image(lens(), tracer, ChiefRayMarch::From::image);
  for (const double field : fields()) {
    const Pencil pencil = Pencil::from_object(lens(), field);
    const Ray chief = tracer.trace(*pencil.ray(0, *march.v_at(field)), Tracer::Clip::none);
    ASSERT_EQ(chief.status, RayStatus::ok);
    const auto v = from_image.v_at(chief.point_mm[1]);
    ASSERT_TRUE(v) << field;
    EXPECT_NEAR(*v, chief.direction[1], 1e-10) << field;
  }
}

INSTANTIATE_TEST_SUITE_P(Lenses, WideAngle,
                         testing::Values(WideLens{sample::wide_100_degrees(), 50},
                                         WideLens{sample::fisheye_170_degrees(), 85}));

TEST(Slivers, AreAsLargeAsACountOfRays) {
  // The last light of the fisheye, at 75° and 76°, comes through slivers four and eight times as wide as
  // high.
  const Lens lens = read_lens("fisheye-10mm").lens;
  const Tracer tracer(lens, light_nm);
  const SphereTracer second(lens, light_nm, tracer.stop_radius_mm());
  ChiefRayMarch march(lens, tracer);
  for (const double field : {75.0, 76.0}) {
    const Ray chief =
        tracer.trace(*Pencil::from_object(lens, field).ray(0, *march.v_at(field)), Tracer::Clip::none);
    const Pencil pencil = Pencil::from_image(tracer, chief.point_mm[1]);
    const double area = find_pupil(tracer, pencil, chief.direction[1], 256)->area();
    // Twice the box that holds the rim; midpoints of 500 × 1000 cells, a quarter of which are lit.
    double wide = 0, low = 1, high = -1;
    const auto rim = *find_pupil(tracer, pencil, chief.direction[1], 256);
    for (std::size_t i = 0; i < rim.radius.size(); ++i) {
      const double v = rim.centre_v + rim.radius[i] * std::cos(rim.azimuth(i));
      wide = std::max(wide, 1.4 * rim.radius[i] * std::sin(rim.azimuth(i)));
      low = std::min(low, v);
      high = std::max(high, v);
    }
    const double margin = 0.2 * (high - low);
    low -= margin;
    high += margin;
    const int columns = 500, rows = 1000;
    int lit = 0;
    for (int i = 0; i < columns; ++i)
      for (int j = 0; j < rows; ++j)
        lit += second
                   .trace(independent_ray(pencil, wide * (i + 0.5) / columns,
                                          low + (high - low) * (j + 0.5) / rows),
                          true)
                   .has_value();
    const double counted = 2 * wide * (high - low) * lit / (double(columns) * rows);
    // Some 2000 of 250,000 cells lie on the rim, in or out by chance: 45 cells.
    EXPECT_NEAR(counted / area, 1, 4e-4) << field;
  }
}

TEST(WideAngleEnd, NoChiefRayBeyondTheLastThatPasses) {
  // Beyond some field the chief ray of these lenses misses the front or is totally reflected; no other root
  // may be taken for it.
  for (const Lens& lens : {sample::wide_100_degrees(), sample::fisheye_170_degrees()}) {
    const Tracer tracer(lens, light_nm);
    ChiefRayMarch march(lens, tracer);
    double last_v = 0, last_field = 0;
    for (double field = 0; field < 175; field += 0.5) {
      const auto v = march.v_at(field);
      if (!v) break;
      // The chief ray's foot moves continuously: by less than 1.5 mm in half a degree.
      EXPECT_LT(std::abs(*v - last_v), 1.5) << lens.name << " " << field;
      last_v = *v;
      last_field = field;
    }
    EXPECT_GT(last_field, 50);
    EXPECT_LT(last_field, 130);
    for (double field = last_field + 1; field < 179; field += 7)
      EXPECT_FALSE(march.v_at(field)) << lens.name << " " << field;
  }
}

}  // namespace
}  // namespace petzval
