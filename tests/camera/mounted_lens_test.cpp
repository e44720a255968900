// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/camera/mounted_lens.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>

#include <cmath>
#include <limits>

namespace petzval {
namespace {

Surface surface(double curvature, double thickness, double index) {
  Surface s;
  s.curvature_per_mm = curvature;
  s.thickness_mm = thickness;
  if (index != 1) s.material = Material(Material::Constant{index});
  return s;
}

/// Equiconvex lens of index 1.5 without thickness and focal length 50 mm (1/f = (n − 1)(c1 − c2)), stop at
/// the lens, open to f/2, focused on infinity.
Lens thin_lens() {
  Lens lens;
  lens.name = "thin";
  lens.aperture = {Aperture::Kind::f_number, 2};
  lens.fields.values = {0, 10};
  lens.surfaces = {surface(0.02, 0, 1.5), surface(-0.02, 50, 1)};
  lens.surfaces[0].stop = true;
  return lens;
}

/// A thick doublet behind a stop, with its object at a finite distance and its sensor 0.2 mm off the
/// paraxial image: nothing about it is symmetric.
Lens thick_lens() {
  Lens lens;
  lens.name = "thick";
  lens.object_distance_mm = 250;
  lens.aperture = {Aperture::Kind::working_f_number, 4};
  lens.fields = {Fields::Kind::object_height_mm, {0, 40}};
  lens.surfaces = {surface(0, 1.5, 1), surface(0.01, 4, 1.6), surface(-0.03, 2, 1.7), surface(-0.02, 30, 1)};
  lens.surfaces[0].stop = true;
  lens.surfaces.back().thickness_mm =
      paraxial_image_distance_mm(lens, 250.0, lens.reference_wavelength_nm) + 0.2;
  return lens;
}

double last_thickness(const MountedLens& camera) {
  return camera.lens().surfaces.back().thickness_mm;
}

/// From the paraxial image of the camera's object to its sensor.
double defocus_mm(const MountedLens& camera) {
  const Lens& lens = camera.lens();
  return last_thickness(camera) -
         paraxial_image_distance_mm(lens, lens.object_distance_mm, lens.reference_wavelength_nm);
}

// Thin lens: 1/s + 1/i = 1/f and s + i = D, so s = D/2 + √(D²/4 − fD). 1e-10 mm is rounding of a root of
// numbers of order 1e3.
TEST(MountedLens, FocusesAThinLensByTheLensEquation) {
  for (const double distance_m : {0.2001, 0.3, 1.0, 7.0}) {
    MountedLens camera(thin_lens());
    camera.focus_at_m(distance_m);
    const double d = distance_m * 1000, s = d / 2 + std::sqrt(d * d / 4 - 50 * d);
    ASSERT_TRUE(camera.lens().object_distance_mm.has_value());
    EXPECT_NEAR(*camera.lens().object_distance_mm, s, 1e-10);
    EXPECT_NEAR(last_thickness(camera), d - s, 1e-10);
    EXPECT_NEAR(1 / s + 1 / last_thickness(camera), 1 / 50.0, 1e-12);
  }
}

TEST(MountedLens, StatesTheShortestDistance) {
  MountedLens camera(thin_lens());
  try {
    camera.focus_at_m(0.19);
    FAIL() << "an image nearer than four focal lengths";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("at least 0.2 m"), std::string::npos) << error.what();
  }
  EXPECT_NO_THROW(camera.focus_at_m(0.2000001));
}

TEST(MountedLens, MovesNothingAtTheDesignsOwnDistance) {
  for (const Lens& lens : {thin_lens(), thick_lens()}) {
    MountedLens camera(lens);
    const std::optional<double> designed = camera.object_distance_from_sensor_m();
    camera.focus_at_m(1.7);
    camera.focus_at_m(designed);
    EXPECT_EQ(camera.lens().object_distance_mm, lens.object_distance_mm);
    EXPECT_EQ(last_thickness(camera), lens.surfaces.back().thickness_mm);
    EXPECT_EQ(camera.lens().aperture.kind, lens.aperture.kind);
    EXPECT_EQ(camera.lens().fields.values, lens.fields.values);
  }
}

TEST(MountedLens, KeepsTheDesignersDefocusAndHitsTheDistanceAskedFor) {
  for (const double distance_m : {0.3, 0.5, 2.0, 50.0}) {
    MountedLens camera(thick_lens());
    camera.focus_at_m(distance_m);
    EXPECT_NEAR(defocus_mm(camera), 0.2, 1e-10) << distance_m;
    EXPECT_NEAR(*camera.object_distance_from_sensor_m(), distance_m, 1e-13 * distance_m) << distance_m;
  }
  MountedLens at_infinity(thick_lens());
  at_infinity.focus_at_m({});
  EXPECT_FALSE(at_infinity.object_distance_from_sensor_m().has_value());
  EXPECT_NEAR(defocus_mm(at_infinity), 0.2, 1e-10);
  MountedLens infinite_number(thick_lens());
  infinite_number.focus_at_m(std::numeric_limits<double>::infinity());
  EXPECT_EQ(last_thickness(infinite_number), last_thickness(at_infinity));
}

TEST(MountedLens, FocusDoesNotDependOnWhatCameBefore) {
  MountedLens straight(thick_lens()), wandering(thick_lens());
  straight.focus_at_m(0.6);
  wandering.focus_at_m({});
  wandering.set_f_number(8);
  wandering.place_object_at_m(3.0);
  wandering.focus_at_m(0.6);
  EXPECT_EQ(last_thickness(straight), last_thickness(wandering));
  EXPECT_EQ(*straight.lens().object_distance_mm, *wandering.lens().object_distance_mm);
  wandering.focus_as_designed();
  EXPECT_EQ(last_thickness(wandering), thick_lens().surfaces.back().thickness_mm);
  EXPECT_EQ(*wandering.lens().object_distance_mm, 250);
}

// A lens designed to magnify keeps magnifying: of the two conjugates with D = 250 mm it takes the near one.
TEST(MountedLens, StaysOnItsSideOfUnitMagnification) {
  Lens macro = thin_lens();
  macro.object_distance_mm = 60;  // i = 300 mm, five times magnified
  macro.surfaces.back().thickness_mm = 300;
  MountedLens camera(macro);
  camera.focus_at_m(0.25);
  EXPECT_NEAR(*camera.lens().object_distance_mm, 125 - std::sqrt(125.0 * 125 - 50 * 250), 1e-10);
}

TEST(MountedLens, PlacesTheObjectWithoutMovingTheSensor) {
  MountedLens camera(thick_lens());
  camera.place_object_at_m(2.0);
  EXPECT_EQ(last_thickness(camera), thick_lens().surfaces.back().thickness_mm);
  EXPECT_NEAR(*camera.object_distance_from_sensor_m(), 2.0, 1e-13);
  EXPECT_NEAR(*camera.lens().object_distance_mm, 2000 - thick_lens().total_track_mm(), 1e-10);
  camera.place_object_at_m({});
  EXPECT_FALSE(camera.lens().object_distance_mm.has_value());
}

TEST(MountedLens, RefusesObjectsInsideTheLens) {
  MountedLens camera(thick_lens());
  EXPECT_THROW(camera.place_object_at_m(0.03), InputError);
  EXPECT_THROW(camera.place_object_at_m(0), InputError);
  EXPECT_THROW(camera.focus_at_m(-1), InputError);
  EXPECT_THROW(camera.focus_at_m(std::nan("")), InputError);
  EXPECT_THROW(camera.focus_at_m(0.001), InputError);
}

TEST(MountedLens, RefusesLensesWithoutARealImage) {
  Lens negative = thin_lens();
  for (Surface& s : negative.surfaces) s.curvature_per_mm *= -1;
  MountedLens camera(negative);
  EXPECT_THROW(camera.focus_at_m({}), InputError);
  EXPECT_THROW(camera.focus_at_m(1), InputError);
}

TEST(MountedLens, StopsDownButNotUp) {
  MountedLens camera(thin_lens());
  camera.set_f_number(5.6);
  EXPECT_NEAR(first_order(camera.lens()).f_number, 5.6, 1e-12);
  EXPECT_NEAR(first_order(camera.lens()).entrance_pupil.diameter_mm, 50 / 5.6, 1e-11);
  camera.set_f_number(1.996);  // 2.00 to two decimals
  EXPECT_NEAR(first_order(camera.lens()).f_number, 2, 1e-12);
  camera.set_f_number(2);  // and open again: what counts is the prescription's own f-number
  try {
    camera.set_f_number(1.9);
    FAIL() << "opened wider than it can";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("opens to f/2 only"), std::string::npos) << error.what();
  }
  EXPECT_EQ(camera.lens().aperture.value, 2);
  EXPECT_THROW(camera.set_f_number(0), InputError);
  EXPECT_THROW(camera.set_f_number(std::nan("")), InputError);
}

// Working f-number 4 at 250 mm is a certain hole; refocusing must not open or close it.
TEST(MountedLens, RefocusingKeepsTheEntrancePupil) {
  MountedLens camera(thick_lens());
  const double diameter = first_order(camera.lens()).entrance_pupil.diameter_mm;
  camera.focus_at_m(1.0);
  EXPECT_NEAR(first_order(camera.lens()).entrance_pupil.diameter_mm, diameter, 1e-12);
  camera.set_f_number(16);
  EXPECT_EQ(camera.lens().aperture.kind, Aperture::Kind::f_number);
  camera.focus_as_designed();
  EXPECT_EQ(camera.lens().aperture.value, 16);
}

// The stop stands at vertex 1, so the angle from the entrance pupil is atan(40/250) whatever the distance.
TEST(MountedLens, RefocusingKeepsFieldAngles) {
  MountedLens camera(thick_lens());
  camera.focus_at_m(2.0);
  EXPECT_NEAR(camera.lens().fields.values[1] / *camera.lens().object_distance_mm, 0.16, 1e-12);
  camera.focus_at_m({});
  EXPECT_EQ(camera.lens().fields.kind, Fields::Kind::angle_deg);
  EXPECT_NEAR(camera.lens().fields.values[1], 9.0902769208223, 1e-9);  // atan 0.16
}

TEST(MountedLens, MovesTheSensorAndNothingElse) {
  MountedLens camera(read_lens("double-gauss").lens);
  const double design = camera.lens().surfaces.back().thickness_mm;
  camera.move_sensor_mm(0.25);
  EXPECT_DOUBLE_EQ(camera.lens().surfaces.back().thickness_mm, design + 0.25);
  camera.move_sensor_mm(0.25);
  EXPECT_DOUBLE_EQ(camera.lens().surfaces.back().thickness_mm, design + 0.5);
  EXPECT_FALSE(camera.lens().object_distance_mm);
  camera.set_f_number(8);
  EXPECT_DOUBLE_EQ(camera.lens().surfaces.back().thickness_mm, design + 0.5);
  camera.set_image_distance_mm(70);
  EXPECT_DOUBLE_EQ(camera.lens().surfaces.back().thickness_mm, 70);
  EXPECT_THROW(camera.move_sensor_mm(-71), InputError);
  EXPECT_THROW(camera.set_image_distance_mm(0), InputError);
  EXPECT_THROW(camera.set_image_distance_mm(std::nan("")), InputError);
  EXPECT_THROW(camera.set_image_distance_mm(1.001e6), InputError);
  EXPECT_THROW(camera.move_sensor_mm(1e9), InputError);
  EXPECT_NO_THROW(camera.set_image_distance_mm(1e6));
}

TEST(MountedLens, MovingTheWholeLensKeepsObjectAndSensor) {
  MountedLens camera(read_lens("edmund-54852").lens);
  const double total = *camera.object_distance_from_sensor_m();
  const double object = *camera.lens().object_distance_mm, image = camera.lens().surfaces.back().thickness_mm;
  camera.move_lens_mm(0.1);
  EXPECT_NEAR(*camera.object_distance_from_sensor_m(), total, 1e-15);
  EXPECT_NEAR(*camera.lens().object_distance_mm, object - 0.1, 1e-12);
  EXPECT_NEAR(camera.lens().surfaces.back().thickness_mm, image + 0.1, 1e-12);
  EXPECT_THROW(camera.move_lens_mm(1e4), InputError);
  EXPECT_THROW(camera.move_lens_mm(-1e4), InputError);
}

TEST(MountedLens, AHelicoidFocusesAThinLensByNewtonsEquation) {
  // x x' = f²: an object at distance x in front of the front focus is sharp x' = f²/x behind the rear one.
  // Focused at infinity, the lens is moved towards an object until the paraxial image falls on the sensor.
  MountedLens camera(read_lens("double-gauss").lens);
  Lens near = camera.lens();
  near.object_distance_mm = 2000;
  const FirstOrder data = first_order(near);
  double low = 0, high = 50;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    MountedLens moved(near);
    moved.move_lens_mm(middle);
    const FirstOrder at = first_order(moved.lens());
    (at.paraxial_image_mm > moved.lens().surfaces.back().thickness_mm ? low : high) = middle;
  }
  // After the move the object is nearer by the move, and the sensor stands x' + (sensor − rear focus).
  const double x = 2000 - low + data.ffl_mm;
  EXPECT_NEAR(low, data.efl_mm * data.efl_mm / x - (near.surfaces.back().thickness_mm - data.bfl_mm), 1e-9);
}

// Flat to a thousandth of a wave over the pupil (25 mm: from 156 km on), and ten million focal lengths away.
TEST(MountedLens, TakesWhatIsFarAwayForInfinity) {
  MountedLens camera(thin_lens());
  for (const double distance_m : {1e3, 1e5, 4e5}) {
    camera.place_object_at_m(distance_m);
    EXPECT_NEAR(camera.object_distance_from_sensor_m().value_or(0), distance_m, 1e-9 * distance_m);
  }
  for (const double distance_m : {6e5, 1e9, 1e30}) {
    camera.place_object_at_m(distance_m);
    EXPECT_FALSE(camera.lens().object_distance_mm) << distance_m;
    camera.focus_at_m(distance_m);
    EXPECT_FALSE(camera.lens().object_distance_mm) << distance_m;
    EXPECT_NEAR(camera.lens().surfaces.back().thickness_mm, 50, 5e-6);
  }
  Lens lens = thin_lens();
  lens.object_distance_mm = 1e20;
  lens.fields = {Fields::Kind::object_height_mm, {0, 1e20}};
  const MountedLens far(lens);
  EXPECT_FALSE(far.lens().object_distance_mm);
  EXPECT_EQ(far.lens().fields.kind, Fields::Kind::angle_deg);
  EXPECT_NEAR(far.lens().fields.values[1], 45, 1e-9);
}

}  // namespace
}  // namespace petzval
