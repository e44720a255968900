// SPDX-License-Identifier: BSD-3-Clause
// Chief rays against brute force: of a grid of rays over all of the front, traced by the independent tracer,
// the one that passes nearest to the centre of the stop, closed in on by ever finer grids.
#include <gtest/gtest.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/base/units.h>
#include <petzval/lens/formats/seq.h>
#include <petzval/lens/formats/zmx.h>
#include <petzval/lens/lens_file.h>

#include <cmath>

#include "physics/independent_tracer.h"
#include "physics/wide_angle_lenses.h"

namespace petzval {
namespace {

using independent::IndependentRay;
using independent::Real;
using independent::SphereTracer;

constexpr double lambda_nm = 587.5618;

struct AimedLens {
  Lens lens;
  std::vector<double> fields_deg;
};
void PrintTo(const AimedLens& aimed, std::ostream* out) {
  *out << aimed.lens.name;
}

/// A box of places on the plane through vertex 1 across the beam.
struct Box {
  Real x, y, half;
};

class BruteForce {
 public:
  explicit BruteForce(const Lens& lens)
      : whole_(lens, lambda_nm, stop_radius_mm(lens)), to_stop_(front_of(lens), lambda_nm, 1e9L) {
    const Surface& first = lens.surfaces.front();
    first_grid_ = lens.surfaces.front().asphere.empty() ? 241 : 61;  // aspheres take long, and no wide field
    reach_ = 1.2L * (first.semi_diameter_mm ? Real(*first.semi_diameter_mm) : Real(stop_radius_mm(lens)));
  }

  /// Height on the image of the ray through the stop's centre, of those that every aperture passes.
  std::optional<Real> chief_height(double field_deg) const {
    const int first_grid = first_grid_;
    constexpr int closer_grid = 7;
    std::optional<Box> best = nearest({0, 0, reach_}, first_grid, field_deg, true);
    for (Real half = 3 * reach_ / first_grid; best && half > 1e-16L; half /= 2.5L)
      best = nearest({best->x, best->y, half}, closer_grid, field_deg, false);
    if (!best) return {};
    return whole_.trace(launch(best->x, best->y, field_deg), false, false)->point[1] + Real(0);
  }

 private:
  static Lens front_of(Lens lens) {
    lens.surfaces.resize(lens.stop_index() + 1);
    return lens;
  }
  static IndependentRay launch(Real x, Real y, double field_deg) {
    const Real sine = std::sin(Real(radians(field_deg))), cosine = std::cos(Real(radians(field_deg)));
    return {{x, y * cosine, -y * sine}, {0, sine, cosine}, 0};
  }
  std::optional<Box> nearest(const Box& box, int side, double field_deg, bool clip) const {
    std::optional<Box> best;
    Real least = 1e30L;
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) {
        const Real x = box.x + box.half * (2 * i - side + 1) / Real(side - 1),
                   y = box.y + box.half * (2 * j - side + 1) / Real(side - 1);
        const auto at = to_stop_.trace(launch(x, y, field_deg), false, clip);
        if (!at) continue;
        const Real distance = std::hypot(at->point[0], at->point[1]);
        if (!(distance < least) || (clip && !whole_.trace(launch(x, y, field_deg), false))) continue;
        least = distance;
        best = Box{x, y, 0};
      }
    return best;
  }

  SphereTracer whole_, to_stop_;
  Real reach_;
  int first_grid_;  ///< finer than the smallest pupil
};

/// The independent tracer leaves rays at the last surface.
Lens with_image_surface(Lens lens) {
  Surface image;
  image.thickness_mm = 0;
  lens.surfaces.push_back(image);
  return lens;
}

class Aiming : public testing::TestWithParam<AimedLens> {};

TEST_P(Aiming, FindsTheChiefRayThatBruteForceFinds) {
  const Lens& lens = GetParam().lens;
  const BruteForce second(with_image_surface(lens));
  FieldTracer tracer(lens, lambda_nm);
  for (const double field : GetParam().fields_deg) {
    const std::optional<ChiefRay> chief = tracer.chief_ray(field);
    const std::optional<Real> height = second.chief_height(field);
    ASSERT_TRUE(chief && height) << field;
    // Asked for is 1e-7 mm; aiming leaves 1e-13 of the stop's radius, the grids as much.
    EXPECT_NEAR(chief->image_height_mm, double(*height), 1e-9) << field;
  }
}

INSTANTIATE_TEST_SUITE_P(Lenses, Aiming,
                         testing::Values(AimedLens{sample::wide_100_degrees(), {10, 30, 45, 50}},
                                         AimedLens{sample::fisheye_170_degrees(), {20, 50, 70, 80, 85}},
                                         AimedLens{sample::phone_lens(), {10, 20, 33}},
                                         AimedLens{read_lens("fisheye-10mm").lens, {30, 60}},
                                         AimedLens{read_lens("wide-22mm").lens, {20, 36}},
                                         AimedLens{read_lens("tessar").lens, {5, 14}},
                                         AimedLens{read_lens("telephoto-250mm").lens, {2, 5}}));

TEST(OddAspheres, TraceAsTheIndependentTracerDoes) {
  const Lens lens = sample::phone_lens();
  const Tracer tracer(lens, lambda_nm);
  const SphereTracer second(with_image_surface(lens), lambda_nm, 1e9L);
  int arrived = 0;
  for (int i = -6; i <= 0; ++i)
    for (int j = -6; j <= 6; ++j) {
      const double angle = radians(2.5 * j), x = 0.15 * i, y = 0.12 * j;
      const Ray ray =
          tracer.trace(Ray{{x, y, -1}, {0, std::sin(angle), std::cos(angle)}}, Tracer::Clip::none);
      const auto other =
          second.trace({{x, y, -1}, {0, std::sin(Real(angle)), std::cos(Real(angle))}, 0}, false, false);
      if (ray.status != RayStatus::ok || !other) continue;
      ++arrived;
      for (std::size_t a = 0; a < 3; ++a) {
        EXPECT_NEAR(ray.point_mm[a], double(other->point[a]), 1e-11);
        EXPECT_NEAR(ray.direction[a], double(other->direction[a]), 1e-11);
      }
      EXPECT_NEAR(ray.opl_mm, double(other->path), 1e-11);
    }
  EXPECT_GT(arrived, 60);
}

TEST(OddAspheres, SurviveTheFilesOfOtherPrograms) {
  Lens lens = sample::phone_lens();
  FieldTracer before(lens, lambda_nm);
  lens.aperture = {Aperture::Kind::entrance_pupil_diameter_mm, 1.6};  // CODE V keeps no stop
  const Lens seq = read_seq(seq_text(lens), "a.seq", {}).lens,
             zmx = read_zmx(zmx_text(lens), "a.zmx", {}).lens;
  for (const Lens& again : {seq, zmx}) {
    FieldTracer after(again, lambda_nm);
    for (const double field : {10.0, 35.0})
      EXPECT_NEAR(after.chief_ray(field)->image_height_mm, before.chief_ray(field)->image_height_mm, 1e-12);
  }
}

}  // namespace
}  // namespace petzval
