// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/aberration_fans.h>
#include <petzval/analysis/seidel.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>

#include <cmath>

#include "golden_lenses.h"

namespace petzval {
namespace {

class GoldenFans : public GoldenLensTest {};

TEST_P(GoldenFans, AgreeWithAnotherTracersRays) {
  // Fans of five rays lie on the reference's rays at −1, −0.5, 0, 0.5 and 1 where it has those.
  FieldTableRequest request = FieldTableRequest::of(lens);
  request.clip = Tracer::Clip::stop_only;
  const std::vector<AberrationFans> rows = aberration_fans(lens, request, 201);
  int compared = 0;
  for (const nlohmann::json& ray : reference["rays"]["rows"]) {
    const double px = ray["stop_px"], py = ray["stop_py"];
    if (px != 0 && py != 0) continue;
    double chief_mm = NAN;
    for (const nlohmann::json& chief : reference["chief_rays"]["rows"])
      if (chief["field_deg"] == ray["field_deg"])
        for (const nlohmann::json& each : chief["per_wl"])
          if (std::abs(each["wavelength_um"].get<double>() * 1000 - lens.reference_wavelength_nm) < 1e-6)
            chief_mm = each["y_image"];
    for (const AberrationFans& fans : rows) {
      if (fans.field != ray["field_deg"].get<double>() ||
          std::abs(fans.wavelength_nm - ray["wavelength_um"].get<double>() * 1000) > 1e-6)
        continue;
      for (const FanPoint& point : px == 0 ? fans.tangential : fans.sagittal) {
        if (std::abs(point.pupil - (px == 0 ? py : px)) > 1e-12) continue;
        ++compared;
        const double tolerance = 1e-6;  // µm: the reference's aim
        EXPECT_NEAR(point.x_um, ray["image_xyz"][0].get<double>() * um_per_mm, tolerance);
        EXPECT_NEAR(point.y_um, (ray["image_xyz"][1].get<double>() - chief_mm) * um_per_mm, tolerance);
      }
    }
  }
  EXPECT_GT(compared, 20);
}

INSTANTIATE_TEST_SUITE_P(Lenses, GoldenFans, golden_lenses());

TEST(AberrationFans, OfSmallApertureAreTheCubicOfSeidel) {
  // On the axis ε(ρ) = −4 W040 ρ³/(n'u') with W040 = S1/8 [mm]: the fifth order and the sine of the cone are
  // shares of the square of the aperture, f/25 here. The sign: undercorrected light (S1 > 0) from the upper
  // rim crosses the axis before the image and lands below it.
  Lens lens = read_lens("double-gauss").lens;
  lens.aperture = {Aperture::Kind::f_number, 25};
  lens.fields.values = {0, 14};
  lens.surfaces.back().thickness_mm = first_order(lens).paraxial_image_mm;
  const SeidelSums sums = seidel_sums(lens);
  FieldTableRequest request = FieldTableRequest::of(lens);
  request.fields = {0};
  request.wavelengths_nm = {lens.reference_wavelength_nm};
  const AberrationFans fans = aberration_fans(lens, request, 5).front();
  ASSERT_EQ(fans.tangential.size(), 5U);
  const double slope = 1 / (2 * 25.0);
  for (const FanPoint& point : fans.tangential) {
    const double rho = point.pupil;
    const double third_order_um = -sums.sum.s1 / 2 / slope * rho * rho * rho * um_per_mm;
    EXPECT_NEAR(point.y_um, third_order_um, 0.02 * std::abs(sums.sum.s1) / 2 / slope * um_per_mm);
    EXPECT_NEAR(point.x_um, 0, 1e-9);
    // W(ρ) = W040 ρ⁴: the same fan, integrated.
    const double w040 = sums.sum.s1 / 8 / (lens.reference_wavelength_nm * mm_per_nm);
    EXPECT_NEAR(point.opd_waves, w040 * std::pow(rho, 4), 0.03 * std::abs(w040));
  }
}

TEST(AberrationFans, SagittalFansAreMirrorSymmetric) {
  const Lens lens = read_lens("cooke-triplet").lens;
  FieldTableRequest request = FieldTableRequest::of(lens);
  request.clip = Tracer::Clip::stop_only;
  for (const AberrationFans& fans : aberration_fans(lens, request, 11)) {
    ASSERT_EQ(fans.sagittal.size(), 11U);
    for (std::size_t i = 0; i < 11; ++i) {
      const FanPoint &one = fans.sagittal[i], &other = fans.sagittal[10 - i];
      EXPECT_NEAR(one.x_um, -other.x_um, 1e-6);
      EXPECT_NEAR(one.y_um, other.y_um, 1e-6);
      EXPECT_NEAR(one.opd_waves, other.opd_waves, 1e-7);
    }
  }
}

TEST(AberrationFans, RefuseSillyCounts) {
  const Lens lens = read_lens("cooke-triplet").lens;
  EXPECT_THROW(aberration_fans(lens, FieldTableRequest::of(lens), 2), InputError);
  EXPECT_THROW(aberration_fans(lens, FieldTableRequest::of(lens), 1 << 30), InputError);
}

}  // namespace
}  // namespace petzval
