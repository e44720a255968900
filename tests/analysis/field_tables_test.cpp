// SPDX-License-Identifier: BSD-3-Clause
// Distortion and illumination of the paper's lens and of others, against figures from elsewhere and against
// laws.
#include <gtest/gtest.h>
#include <petzval/analysis/field_tables.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/field_values.h>
#include <petzval/analysis/tv_distortion.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>

#include <cmath>

namespace petzval {
namespace {

TEST(Distortion, OfThePapersLensAtParaxialAndRealThreeMillimetres) {
  // Figures of an independent prototype for 587.56 nm, given to 0.01 %.
  const Lens lens = read_lens("edmund-54852").lens;
  FieldTableRequest request = FieldTableRequest::of(lens);
  request.wavelengths_nm = {587.5618};
  request.fields = {0, 3};
  EXPECT_NEAR(distortion_table(lens, request)[1].paraxial_distortion_percent, -8.40, 0.005);
  // The sensor stands where the paper's 6 mm f/1.8 lens is sharpest, not in the paraxial image.
  request.fields = {0, 1e-3};
  const auto near_axis = distortion_table(lens, request);
  EXPECT_NEAR(near_axis[0].paraxial_distortion_percent, near_axis[1].paraxial_distortion_percent, 1e-5)
      << "cubic in the field";
  request.fields = {0, 3};
  request.field_kind = Fields::Kind::real_image_height_mm;
  const DistortionRow row = distortion_table(lens, request)[1];
  EXPECT_NEAR(row.paraxial_distortion_percent, -10.67, 0.005);
  EXPECT_NEAR(row.image_height_mm, 3, 1e-12);
  EXPECT_FALSE(row.distortion_ftheta_percent) << "f θ means nothing for a finite object";
}

TEST(Distortion, OfTheCookeTripletEqualsTheReference) {
  // tests/data/cooke_triplet_f5.ref.json: distortion_ftan_percent and distortion_ftheta_percent at 550 nm.
  const Lens lens = read_lens("cooke-triplet").lens;
  FieldTableRequest request;
  request.fields = {7, 14, 17};
  request.wavelengths_nm = {550};
  const auto rows = distortion_table(lens, request);
  EXPECT_NEAR(rows[0].paraxial_distortion_percent, -0.39823555326526927, 1e-7);
  EXPECT_NEAR(*rows[0].distortion_ftheta_percent, 0.1003015724278189, 1e-7);
  EXPECT_NEAR(rows[1].paraxial_distortion_percent, -0.3758278773583923, 1e-7);
  EXPECT_NEAR(rows[2].paraxial_distortion_percent, -0.35779415856248553, 1e-7);
  EXPECT_NEAR(*rows[2].distortion_ftheta_percent, 2.6729566730813614, 1e-7);
}

TEST(Distortion, TendsToThatOfTheParaxialChiefRayOnADefocusedSensor) {
  // The sensor 0.5 mm behind the focus: the chief ray lands higher than f tan θ by 0.5 mm times its slope.
  for (const char* name : {"cooke-triplet", "double-gauss", "dgauss-50mm"}) {
    Lens lens = read_lens(name).lens;
    lens.surfaces.back().thickness_mm += 0.5;
    FieldTableRequest request;
    request.fields = {0, 0.01};
    request.wavelengths_nm = {lens.reference_wavelength_nm};
    const auto rows = distortion_table(lens, request);
    EXPECT_GT(std::abs(rows[0].paraxial_distortion_percent), 0.1) << name;
    EXPECT_NEAR(rows[0].paraxial_distortion_percent, rows[1].paraxial_distortion_percent, 1e-5) << name;
    EXPECT_NEAR(*rows[0].distortion_ftheta_percent, *rows[1].distortion_ftheta_percent, 1e-5) << name;
  }
}

TEST(Distortion, IsCountedFromTheMagnificationAtTheCentre) {
  // A sensor off the paraxial focus has another magnification; what counts is that of traced rays close to
  // the axis, on that sensor.
  for (const char* name : {"edmund-54852", "cooke-triplet", "double-gauss"}) {
    Lens lens = read_lens(name).lens;
    lens.surfaces.back().thickness_mm += 0.2;
    for (const double nm : {lens.wavelengths_nm.front(), lens.wavelengths_nm.back()}) {
      const double largest = lens.fields.values.back();
      FieldTableRequest request = FieldTableRequest::of(lens);
      request.wavelengths_nm = {nm};
      request.fields = {0, largest / 1000, largest};
      const auto rows = distortion_table(lens, request);
      const auto height = [&](const DistortionRow& row) {
        return lens.object_distance_mm ? row.object_field : std::tan(radians(row.object_field));
      };
      const double magnification = rows[1].image_height_mm / height(rows[1]);
      EXPECT_EQ(rows[0].distortion_percent, 0);
      EXPECT_NEAR(rows[2].distortion_percent,
                  100 * (rows[2].image_height_mm / (magnification * height(rows[2])) - 1), 1e-4)
          << name << ' ' << nm;
    }
  }
}

TEST(Distortion, OfTelevisionIsThatOfACubicLens) {
  // h' = f t (1 + k t²): the corner at tangent t has a height at the edge of h'(t) H/D, the middle h'(t H/D),
  // so that (A − B)/B = (1 + k t²)/(1 + k t² (H/D)²) − 1. A lens is cubic close to the axis.
  const Lens lens = read_lens("double-gauss").lens;
  FieldTableRequest request;
  request.wavelengths_nm = {lens.reference_wavelength_nm};
  request.fields = {0, 3};
  const DistortionRow corner = distortion_table(lens, request)[1];
  const double d = 2 * corner.image_height_mm;
  const auto rows = tv_distortion(lens, {0.8 * d, 0.6 * d}, request.wavelengths_nm);
  const double bend = corner.distortion_percent / 100;
  EXPECT_NEAR(rows[0].smia_percent, 100 * ((1 + bend) / (1 + bend * 0.36) - 1), 1e-2 * std::abs(bend) * 100);
  EXPECT_NEAR(rows[0].picture_height_percent, rows[0].smia_percent / 2, 1e-12);
  EXPECT_LT(rows[0].smia_percent, 0) << "a barrel";
  EXPECT_THROW(tv_distortion(lens, {0, 600}, request.wavelengths_nm), InputError);
}

TEST(FieldValues, OfAllKindsNameTheSameObjectPoint) {
  const Lens lens = read_lens("edmund-54852").lens;
  FieldTracer tracer(lens, lens.reference_wavelength_nm);
  const double object = object_field(lens, Fields::Kind::paraxial_image_height_mm, 2.0);
  const double real = tracer.chief_ray(object)->image_height_mm;
  EXPECT_GT(real, 0) << "a positive image height stays positive";
  EXPECT_LT(object, 0) << "so its object lies below the axis";
  EXPECT_NEAR(object_field(lens, Fields::Kind::real_image_height_mm, real), object, 1e-9);
  EXPECT_EQ(object_field(lens, Fields::Kind::object_height_mm, object), object);
  // The angle of the paraxial chief ray: from the object to the entrance pupil 4.05795 mm behind vertex 1.
  const double angle = degrees(std::atan(-object / (250 + 4.057948)));
  EXPECT_NEAR(object_field(lens, Fields::Kind::angle_deg, angle), object, 1e-4);
}

TEST(FieldValues, RefuseWhatTheLensCannotHave) {
  const Lens infinite = read_lens("cooke-triplet").lens;
  EXPECT_THROW(object_field(infinite, Fields::Kind::object_height_mm, 5), InputError);
  EXPECT_THROW(object_field(infinite, Fields::Kind::real_image_height_mm, 500), InputError);
}

TEST(Illumination, OfAThinLensFallsAsCosFourth) {
  // A stop alone in front of an infinite object, refracted by nothing: the cos⁴ law holds exactly in the
  // sense of g_source; a weak thin lens at the stop approaches it.
  Lens lens;
  lens.name = "weak lens";
  Surface front, back;
  front.curvature_per_mm = 0.5e-3;
  front.thickness_mm = 1e-3;
  front.material = Material(Material::Constant{1.5});
  front.stop = true;
  back.curvature_per_mm = -0.5e-3;
  back.thickness_mm = 2000;
  lens.surfaces = {front, back};
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 5};
  FieldTableRequest request;
  request.fields = {0, 10, 20, 30};
  request.wavelengths_nm = {550};
  for (const IlluminationRow& row : illumination_table(lens, request)) {
    const double cos4 = std::pow(std::cos(radians(row.field)), 4);
    EXPECT_NEAR(row.relative_illumination, cos4, 2e-5) << row.field;  // terms of order (5/2000)²
    EXPECT_NEAR(row.g_source_sr / row.g_sensor_sr, 1, 5e-5) << row.field;
  }
}

TEST(Illumination, IsTheSameForAnyNumberOfThreads) {
  const Lens lens = read_lens("wide-22mm").lens;
  const FieldTableRequest request = FieldTableRequest::of(lens);
  const auto all = illumination_table(lens, request);
  const ThreadLimit one(1);
  const auto single = illumination_table(lens, request);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].g_sensor_sr, single[i].g_sensor_sr);
    EXPECT_EQ(all[i].g_source_sr, single[i].g_source_sr);
  }
}

TEST(Illumination, SaysWhenTheStopIsBlocked) {
  Lens lens = read_lens("dgauss-50mm").lens;
  FieldTableRequest request = FieldTableRequest::of(lens);
  request.fields = {89};
  try {
    illumination_table(lens, request);
    FAIL() << "a field of 89° cannot pass";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("89"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace petzval
