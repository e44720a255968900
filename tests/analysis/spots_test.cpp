// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/spots.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>

#include <cmath>

#include "golden_lenses.h"

namespace petzval {
namespace {

class GoldenSpots : public GoldenLensTest {};

TEST_P(GoldenSpots, AgreeWithAnotherTracer) {
  for_each_row([](const FieldTracer& tracer, const ChiefRay& chief, const nlohmann::json& row) {
    const SpotRow by_stop = *spot(tracer, chief), by_light = *spot(tracer, chief, RayWeight::light);
    const double tolerance = 1e-5;  // both integrate smoothly over a full stop; 1e-3 is what is promised
    const auto expect = [&](double ours, const char* key) {
      EXPECT_NEAR(ours, row[key].get<double>(), tolerance * row[key].get<double>()) << key;
    };
    expect(by_stop.rms_radius_um, "rms_spot_centroid_um");
    expect(by_stop.rms_x_um, "rms_x_um");
    expect(by_stop.rms_y_um, "rms_y_um");
    expect(by_light.rms_radius_um, "rms_spot_centroid_um_powerweighted");
    expect(std::hypot(by_stop.rms_radius_um, by_stop.centroid_um), "rms_spot_chief_um");
    EXPECT_NEAR(chief.image_height_mm + by_stop.centroid_um / um_per_mm, row["spot_centroid_y"], 1e-6);
  });
}

TEST_P(GoldenSpots, MeasureTheSameStopBeamAndCone) {
  for_each_row([](const FieldTracer& tracer, const ChiefRay& chief, const nlohmann::json& row) {
    const std::vector<PupilRay> rays = pupil_rays(tracer, chief);
    double stop = 0, beam = 0;
    for (const PupilRay& ray : rays) {
      stop += ray.stop_area_mm2;
      beam += ray.entrance_measure;
    }
    const double radius = tracer.tracer().stop_radius_mm();
    // The Jacobian errs by the square of its nudge, 1e-8. The reference has areas of inscribed polygons of
    // 360 corners, which are too small by (2π/360)²/6 = 5.1e-5.
    EXPECT_NEAR(stop / (pi * radius * radius), 1, 1e-6);
    const double polygon = 1 + std::pow(2 * pi / 360, 2) / 6;
    EXPECT_NEAR(beam / row["entrance_beam_area_mm2"].get<double>(), polygon, 1e-6);
    EXPECT_NEAR(exit_solid_angle_sr(tracer, rays) / row["projected_solid_angle_image_sr"].get<double>(),
                polygon, 1e-6);
    const double f_number = row["working_fno_from_solid_angle"];
    const double lambda_um = tracer.tracer().wavelength_nm() * 1e-3;
    EXPECT_NEAR(spot(tracer, chief)->airy_radius_um / (1.2197 * lambda_um * f_number), 1, 1e-4);
  });
}

INSTANTIATE_TEST_SUITE_P(Lenses, GoldenSpots, golden_lenses());

/// A plano-hyperbolic lens, perfect on the axis, with its image surface moved out of focus.
Lens defocused_lens(double defocus_mm) {
  Lens lens;
  lens.name = "defocused plano-hyperbolic lens";
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

TEST(Spots, OfPureDefocusAreUniformDiscs) {
  // A disc of radius a has RMS radius a/√2; a ray at height h leaves at slope h/40 to first order, which
  // errs by a share of (1/40)².
  const SpotRow row = spot_table(defocused_lens(0.4), FieldTableRequest::of(defocused_lens(0.4))).front();
  EXPECT_NEAR(row.max_radius_um, 10, 10 * 3.0 / 1600);
  EXPECT_NEAR(row.rms_radius_um, row.max_radius_um / std::sqrt(2.0), 10 * 3.0 / 1600);
  EXPECT_NEAR(row.centroid_um, 0, 1e-9);
  EXPECT_LT(spot_table(defocused_lens(0), FieldTableRequest::of(defocused_lens(0))).front().max_radius_um,
            1e-6);
}

TEST(Spots, OfAVignettedPupilAreThoseOfTheRaysThatPass) {
  // Counted: every ray of a fine grid over the entrance beam, those that pass weighing alike.
  const Lens lens = read_lens("edmund-54852").lens;
  FieldTracer tracer(lens, 587.5618);
  const ChiefRay chief = *tracer.chief_ray(*tracer.object_field_at_image_height(2.37));
  const Pencil pencil = Pencil::from_object(lens, chief.object_field);
  const std::optional<PupilBoundary> pupil = tracer.object_pupil(chief);
  const double reach = 2.1 * std::sqrt(pupil->area() / pi);
  double count = 0, sum = 0, sum_sq = 0;
  const int n = 400;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double u = reach * (2 * (i + 0.5) / n - 1), v = pupil->centre_v + reach * (2 * (j + 0.5) / n - 1);
      const Tracer::Clearance traced = pencil.clearance(tracer.tracer(), u, v, Tracer::Clip::apertures);
      if (!(traced.worst < 0)) continue;
      const double y = traced.ray.point_mm[1] - chief.image_height_mm;
      count += 1;
      sum += y;
      sum_sq += y * y + traced.ray.point_mm[0] * traced.ray.point_mm[0];
    }
  const double rms_um = std::sqrt(sum_sq / count - std::pow(sum / count, 2)) * um_per_mm;
  // The ragged edge of the grid: about n^-1.5 of its rays, at the rim where they count most.
  EXPECT_NEAR(spot(tracer, chief, RayWeight::light)->rms_radius_um / rms_um, 1, 2e-3);
}

TEST(Spots, OfAFieldThatNothingPassesAreAnError) {
  const Lens lens = read_lens("cooke-triplet").lens;
  FieldTableRequest request = FieldTableRequest::of(lens);
  request.fields = {80};
  EXPECT_THROW(spot_table(lens, request), InputError);
}

TEST(RingRays, LieEvenlyAndMirrorSymmetricallyOverTheBeam) {
  // The fisheye's beam at 70° is several times as wide as high.
  for (const auto& [name, field] : {std::pair{"cooke-triplet", 14.0}, {"fisheye-10mm", 70.0}}) {
    const Lens lens = read_lens(name).lens;
    FieldTracer tracer(lens, lens.reference_wavelength_nm);
    const ChiefRay chief = *tracer.chief_ray(field);
    constexpr int rings = 8;
    const std::vector<PupilRay> rays = ring_rays(tracer, chief, rings);
    ASSERT_EQ(rays.size(), 6u * rings * (rings + 1) / 2) << name;
    double sum_xx = 0, sum_x = 0;
    for (const PupilRay& ray : rays) {
      sum_x += ray.stop_x_mm;
      sum_xx += ray.stop_x_mm * ray.stop_x_mm;
      const bool mirrored = std::any_of(rays.begin(), rays.end(), [&](const PupilRay& other) {
        return std::hypot(other.x_mm + ray.x_mm, other.y_mm - ray.y_mm) < 1e-9;
      });
      EXPECT_TRUE(mirrored) << name << " " << ray.x_mm << " " << ray.y_mm;
    }
    EXPECT_NEAR(sum_x, 0, 1e-9);
    // Second moment along x against the quadrature over the same beam.
    double weight = 0, moment = 0;
    for (const PupilRay& ray : pupil_rays(tracer, chief)) {
      weight += ray.entrance_measure;
      moment += ray.entrance_measure * ray.stop_x_mm * ray.stop_x_mm;
    }
    // Rings end on the rim itself, so that they lie a little wider than the area does.
    EXPECT_NEAR(sum_xx / static_cast<double>(rays.size()) / (moment / weight), 1 + 1.0 / rings, 0.06) << name;
  }
}

}  // namespace
}  // namespace petzval
