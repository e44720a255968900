// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/analysis/pupil_fit.h>
#include <petzval/analysis/pupil_rays.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>

#include <algorithm>
#include <cmath>

#include "analysis/stigmatic_lens.h"

namespace petzval {
namespace {

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
    const Psf psf = axial_psf(stigmatic_lens(semi), options);
    const double peak = psf.at(20, 20);
    for (int j = 20; j < 41; j += 2) {
      const double x = pi * 0.25 * (j - 20);
      const double airy = x == 0 ? 1 : std::pow(2 * std::cyl_bessel_j(1.0, x) / x, 2);
      // This lens does not meet the sine condition: rays at height h leave at tan U' ≈ h/40 (1 + …(h/40)²),
      // which tilts the amplitude over the pupil by a few times NA².
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
    for (const PupilNode& node : pupil_nodes(*tracer.object_pupil(chief), 32)) {
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
    PsfOptions window;
    window.size = plan.size;
    window.spacing_um = plan.spacing_um;
    const Psf chosen = *point_spread(tracer, chief, window);
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

/// Second moment of the PSF about its centroid, as a radius [µm].
double rms_radius_um(const Psf& psf) {
  double centroid = 0, moment = 0;
  for (int i = 0; i < psf.size; ++i)
    for (int j = 0; j < psf.size; ++j) centroid += psf.at(i, j) * (i - psf.size / 2) * psf.spacing_um;
  for (int i = 0; i < psf.size; ++i)
    for (int j = 0; j < psf.size; ++j)
      moment += psf.at(i, j) * (std::pow((i - psf.size / 2) * psf.spacing_um - centroid, 2) +
                                std::pow((j - psf.size / 2) * psf.spacing_um, 2));
  return std::sqrt(moment);
}

TEST(PointSpread, OfADefocusedLensIsTheDiscOfSimilarTriangles) {
  // All rays of a stigmatic lens cross in one point; a sensor δ behind it sees the exit pupil's shadow. Both
  // ways of summing: 60 and 730 λN wide.
  for (const double behind_mm : {3.0, 40.0}) {
    Lens lens = stigmatic_lens(2);
    lens.surfaces.back().thickness_mm += behind_mm;
    const Psf psf = axial_psf(lens);
    EXPECT_GE(psf.captured, 0.99);
    // The rim ray leaves parallel to the axis at 2 mm and crosses it 40 mm behind the vertex of the
    // hyperboloid, which bends it (2² / 40) / 2 mm before: a quarter of a per cent that does not show.
    const double radius_um = 2.0 / 40 * behind_mm * um_per_mm;
    // A uniform disc has an rms radius of R/√2; the light is uniform over the beam, not over the exit angles:
    // 2 NA². Wings up to 18 λN beyond add (2·1.2 R/π²)/(R²/2) in λN: 1 % of the moment at 60 λN.
    EXPECT_NEAR(rms_radius_um(psf) / (radius_um / std::sqrt(2.0)), 1, 0.012) << behind_mm;
    // Beyond 1.3 radii there are wings only: 2λN/(π² 0.3 R), 2.5 % for the small disc, of the light that was
    // summed.
    double inside = 0;
    for (int i = 0; i < psf.size; ++i)
      for (int j = 0; j < psf.size; ++j)
        if (std::hypot(i - psf.size / 2, j - psf.size / 2) * psf.spacing_um < 1.3 * radius_um)
          inside += psf.at(i, j);
    EXPECT_GT(inside, 0.98) << behind_mm;
  }
}

TEST(PointSpread, IsAsWideAsTheRaySpotWhenAberrationsAreLarge) {
  // Focused at infinity, object at 2 m: the fault that once cut a disc of 0.7 mm to its inner 5 %.
  Lens lens = read_lens("dgauss-50mm").lens;
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, stop_radius_mm(lens)};
  lens.object_distance_mm = 2000;
  FieldTracer tracer(lens, 550);
  for (const double object_mm : {0.0, -300.0, -600.0}) {
    const ChiefRay chief = *tracer.chief_ray(object_mm);
    const Psf psf = *point_spread(tracer, chief);
    EXPECT_LE(psf.size, PsfOptions{}.largest_size);
    EXPECT_GE(psf.captured, 0.99) << object_mm;
    // Rays of another quadrature, each weighing as its light.
    double weight = 0, mean = 0, square = 0;
    for (const PupilRay& ray : pupil_rays(tracer, chief)) {
      weight += ray.entrance_measure;
      mean += ray.entrance_measure * ray.y_mm;
      square += ray.entrance_measure * (ray.x_mm * ray.x_mm + ray.y_mm * ray.y_mm);
    }
    mean /= weight;
    const double rays_um = std::sqrt(square / weight - mean * mean) * um_per_mm;
    EXPECT_GT(rays_um, 150);
    EXPECT_NEAR(rms_radius_um(psf) / rays_um, 1, 0.006) << object_mm;  // wings: 0.4 % of a disc of 600 λN
  }
}

TEST(PointSpread, OfCoarseCellsIsTheFineOneSummed) {
  const Lens lens = read_lens("dgauss-50mm").lens;
  FieldTracer tracer(lens, 550);
  const ChiefRay chief = *tracer.chief_ray(14);  // vignetted, 80 µm wide
  PsfOptions coarse;
  coarse.size = 31;
  coarse.spacing_um = 3.0;
  const Psf cells = *point_spread(tracer, chief, coarse);
  // The full sum over traced nodes at 0.3 λN.
  const int side = 9;
  PsfOptions fine;
  fine.size = 31 * side;
  fine.spacing_um = 3.0 / side;
  const PsfPlan plan = *plan_psf(tracer, chief, fine);
  const Psf full = sum_plane_waves(*pupil_waves(tracer, chief, plan.radial_nodes, plan.azimuths), plan.size,
                                   plan.spacing_um);
  EXPECT_NEAR(cells.captured, full.captured, 1e-3);  // the nodes cut the vignetted pupil's corners
  double difference = 0, norm = 0;
  for (int i = 0; i < cells.size; ++i)
    for (int j = 0; j < cells.size; ++j) {
      double sum = 0;
      for (int k = 0; k < side; ++k)
        for (int l = 0; l < side; ++l) sum += full.at(i * side + k, j * side + l);
      difference += std::pow(sum - cells.at(i, j), 2);
      norm += sum * sum;
    }
  EXPECT_LT(std::sqrt(difference / norm), 3e-3);  // what samples at 0.6 λN leave
}

TEST(PointSpread, HoldsTheWantedShareOfTheLight) {
  for (const char* name : {"edmund-54852", "dgauss-50mm", "wide-22mm", "telephoto-250mm", "tessar"}) {
    const Lens lens = read_lens(name).lens;
    FieldTracer tracer(lens, lens.reference_wavelength_nm);
    double field = 0;
    for (const double value : lens.fields.values) field = std::max(field, value);
    for (const double at : {0.0, 0.7 * field}) {
      PsfOptions small;
      small.size = 64;
      EXPECT_GE(point_spread(tracer, *tracer.chief_ray(at))->captured, 0.99) << name << " " << at;
      EXPECT_GE(point_spread(tracer, *tracer.chief_ray(at), small)->captured, 0.99) << name << " " << at;
      small.wanted_share = 0.997;
      EXPECT_GE(point_spread(tracer, *tracer.chief_ray(at), small)->captured, 0.997) << name << " " << at;
    }
  }
}

/// Light of the cells about the middle, by their place, in two windows of the same cells.
double worst_over_peak_where_both_are(const Psf& small, const Psf& large) {
  double worst = 0, peak = 0;
  const int shift = large.size / 2 - small.size / 2;
  for (int i = 0; i < small.size; ++i)
    for (int j = 0; j < small.size; ++j) {
      const double one = small.at(i, j) * small.captured,
                   other = large.at(i + shift, j + shift) * large.captured;
      worst = std::max(worst, std::abs(one - other));
      peak = std::max(peak, other);
    }
  return worst / peak;
}

TEST(PointSpread, OfAVignettedPupilDoesNotDependOnItsWindow) {
  // More samples take more chords and nodes. Too few of them fold light from outside into the window: 1e-3 of
  // the peak where only the pupil's height counts and not the rim that ends the chords.
  const Lens lens = read_lens("dgauss-50mm").lens;
  FieldTracer tracer(lens, 650);
  for (const double field : {10.0, 20.0}) {
    const SmoothPupil pupil = *fit_pupil(tracer, *tracer.chief_ray(field));
    ASSERT_FALSE(pupil.corners.empty());
    PsfOptions options;
    options.size = 64;
    const Psf own = point_spread(pupil, options);
    const auto at = [&](int size) { return sum_chords(pupil, {size, own.spacing_um, 7}); };
    EXPECT_LT(worst_over_peak_where_both_are(at(64), at(112)), 5e-6) << field << ": single precision";
  }
}

Losses bare_glass() {
  Losses losses;
  losses.fresnel = true;
  return losses;
}

/// Of all light, what falls into the square of this half-width about the middle.
double light_within(const Psf& psf, double half_width_um) {
  const auto share = [&](int cell) {
    return std::clamp(half_width_um / psf.spacing_um + 0.5 - std::abs(cell - psf.size / 2), 0.0, 1.0);
  };
  double sum = 0;
  for (int i = 0; i < psf.size; ++i)
    for (int j = 0; j < psf.size; ++j) sum += share(i) * share(j) * static_cast<double>(psf.at(i, j));
  return psf.captured * sum;
}

// Near the end of its image this lens lets slivers of light through, which spread it far: 9 % and more
// beyond 16 µm, where rays would put none. A window that is kept narrow shows the same as a wide one.
TEST(PointSpread, OfASliverIsOfWavesInNarrowWindowsToo) {
  FieldTracer tracer(read_lens("inverse-telephoto").lens, 600);
  PsfOptions narrow;
  narrow.widest_node_window_lambda_n = 64;
  for (double field_deg = 38; field_deg < 43; field_deg += 0.5) {
    const ChiefRay chief = *tracer.chief_ray(field_deg);
    const Psf kept = *point_spread(tracer, chief, narrow), wide = *point_spread(tracer, chief);
    EXPECT_NEAR(light_within(kept, 16), light_within(wide, 16), 0.01) << field_deg;
  }
}

TEST(PointSpread, OfCoatedSurfacesHasTheSameShape) {
  // A reflectance that is the same for all rays dims the pupil and leaves its form.
  const Lens lens = read_lens("cooke-triplet").lens;
  FieldTracer clear(lens, 550), coated(lens, 550);
  Losses losses;
  losses.air_glass = Coating::constant(0.02);
  coated.set_losses(losses);
  const ChiefRay chief = *clear.chief_ray(12);
  const SmoothPupil bright = *fit_pupil(clear, chief), dim = *fit_pupil(coated, chief);
  EXPECT_NEAR(dim.flux / bright.flux, std::pow(0.98, 6), 1e-12) << "three lenses, six surfaces";
  const Psf one = point_spread(bright), other = point_spread(dim);
  ASSERT_EQ(one.size, other.size);
  EXPECT_LT(worst_over_peak_where_both_are(one, other), 1e-6);
  EXPECT_NEAR(one.captured, other.captured, 1e-6);
}

TEST(PointSpread, CountsLossesTheSameByChordsAndByNodes) {
  // Bare glass reflects more towards the rim, more so at the image's end of a fast lens.
  const Lens lens = read_lens("edmund-54852").lens;
  FieldTracer clear(lens, 550), lossy(lens, 550);
  lossy.set_losses(bare_glass());
  const ChiefRay chief = *clear.chief_ray(-100);
  const SmoothPupil fitted = *fit_pupil(lossy, chief);
  const PupilWaves nodes = *pupil_waves(lossy, chief, 32, 128);
  EXPECT_NEAR(fitted.flux / nodes.flux, 1, 2e-4) << "128 azimuths cut corners";
  EXPECT_NEAR(fitted.flux / lossy.object_flux(chief), 1, 1e-4);
  EXPECT_LT(fitted.flux / fit_pupil(clear, chief)->flux, 0.7) << "ten bare surfaces";
  const Psf chords = sum_chords(fitted, {48, 0.5, 1}), waves = sum_plane_waves(nodes, 48, 0.5);
  EXPECT_LT(worst_over_peak_where_both_are(chords, waves), 1e-3);
}

TEST(PupilFit, MeetsTheTracedPupil) {
  // Vignetted by two or three apertures: corners.
  for (const auto& [name, field] :
       {std::pair{"dgauss-50mm", 20.0}, {"wide-22mm", 30.0}, {"fisheye-10mm", 70.0}}) {
    const Lens lens = read_lens(name).lens;
    FieldTracer tracer(lens, lens.reference_wavelength_nm);
    const ChiefRay chief = *tracer.chief_ray(field);
    const std::optional<SmoothPupil> pupil = fit_pupil(tracer, chief);
    ASSERT_TRUE(pupil) << name;
    EXPECT_FALSE(pupil->corners.empty()) << name;
    EXPECT_LT(pupil->phase_waves.max_residual(), 2e-3) << name;
    // The boundary's area, du dv, is the same flux; 2048 azimuths cut its corners by (2π/2048)².
    EXPECT_NEAR(pupil->flux / tracer.object_pupil(chief, 2048)->area(), 1, 3e-5) << name;
  }
}

}  // namespace
}  // namespace petzval
