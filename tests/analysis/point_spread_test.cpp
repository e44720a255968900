// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>

#include <cmath>

namespace petzval {
namespace {

/// A plano-hyperbolic lens: free of aberration on the axis (k = −n²), f = 40 mm, stop on its flat front.
Lens perfect_lens(double semi_aperture_mm) {
  Lens lens;
  lens.name = "plano-hyperbolic lens";
  Surface front, back;
  front.thickness_mm = 2;
  front.material = Material(Material::Constant{1.5});
  front.stop = true;
  back.curvature_per_mm = -1.0 / 20;
  back.conic = -2.25;
  back.thickness_mm = 40;
  lens.surfaces = {front, back};
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, semi_aperture_mm};
  lens.wavelengths_nm = {550};
  lens.reference_wavelength_nm = 550;
  return lens;
}

Psf axial_psf(const Lens& lens, const PsfOptions& options = {}) {
  FieldTracer tracer(lens, 550);
  return *point_spread(tracer, *tracer.chief_ray(0), options);
}

TEST(PointSpread, OfAnAberrationFreeLensIsTheAiryDisc) {
  for (const double semi : {0.5, 1.0, 2.0}) {
    const double lambda_n_um = 0.55 * 40 / (2 * semi);
    PsfOptions options;
    options.size = 41;
    options.spacing_um = 0.25 * lambda_n_um;
    const Psf psf = axial_psf(perfect_lens(semi), options);
    const double peak = psf.at(20, 20);
    for (int j = 20; j < 41; j += 2) {
      const double x = pi * 0.25 * (j - 20);
      const double airy = x == 0 ? 1 : std::pow(2 * std::cyl_bessel_j(1.0, x) / x, 2);
      // This lens does not meet the sine condition: rays at height h leave at tan U' ≈ h/40 (1 + …(h/40)²), which
      // tilts the amplitude over the pupil by a few times NA².
      EXPECT_NEAR(psf.at(20, j) / peak, airy, 2 * std::pow(semi / 40, 2)) << semi << " " << j;
      EXPECT_NEAR(psf.at(j, 20) / peak, psf.at(20, j) / peak, 1e-4) << "round";
    }
  }
}

TEST(PointSpread, CentroidIsThatOfTheRays) {
  // Ehrenfest's theorem: the centroid of |U|² is the mean transverse ray position, whatever diffraction does.
  // It settles the sign of the phase: with the wrong one the coma tail, and this centroid, change sides.
  const Lens lens = read_lens("edmund-54852").lens;
  FieldTracer tracer(lens, 587.5618);
  for (const double height : {1.4, -1.4, 2.75}) {
    const ChiefRay chief = *tracer.chief_ray(*tracer.object_field_at_image_height(height));
    const Pencil pencil = Pencil::from_object(lens, chief.object_field);
    double rays = 0, weight = 0;
    for (const PupilNode& node : half_pupil_nodes(*tracer.object_pupil(chief), 32)) {
      const Ray ray = tracer.tracer().trace(*pencil.ray(node.u, node.v), Tracer::Clip::none);
      rays += node.weight * (ray.point_mm[1] - chief.image_height_mm) * (height > 0 ? 1 : -1) * um_per_mm;
      weight += node.weight;
    }
    rays /= weight;
    PsfOptions options;
    options.size = 300;
    const Psf psf = *point_spread(tracer, chief, options);
    double centroid = 0;
    for (int i = 0; i < psf.size; ++i)
      for (int j = 0; j < psf.size; ++j) centroid += psf.at(i, j) * (i - psf.size / 2) * psf.spacing_um;
    // The window cuts wings of relative weight 0.5 %, unevenly by a few per cent of that at 70 µm.
    EXPECT_NEAR(centroid, rays, 0.03) << height;
    EXPECT_GT(std::abs(rays), 0.2) << "or the sign is not tested";
  }
}

TEST(PointSpread, ChosenQuadratureHasConverged) {
  const Lens lens = read_lens("edmund-54852").lens;
  FieldTracer tracer(lens, 587.5618);
  for (const double height : {0.0, 2.4}) {
    const ChiefRay chief = *tracer.chief_ray(*tracer.object_field_at_image_height(height));
    const PsfPlan plan = *plan_psf(tracer, chief);
    const Psf chosen = *point_spread(tracer, chief);
    const Psf finer = sum_plane_waves(*pupil_waves(tracer, chief, plan.radial_nodes * 2, plan.azimuths * 2),
                                      plan.size, plan.spacing_um);
    float peak = 0, worst = 0;
    for (std::size_t i = 0; i < finer.values.size(); ++i) {
      peak = std::max(peak, finer.values[i]);
      worst = std::max(worst, std::abs(chosen.values[i] - finer.values[i]));
    }
    EXPECT_LT(worst / peak, 2e-4) << height;  // the corners of the vignetted pupil; 1e-6 on axis
    EXPECT_GT(chosen.captured, 0.97);
    EXPECT_LE(chosen.captured, 1 + 1e-4);
  }
}

TEST(PointSpread, SamplesAtOrBelowHalfLambdaN) {
  const Lens lens = read_lens("dgauss-50mm").lens;
  FieldTracer tracer(lens, 550);
  const ChiefRay chief = *tracer.chief_ray(0);
  const double sine = std::sqrt(tracer.g_sensor_sr(chief) / pi);
  EXPECT_LE(plan_psf(tracer, chief)->spacing_um, 0.5 * 0.55 / (2 * sine));
}

}  // namespace
}  // namespace petzval
