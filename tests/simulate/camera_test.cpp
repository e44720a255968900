// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/analysis/best_focus.h>
#include <petzval/base/error.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>
#include <petzval/simulate/mounting.h>

namespace petzval {
namespace {

Camera camera(const char* lens) {
  Camera camera;
  camera.lens = read_lens(lens).lens;
  return camera;
}

// Newton's equation for the lens as a whole: x x' = f², x from the front focus, x' from the rear one.
TEST(Camera, FocusesByNewtonsEquation) {
  Camera near = camera("dgauss-50mm"), far = near;
  far.focus = Focus::infinity();
  near.focus = Focus::at_m(1.2);
  const Lens lens = lens_in_use(near), at_infinity = lens_in_use(far);
  const FirstOrder first = first_order(at_infinity);
  const double shift_mm = lens.surfaces.back().thickness_mm - at_infinity.surfaces.back().thickness_mm;
  // ffl_mm is the front focus from vertex 1, negative in front of it.
  const double from_front_focus_mm = *lens.object_distance_mm + first.ffl_mm;
  EXPECT_NEAR(shift_mm * from_front_focus_mm, first.efl_mm * first.efl_mm,
              1e-6 * first.efl_mm * first.efl_mm);
}

TEST(Camera, StopsDownToTheNumberAskedFor) {
  Camera stopped = camera("dgauss-50mm");
  stopped.f_number = 8;
  EXPECT_NEAR(first_order(lens_in_use(stopped)).f_number, 8, 1e-9);
  stopped.f_number = 0.5;
  EXPECT_THROW(lens_in_use(stopped), InputError);
}

TEST(Camera, PlacesTheSensorOnce) {
  Camera placed = camera("dgauss-50mm");
  placed.image_distance_mm = 40;
  EXPECT_EQ(lens_in_use(placed).surfaces.back().thickness_mm, 40);
  placed.focus = Focus::infinity();
  EXPECT_THROW(lens_in_use(placed), InputError);
}

TEST(Camera, BestSpotSaysHowFarTheSensorMoves) {
  Camera sharp = camera("cooke-triplet");
  sharp.focus = Focus::parse("best-spot");
  std::vector<std::string> notes;
  Context context;
  context.note = [&](const std::string& text) { notes.push_back(text); };
  const Lens lens = lens_in_use(sharp, context);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes.front().find("`focus` best-spot moves the sensor by"), std::string::npos) << notes.front();
  EXPECT_NE(lens.surfaces.back().thickness_mm, sharp.lens.surfaces.back().thickness_mm);
}

std::vector<std::string> notes_of(const Camera& used, const FieldTableRequest& at, Lens& lens) {
  std::vector<std::string> notes;
  Context context;
  context.note = [&](const std::string& text) { notes.push_back(text); };
  lens = focus(mounted_lens(used, context), used.focus, at, context);
  return notes;
}

// By first_order(): the paraxial image of the same object at two wavelengths.
TEST(Camera, FocusesWithTheLightInUse) {
  Camera used = camera("double-gauss");
  used.focus = Focus::at_m(3);
  FieldTableRequest at = FieldTableRequest::of(used.lens);
  Lens visible, infrared;
  EXPECT_TRUE(notes_of(used, at, visible).empty());
  at.wavelengths_nm = {840, 850, 860};
  const std::vector<std::string> notes = notes_of(used, at, infrared);
  const double shift_mm = infrared.surfaces.back().thickness_mm - visible.surfaces.back().thickness_mm;
  Lens same_object = visible;
  same_object.object_distance_mm = infrared.object_distance_mm;
  EXPECT_NEAR(shift_mm,
              first_order(same_object, 850).paraxial_image_mm - first_order(visible).paraxial_image_mm, 1e-6);
  EXPECT_GT(shift_mm, 0.1) << "the lens is corrected for visible light";
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("850 nm"), std::string::npos) << notes[0];
  used.focus_wavelength_nm = used.lens.reference_wavelength_nm;
  EXPECT_TRUE(notes_of(used, at, infrared).empty());
  EXPECT_EQ(infrared.surfaces.back().thickness_mm, visible.surfaces.back().thickness_mm);
}

TEST(Camera, SeeksTheBestFocusOfAnObjectAtADistance) {
  Camera used = camera("cooke-triplet");
  used.focus = Focus::parse("2m+paraxial");
  const Lens paraxial = lens_in_use(used);
  EXPECT_NEAR(paraxial.surfaces.back().thickness_mm, first_order(paraxial).paraxial_image_mm, 1e-9);
  used.focus = Focus::parse("2m+best-spot");
  used.defocus_mm = 0.05;
  const Lens best = lens_in_use(used);
  EXPECT_EQ(best.object_distance_mm, paraxial.object_distance_mm);
  const double here = best_spot_focus(best, FieldTableRequest::of(best)).shift_mm;
  EXPECT_NEAR(here, -0.05, 1e-6) << "the least spot lies where the sensor was before it was moved";
}

TEST(Camera, TellsOfMissingAperturesUnlessTheyAreIgnored) {
  Camera open = camera("dgauss-50mm");
  for (Surface& surface : open.lens.surfaces)
    if (!surface.stop) surface.semi_diameter_mm.reset();
  int notes = 0;
  Context context;
  context.note = [&](const std::string&) { ++notes; };
  lens_in_use(open, context);
  EXPECT_EQ(notes, 1);
  open.apertures = Camera::Apertures::ignored;
  lens_in_use(open, context);
  EXPECT_EQ(notes, 1);
  open.apertures = Camera::Apertures::from_fields;
  const Lens solved = lens_in_use(open, context);
  EXPECT_EQ(notes, 1);
  for (const Surface& surface : solved.surfaces) EXPECT_TRUE(surface.stop || surface.semi_diameter_mm);
}

}  // namespace
}  // namespace petzval
