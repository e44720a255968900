// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/analysis/field_curvature.h>
#include <petzval/analysis/field_values.h>
#include <petzval/analysis/seidel.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>

#include <cmath>

namespace petzval {
namespace {

/// The foci of real rays beside the chief ray: where neighbours `nudge` away on either side cross it.
AstigmaticFoci foci_of_close_rays(const FieldTracer& tracer, const ChiefRay& chief, double nudge) {
  const Pencil pencil = Pencil::from_object(tracer.lens(), chief.object_field);
  const auto trace = [&](double u, double v) {
    return tracer.tracer().trace(*pencil.ray(u, v), Tracer::Clip::none);
  };
  const Ray up = trace(0, chief.v + nudge), down = trace(0, chief.v - nudge), side = trace(nudge, chief.v);
  // In the meridian: the parameter along the chief ray at which the two neighbours meet.
  const double slope_up = up.direction[1] / up.direction[2],
               slope_down = down.direction[1] / down.direction[2];
  const double z = -(up.point_mm[1] - down.point_mm[1]) / (slope_up - slope_down);
  // Beside it: where the skew neighbour comes back to x = 0.
  const double z_side = -side.point_mm[0] * side.direction[2] / side.direction[0];
  return {z / chief.at_image.direction[2], z_side / chief.at_image.direction[2]};
}

TEST(FieldCurvature, IsThatOfCloseRealRays) {
  for (const char* name : {"double-gauss", "cooke-triplet", "edmund-54852", "fisheye-10mm", "petzval-lens"}) {
    const Lens lens = read_lens(name).lens;
    FieldTracer tracer(lens, lens.reference_wavelength_nm, Tracer::Clip::stop_only);
    const double nudge = lens.object_distance_mm ? 3e-6 : 2e-3;
    for (const double field : lens.fields.values) {
      SCOPED_TRACE(std::string(name) + " " + std::to_string(field));
      const ChiefRay chief = *tracer.chief_ray(object_field(lens, lens.fields.kind, field));
      const AstigmaticFoci ours = astigmatic_foci(tracer, chief),
                           close = foci_of_close_rays(tracer, chief, nudge);
      // Mirrored neighbours err by the square of the nudge, some 1e-7 of the focal length; rounding of the
      // small slopes by 1e-12 mm over 1e-5.
      const double tolerance = 2e-5 * std::abs(first_order(lens).efl_mm);
      EXPECT_NEAR(ours.tangential_mm, close.tangential_mm, tolerance);
      EXPECT_NEAR(ours.sagittal_mm, close.sagittal_mm, tolerance);
    }
  }
}

TEST(FieldCurvature, OfAspheresIsThatOfCloseRealRays) {
  Lens lens = read_lens("double-gauss").lens;
  lens.surfaces[0].conic = -0.4;
  lens.surfaces[2].asphere = {{4, -2e-6}, {5, 1e-7}, {6, 3e-9}};
  lens.surfaces[9].asphere = {{2, 1e-4}, {8, 1e-12}};
  FieldTracer tracer(lens, lens.reference_wavelength_nm, Tracer::Clip::stop_only);
  for (const double field : {0.0, 9.0, 14.0}) {
    const ChiefRay chief = *tracer.chief_ray(field);
    const AstigmaticFoci ours = astigmatic_foci(tracer, chief),
                         close = foci_of_close_rays(tracer, chief, 2e-3);
    EXPECT_NEAR(ours.tangential_mm, close.tangential_mm, 2e-3);
    EXPECT_NEAR(ours.sagittal_mm, close.sagittal_mm, 2e-3);
  }
}

TEST(FieldCurvature, OfSmallFieldsIsThatOfSeidel) {
  // δz_S = −(S3 + S4)/(2 n' u'²) and δz_T = −(3 S3 + S4)/(2 n' u'²) at the field of the sums, growing with
  // its square; Petzval −S4/(2 n' u'²). At a fifteenth of the field the next order is a share of about 1/225.
  for (const char* name : {"double-gauss", "cooke-triplet"}) {
    const Lens lens = read_lens(name).lens;
    Lens small = lens;
    small.fields.values = {1};
    const SeidelTerms sum = seidel_sums(small).sum;
    const FirstOrder paraxial = first_order(small);
    const double slope = paraxial.image_space_na;  // n' = 1
    FieldTableRequest request = FieldTableRequest::of(small);
    request.fields = {0, 1};
    request.wavelengths_nm = {lens.reference_wavelength_nm};
    const std::vector<FieldCurvatureRow> rows = field_curvature_table(small, request);
    const double axis = rows[0].tangential_mm;
    EXPECT_NEAR(axis, rows[0].sagittal_mm, 1e-9);
    EXPECT_NEAR(axis, paraxial.paraxial_image_mm - small.surfaces.back().thickness_mm, 1e-9);
    const double unit = 1 / (2 * slope * slope);
    const double tolerance = 0.02 * (std::abs(sum.s3) + std::abs(sum.s4)) * unit;
    EXPECT_NEAR(rows[1].sagittal_mm - axis, -(sum.s3 + sum.s4) * unit, tolerance);
    EXPECT_NEAR(rows[1].tangential_mm - axis, -(3 * sum.s3 + sum.s4) * unit, tolerance);
    EXPECT_NEAR(rows[1].petzval_mm - rows[0].petzval_mm, -sum.s4 * unit, tolerance);
  }
}

TEST(FieldCurvature, OfABallIsConcentric) {
  // A ball with the stop at its centre: every chief ray is an axis, so T = S on a sphere about the centre.
  Lens lens;
  Surface front, stop, back;
  front.curvature_per_mm = 0.1;
  front.thickness_mm = 10;
  front.material = Material(Material::Constant{1.5});
  stop.stop = true;
  stop.thickness_mm = 10;
  stop.material = Material(Material::Constant{1.5});
  back.curvature_per_mm = -0.1;
  back.thickness_mm = 5;  // f = n R/(2 (n − 1)) = 15 from the centre
  lens.surfaces = {front, stop, back};
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 0.5};
  lens.fields.values = {0, 20, 40};
  for (const FieldCurvatureRow& row : field_curvature_table(lens, FieldTableRequest::of(lens))) {
    const double theta = row.field * std::acos(-1.0) / 180;
    EXPECT_NEAR(row.tangential_mm, 15 * std::cos(theta) - 15, 1e-10);
    EXPECT_NEAR(row.sagittal_mm, 15 * std::cos(theta) - 15, 1e-10);
  }
}

}  // namespace
}  // namespace petzval
