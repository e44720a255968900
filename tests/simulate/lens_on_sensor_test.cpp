// SPDX-License-Identifier: BSD-3-Clause
// What a lens does for a sensor, against the closed forms of a thin lens and against MTF of moved objects.
#include <gtest/gtest.h>
#include <petzval/analysis/mtf.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>
#include <petzval/simulate/lens_on_sensor.h>
#include <petzval/simulate/mounting.h>

#include <cmath>

namespace petzval {
namespace {

constexpr double focal_mm = 50, f_number = 8, pixel_mm = 0.02;

/// An equiconvex lens without thickness, 1/f = (n − 1)(c1 − c2), the stop at the lens.
Lens thin_lens() {
  Lens lens;
  lens.name = "thin";
  lens.aperture = {Aperture::Kind::f_number, f_number};
  lens.fields.values = {0, 3};
  lens.wavelengths_nm = {550}, lens.reference_wavelength_nm = 550;
  Surface front, back;
  front.curvature_per_mm = 1 / focal_mm, front.thickness_mm = 0, front.stop = true;
  front.material = Material(Material::Constant{1.5});
  back.curvature_per_mm = -1 / focal_mm, back.thickness_mm = focal_mm;
  lens.surfaces = {front, back};
  return lens;
}

Camera thin_camera() {
  Camera camera;
  camera.lens = thin_lens();
  camera.sensor = read_sensor("64x48@20");
  camera.focus = Focus::at_m(1);  // whatever the distance: focused there, not sought
  return camera;
}

TEST(LensOnSensor, HasTheViewAndTheDepthOfAThinLens) {
  const double s = 3000;  // from the lens
  const double image_mm = focal_mm * s / (s - focal_mm), m = focal_mm / (s - focal_mm);
  const LensOnSensor found = lens_on_sensor(thin_camera(), (s + image_mm) / mm_per_m);
  EXPECT_NEAR(found.magnification / -m, 1, 1e-6);
  EXPECT_NEAR(found.view.width / (64 * pixel_mm / m), 1, 1e-3);
  EXPECT_NEAR(found.per_pixel / (pixel_mm / m), 1, 1e-6);
  const double spread = f_number * pixel_mm * (s - focal_mm), f2 = focal_mm * focal_mm;
  EXPECT_NEAR(found.geometric.near_m * mm_per_m - image_mm, s * f2 / (f2 + spread), 1e-3);
  EXPECT_NEAR(found.geometric.far_m * mm_per_m - image_mm, s * f2 / (f2 - spread), 1e-3);
  EXPECT_NEAR(found.hyperfocal_m * mm_per_m, f2 / (f_number * pixel_mm) + focal_mm, 1e-3);
  EXPECT_NEAR(found.nyquist_cpmm, 25, 1e-12);
}

TEST(LensOnSensor, IsSharpToInfinityFromTheHyperfocalDistanceOn) {
  const double hyperfocal_m = lens_on_sensor(thin_camera(), {}).hyperfocal_m;
  EXPECT_TRUE(std::isfinite(lens_on_sensor(thin_camera(), 0.95 * hyperfocal_m).geometric.far_m));
  const LensOnSensor beyond = lens_on_sensor(thin_camera(), 1.05 * hyperfocal_m);
  EXPECT_TRUE(std::isinf(beyond.geometric.far_m));
  EXPECT_NEAR(beyond.geometric.near_m / hyperfocal_m, 0.5, 0.02) << "half of it";
}

double mtf_in_the_middle(const Lens& lens, double frequency_cpmm) {
  FieldTableRequest at = FieldTableRequest::of(lens);
  at.fields = {0};
  MtfOptions options;
  options.frequencies_cpmm = {frequency_cpmm};
  options.weights.assign(at.wavelengths_nm.size(), 1);
  const MtfRow row = mtf_table(lens, at, options).front();
  return (row.tangential + row.sagittal) / 2;
}

// The object moved there, the sensor where it was: another way than sensors beside the focus.
TEST(LensOnSensor, KeepsFourFifthsOfItsMtfWithinTheDepthByMtf) {
  Camera camera;
  camera.lens = read_lens("cooke-triplet").lens;
  camera.sensor = read_sensor("640x480@10");
  camera.focus = Focus::at_m(1);
  const LensOnSensor found = lens_on_sensor(camera, 2);
  ASSERT_TRUE(found.by_mtf);
  const Lens lens = focus(mounted_lens(camera, {}), Focus::at_m(2), {}, {});
  const double sharp = mtf_in_the_middle(lens, 25);
  EXPECT_NEAR(sharp, found.places[0].half_nyquist_tangential, 1e-4);
  for (const double end_m : {found.by_mtf->near_m, found.by_mtf->far_m}) {
    MountedLens moved(lens);
    moved.place_object_at_m(end_m);
    EXPECT_NEAR(mtf_in_the_middle(moved.lens(), 25) / sharp, 0.8, 0.02) << end_m;
  }
}

TEST(LensOnSensor, SaysWhereALensEnds) {
  Camera camera;
  camera.lens = read_lens("edmund-54852").lens;
  camera.sensor = read_sensor("full-frame-24mp");
  const LensOnSensor found = lens_on_sensor(camera, 0.25);
  EXPECT_LT(found.image_circle_mm, found.sensor_diagonal_mm);
  EXPECT_TRUE(std::isnan(found.places[2].nyquist_tangential));
  EXPECT_GT(found.places[0].half_nyquist_tangential, 0);
  camera.sensor.reset();
  EXPECT_THROW(lens_on_sensor(camera, 0.25), InputError);
}

TEST(LensMatch, FindsTheLensesThatSeeTheWidth) {
  LensMatchRequest request{read_sensor("third-inch-1280x960"), 1.5, 134};
  const std::vector<LensOnSensor> found = match_lenses(request);
  EXPECT_TRUE(std::ranges::any_of(found, [](const auto& lens) { return lens.lens == "cooke-triplet"; }));
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i].view.width / 134, 1, 0.06) << found[i].lens;
    EXPECT_EQ(found[i].scale, 1);
    if (i > 0) {
      const auto corner = [](const LensOnSensor& lens) {
        return std::min(lens.places[2].half_nyquist_tangential, lens.places[2].half_nyquist_sagittal);
      };
      EXPECT_GE(corner(found[i - 1]), corner(found[i]));
    }
  }
  request.f_number = 1;
  EXPECT_TRUE(match_lenses(request).empty()) << "none opens so wide";
  request.width_mm = 0;
  EXPECT_THROW(match_lenses(request), InputError);
}

}  // namespace
}  // namespace petzval
