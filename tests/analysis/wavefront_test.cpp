// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/wavefront.h>
#include <petzval/base/units.h>

#include <cmath>

#include "golden_lenses.h"

namespace petzval {
namespace {

class GoldenWavefronts : public GoldenLensTest {};

TEST_P(GoldenWavefronts, AgreeWithAnotherTracer) {
  for_each_row([](const FieldTracer& tracer, const ChiefRay& chief, const nlohmann::json& row) {
    const WavefrontRow ours = *wavefront(tracer, chief);
    const double tolerance = 1e-5;  // waves; 1e-3 is what is promised
    EXPECT_NEAR(ours.rms_waves, row["rms_wfe_waves_piston_removed"], tolerance);
    EXPECT_NEAR(ours.rms_without_tilt_waves, row["rms_wfe_waves_piston_tilt_removed"], tolerance);
    EXPECT_NEAR(ours.reference_sphere_radius_mm, row["ref_sphere_radius_mm"], 1e-7);
    // Its quadrature of the oscillating integral is coarser than ours (see the next test).
    EXPECT_NEAR(ours.strehl, row["strehl_from_pupil_integral_at_chief_pt"], 1e-3);
    // The other program looked at nodes inside the pupil only, ours goes to the rim.
    EXPECT_GT(ours.pv_waves, row["pv_wfe_waves_sampled"].get<double>() - tolerance);
    EXPECT_LT(ours.pv_waves, row["pv_wfe_waves_sampled"].get<double>() * 1.05);
  });
}

TEST_P(GoldenWavefronts, HaveConverged) {
  for_each_row([](const FieldTracer& tracer, const ChiefRay& chief, const nlohmann::json&) {
    const WavefrontRow coarse = *wavefront(tracer, chief), fine = *wavefront(tracer, chief, {44, 300});
    EXPECT_NEAR(coarse.rms_waves, fine.rms_waves, 1e-7);
    EXPECT_NEAR(coarse.strehl, fine.strehl, 1e-5);
  });
}

INSTANTIATE_TEST_SUITE_P(Lenses, GoldenWavefronts, golden_lenses());

/// A plano-hyperbolic lens of f/20, perfect on the axis, with its image surface moved.
Lens perfect_lens(double defocus_mm) {
  Lens lens;
  Surface front, back;
  front.thickness_mm = 2;
  front.material = Material(Material::Constant{1.5});
  front.stop = true;
  back.curvature_per_mm = -1.0 / 20;
  back.conic = -2.25;
  back.thickness_mm = 40 + defocus_mm;
  lens.surfaces = {front, back};
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 1};
  lens.wavelengths_nm = {550};
  lens.reference_wavelength_nm = 550;
  return lens;
}

WavefrontRow defocused(double defocus_mm) {
  const Lens lens = perfect_lens(defocus_mm);
  return wavefront_table(lens, FieldTableRequest::of(lens)).front();
}

TEST(Wavefront, OfPureDefocusIsAParabola) {
  // W020 = δz sin²U'/(2λ), less by the share δz/R that the finite sphere stands nearer to the focus; an RMS
  // of W020/√12, and a Strehl ratio of sinc² W020. The cone of f/20 is not quite paraxial: a few times NA² =
  // 6e-4.
  for (const double defocus_mm : {0.2, -0.2, 0.8}) {
    const WavefrontRow row = defocused(defocus_mm);
    const double sine = std::sin(std::atan(1 / 40.0)), tolerance = 3e-3;
    const double w020 =
        std::abs(defocus_mm) * sine * sine / (2 * 550e-6) * (1 - defocus_mm / row.reference_sphere_radius_mm);
    EXPECT_NEAR(row.pv_waves, w020, tolerance * w020);
    EXPECT_NEAR(row.rms_waves, w020 / std::sqrt(12.0), tolerance * w020);
    EXPECT_NEAR(row.strehl, std::pow(std::sin(pi * w020) / (pi * w020), 2), tolerance);
  }
}

TEST(Wavefront, OfAPerfectLensIsFlat) {
  const WavefrontRow row = defocused(0);
  EXPECT_LT(row.pv_waves, 1e-7);  // rounding: 1e-14 mm of path in 5e-4 mm of wave, a few times
  EXPECT_NEAR(row.strehl, 1, 1e-12);
}

TEST(Wavefront, SignSaysWhetherItRunsAhead) {
  // All rays reach the focus with the same path. A sensor δ behind it: the chief ray goes on by δ, a ray at
  // angle U by δ cos U to the foot of the perpendicular, so W = +δ (1 − cos U)/λ at the rim.
  for (const double defocus_mm : {0.2, -0.2}) {
    const Lens lens = perfect_lens(defocus_mm);
    FieldTracer tracer(lens, 550);
    const ChiefRay chief = *tracer.chief_ray(0);
    const std::vector<PupilRay> rays = pupil_rays(tracer, chief);
    const double cosine = std::sqrt(1 - std::pow(rays.back().alpha, 2) - std::pow(rays.back().beta, 2));
    const double expected = defocus_mm * (1 - cosine) / 550e-6;
    // The finite sphere differs by δ² sin²U/2R.
    EXPECT_NEAR(opd_waves(tracer, chief, rays).back(), expected, 0.02 * std::abs(expected));
  }
}

TEST(Wavefront, SmallAberrationsFollowMarechal) {
  // Strehl = exp(−(2πσ)²) up to the third and fourth moments: (2πσ)³ at most for so small a σ.
  const WavefrontRow row = defocused(0.15);
  const double sigma = 2 * pi * row.rms_waves;
  EXPECT_LT(sigma, 0.2);
  EXPECT_NEAR(row.strehl, std::exp(-sigma * sigma), std::pow(sigma, 3));
}

TEST(Wavefront, GradientIsTheTransverseRay) {
  // ∂(n'L)/∂β at the image: two neighbouring rays differ in path to the foot of the perpendicular by −y dβ.
  Lens lens = read_lens("double-gauss").lens;
  FieldTracer tracer(lens, 587.5618, Tracer::Clip::stop_only);
  const ChiefRay chief = *tracer.chief_ray(10);
  const Pencil pencil = Pencil::from_object(lens, 10);
  const auto foot = [&](const Ray& ray) {
    return ray.opl_mm - (ray.point_mm[1] - chief.image_height_mm) * ray.direction[1];
  };
  for (const double share : {-0.8, -0.3, 0.2, 0.7}) {
    const double v = chief.v + 10 * share, step = 1e-3;
    const auto ray = [&](double at) { return tracer.tracer().trace(*pencil.ray(0, at), Tracer::Clip::none); };
    const double slope = (foot(ray(v + step)) - foot(ray(v - step))) /
                         (ray(v + step).direction[1] - ray(v - step).direction[1]);
    EXPECT_NEAR(slope, -(ray(v).point_mm[1] - chief.image_height_mm), 1e-6);  // mm, of some 0.05
  }
}

}  // namespace
}  // namespace petzval
