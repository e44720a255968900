// SPDX-License-Identifier: BSD-3-Clause
// Cameras as scenes name them: pbrt-v4's, and those of the CS348B assignment of 2006.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/lens/lens_file.h>
#include <petzval/render/camera/scene_camera.h>

#include "scene_text.h"

namespace petzval::render {
namespace {

SceneCamera camera_of(const std::string& text, const CameraChoice& choice = {}) {
  Unsupported unsupported;
  return set_up_camera(described("", text), choice, unsupported);
}

const std::string lens_path = std::string(PETZVAL_TEST_DATA) + "/../../data/lenses/dgauss-50mm.json";

TEST(SceneCamera, KnowsTheNamesOfTheAssignmentOf2006) {
  const SceneCamera camera =
      camera_of("Camera \"realistic\" \"string specfile\" \"" + lens_path +
                "\" \"float filmdistance\" 36.77 \"float aperture_diameter\" 8.5 \"float filmdiag\" 70 "
                "\"float hither\" 0.5 \"float yon\" 100\n"
                "Film \"image\" \"integer xresolution\" 30 \"integer yresolution\" 40\n");
  ASSERT_TRUE(camera.lens);
  EXPECT_EQ(camera.focus.film_distance_mm, 36.77);
  EXPECT_FALSE(camera.focus.distance_m);
  EXPECT_EQ(camera.lens->aperture.kind, Aperture::Kind::stop_semi_diameter_mm);
  EXPECT_EQ(camera.lens->aperture.value, 4.25);
  EXPECT_NEAR(2 * camera.film.half_diagonal_mm(), 70, 1e-9);
  EXPECT_EQ(camera.clipping.near, 0.5);
  EXPECT_EQ(camera.clipping.far, 100);
}

TEST(SceneCamera, TheUserHasTheLastWord) {
  const std::string text = "Camera \"realistic\" \"string lensfile\" \"" + lens_path +
                           "\" \"float filmdistance\" 36.77 \"float filmdiag\" 70\n";
  CameraChoice choice;
  choice.film_diagonal_mm = 43, choice.aperture_diameter_mm = 3;
  const SceneCamera set = camera_of(text, choice);
  EXPECT_EQ(set.lens->aperture.value, 1.5);
  EXPECT_NEAR(2 * set.film.half_diagonal_mm(), 43, 1e-9);
  CameraChoice sensor;
  sensor.sensor = read_sensor("320x200@6");
  EXPECT_EQ(camera_of(text, sensor).film.columns, 320);
  EXPECT_EQ(camera_of(text, sensor).film.pitch_um, 6);
}

TEST(SceneCamera, RefusesClippingBehindTheCamera) {
  EXPECT_THROW(camera_of("Camera \"perspective\" \"float hither\" -1\n"), InputError);
}

}  // namespace
}  // namespace petzval::render
