// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>
#include <petzval/simulate/camera.h>

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
