// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/spots.h>
#include <petzval/analysis/stop_aim.h>
#include <petzval/analysis/vignetting.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>

#include <cmath>

#include "golden_lenses.h"

namespace petzval {
namespace {

/// Two thin plates in front of a perfect stop: a beam at angle θ from circles of one radius a distance apart.
Lens tube(double length_mm, double radius_mm) {
  Lens lens;
  Surface front, stop;
  front.thickness_mm = length_mm;
  front.semi_diameter_mm = radius_mm;
  stop.stop = true;
  stop.curvature_per_mm = 0;
  stop.material = Material(Material::Constant{1.5});
  stop.thickness_mm = 1e-3;
  Surface back;
  back.curvature_per_mm = -1.0 / 100;
  back.thickness_mm = 200;
  lens.surfaces = {front, stop, back};
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, radius_mm};
  return lens;
}

TEST(Vignetting, OfTwoEqualCirclesIsTheirOverlap) {
  const double length = 20, radius = 4;
  Lens lens = tube(length, radius);
  lens.fields.values = {0, 5, 10, 15};
  for (const VignettingRow& row : vignetting_table(lens, FieldTableRequest::of(lens))) {
    // On the stop the front circle appears shifted by L tan θ, upwards for a ray that rises.
    const double shift = length * std::tan(radians(row.field)), half = shift / (2 * radius);
    const double overlap = (2 / pi) * (std::acos(half) - half * std::sqrt(1 - half * half));
    EXPECT_NEAR(row.open_share, overlap, 2e-4);  // corners of the boundary: 1/azimuths²
    EXPECT_NEAR(row.pupil_high, 1, 1e-4);
    EXPECT_NEAR(row.pupil_low, shift / radius - 1, 1e-4);
    // The widest place is a corner, seen between two of 512 azimuths.
    EXPECT_NEAR(row.pupil_half_width, std::sqrt(1 - half * half), 2 * pi / 512);
    if (row.field > 0) {
      EXPECT_EQ(row.low_surface, 0);
      EXPECT_EQ(row.high_surface, 1);
    }
  }
}

TEST(Vignetting, OfAnOpenLensIsNone) {
  const Lens lens = read_lens("cooke-triplet").lens;
  FieldTableRequest request = FieldTableRequest::of(lens);
  request.clip = Tracer::Clip::stop_only;
  for (const VignettingRow& row : vignetting_table(lens, request)) {
    EXPECT_NEAR(row.open_share, 1, 1e-6);
    EXPECT_NEAR(row.pupil_low, -1, 1e-4);
    EXPECT_NEAR(row.pupil_high, 1, 1e-4);
    EXPECT_EQ(row.low_surface, static_cast<int>(lens.stop_index()));
  }
}

TEST(Vignetting, EndsAreWhereAimedRaysStopPassing) {
  const Lens lens = read_lens("dgauss-50mm").lens;
  FieldTableRequest request = FieldTableRequest::of(lens);
  request.wavelengths_nm = {lens.reference_wavelength_nm};
  bool some = false;
  for (const VignettingRow& row : vignetting_table(lens, request)) {
    FieldTracer tracer(lens, row.wavelength_nm);
    StopAim aim = *StopAim::of(tracer, *tracer.chief_ray(row.field));
    for (const double inwards : {1e-3, -1e-3}) {
      EXPECT_EQ(aim.ray(0, row.pupil_high - inwards).has_value(), inwards > 0);
      EXPECT_EQ(aim.ray(0, row.pupil_low + inwards).has_value(), inwards > 0);
    }
    some = some || row.open_share < 0.9;
  }
  EXPECT_TRUE(some) << "this lens is known to vignette";
}

class GoldenChiefRays : public GoldenLensTest {};

TEST_P(GoldenChiefRays, ArriveAtTheAngleOfAnotherTracer) {
  FieldTableRequest request = FieldTableRequest::of(lens);
  request.clip = Tracer::Clip::stop_only;
  int compared = 0;
  for (const ChiefRayAngleRow& row : chief_ray_angle_table(lens, request))
    for (const nlohmann::json& field : reference["chief_rays"]["rows"])
      for (const nlohmann::json& each : field["per_wl"]) {
        if (field["field_deg"] != row.field ||
            std::abs(each["wavelength_um"].get<double>() * 1000 - row.wavelength_nm) > 1e-6)
          continue;
        ++compared;
        EXPECT_NEAR(row.chief_ray_angle_deg,
                    degrees(std::atan2(each["M"].get<double>(), each["N"].get<double>())), 1e-9);
        // The light's mean direction is off by the pupil's aberrations, small here.
        EXPECT_NEAR(row.mean_ray_angle_deg, row.chief_ray_angle_deg, 0.3);
      }
  EXPECT_EQ(compared, 15);
}

INSTANTIATE_TEST_SUITE_P(Lenses, GoldenChiefRays, golden_lenses());

TEST(ChiefRayAngle, OfASmallFieldPointsAwayFromTheExitPupil) {
  Lens lens = read_lens("edmund-54852").lens;
  lens.fields = {Fields::Kind::paraxial_image_height_mm, {0.01, -0.01}};
  lens.wavelengths_nm = {lens.reference_wavelength_nm};
  const double pupil_mm = first_order(lens).exit_pupil.position_mm;
  // Both signs point outwards. What the pupil's own aberration changes grows with the cube of the field.
  for (const ChiefRayAngleRow& row : chief_ray_angle_table(lens, FieldTableRequest::of(lens)))
    EXPECT_NEAR(row.chief_ray_angle_deg, degrees(std::atan(std::abs(row.real_image_height_mm) / -pupil_mm)),
                1e-6);
}

}  // namespace
}  // namespace petzval
