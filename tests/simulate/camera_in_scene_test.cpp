// SPDX-License-Identifier: BSD-3-Clause
// Where the camera stands, what it sees and what is sharp.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>
#include <petzval/simulate/framing.h>
#include <petzval/simulate/render_estimate.h>
#include <petzval/simulate/render_session.h>
#include <petzval/simulate/scene_depth.h>
#include <scratch.h>

#include <cmath>

namespace petzval {
namespace {

/// A wall at z = 2 with a hole, through which another is seen at z = 4, and a lamp.
constexpr const char* two_walls =
    "LookAt 0 0 -1  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 60\n"
    "Film \"rgb\" \"integer xresolution\" 80 \"integer yresolution\" 60 \"float diagonal\" 40\nWorldBegin\n"
    "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [ -2 -2 2  0 -2 2  -2 2 2  0 2 2 ]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [ -4 -4 4  4 -4 4  -4 4 4  4 4 4 ]\n";

struct TwoWalls {
  test::Scratch scratch;

  RenderRequest request() const {
    RenderRequest request{.scene = scratch.with("walls.pbrt", two_walls)};
    request.camera.lens = read_lens("dgauss-50mm").lens;
    request.camera.focus = Focus::at_m(3);
    request.wavelengths_nm = {500, 600};
    request.samples_per_pixel = 4;
    return request;
  }
};

Context noting(std::vector<std::string>& notes) {
  Context context;
  context.note = [&notes](const std::string& text) { notes.push_back(text); };
  return context;
}

TEST(CameraInScene, SeesDepthsAndFocusesOnWhatAPixelSees) {
  const TwoWalls walls;
  RenderRequest request = walls.request();
  PreparedScene scene = prepare_scene(request);
  // The film is at z = −1; left of the middle is the near wall.
  EXPECT_NEAR(depth_of_pixel_m(scene, {20, 30}), 3, 1e-3);
  EXPECT_NEAR(depth_of_pixel_m(scene, {60, 30}), 5, 1e-3);
  EXPECT_THROW(depth_of_pixel_m(scene, {80, 30}), InputError);
  for (const auto& [column, metres] : {std::pair{20.0, 3.0}, {60.0, 5.0}}) {
    request.focus_pixel = {column, 30.0};
    const PreparedScene by_pixel = prepare_scene(request);
    RenderRequest by_distance = walls.request();
    by_distance.camera.focus = Focus::at_m(metres);
    EXPECT_NEAR(by_pixel.film_distance_mm(), prepare_scene(by_distance).film_distance_mm(), 1e-4);
    EXPECT_NEAR(framing(by_pixel).distance_m, metres, 2e-3);
  }
}

TEST(CameraInScene, TellsOfTwoThingsInAZone) {
  EXPECT_FALSE(parted_depths({1, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7}, 0.2));  // one goes over into the next
  EXPECT_FALSE(parted_depths({1, 1, 1, 1, INFINITY, INFINITY}, 0.2));        // and nothing
  const auto parted = parted_depths({5, 1, 1, 5, 1, 5, INFINITY}, 0.2);
  ASSERT_TRUE(parted);
  EXPECT_EQ(parted->near_m, 1);
  EXPECT_EQ(parted->far_m, 5);
  // One odd pixel of twenty is nothing.
  std::vector<double> one_odd(20, 1.0);
  one_odd[3] = 5;
  EXPECT_FALSE(parted_depths(one_odd, 0.2));
}

TEST(CameraInScene, StandsWhereItIsPut) {
  const TwoWalls walls;
  RenderRequest request = walls.request();
  request.camera_at = {0.0, 0.0, 9.0};
  request.look_at = {0.0, 0.0, 4.0};
  // From behind, 5 m before the far wall.
  EXPECT_NEAR(depth_of_pixel_m(prepare_scene(request), {40, 30}), 5, 1e-3);
  request.look_at = request.camera_at;
  EXPECT_THROW(prepare_scene(request), InputError);
  request = walls.request();
  request.field_of_view_deg = 40;
  EXPECT_THROW(prepare_scene(request), InputError);  // the lens has its own
  request.camera = Camera();
  request.camera_at = {1.0, 0.0, -1.0};
  // A pinhole 40 degrees wide: the wall's edge at x = 0, 3 m away and 1 m to the left, is 1/3 from the
  // middle, of tan 20° to the edge of 40 pixels.
  const PreparedScene pinhole = prepare_scene(request);
  const double edge = 40 - 40 * (1.0 / 3) / std::tan(radians(20));
  RenderRequest looking = request;
  looking.look_at = {1.0, 0.0, 4.0};
  const PreparedScene ahead = prepare_scene(looking);
  EXPECT_NEAR(depth_of_pixel_m(ahead, {std::floor(edge) - 1, 30}), 3, 1e-3);
  EXPECT_NEAR(depth_of_pixel_m(ahead, {std::ceil(edge) + 1, 30}), 5, 1e-3);
}

TEST(CameraInScene, SaysThatAPlaceIsTooFarAway) {
  const TwoWalls walls;
  const auto refusal = [](const RenderRequest& request) {
    try {
      prepare_scene(request);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  RenderRequest request = walls.request();
  request.camera_at = {0.0, 0.0, -1e7};
  EXPECT_EQ(refusal(request), "");
  for (const double far : {1e9, 1e300}) {
    request.camera_at = {0.0, 0.0, -far};
    EXPECT_NE(refusal(request).find("too far away"), std::string::npos) << refusal(request);
    RenderRequest moving = walls.request();
    moving.look_move = {far, 0.0, 0.0};
    moving.camera_move = {far, 0.0, 0.0};
    EXPECT_NE(refusal(moving).find("`look_move`"), std::string::npos) << refusal(moving);
  }
}

TEST(CameraInScene, StandsBackWhereTheSceneHasNoCamera) {
  const test::Scratch scratch;
  // A square of 2 × 2 about (5, 0, 0).
  const std::string gltf = scratch.with(
      "square.gltf",
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"translation":[5,0,0]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[-1,-1,0],"max":[1,1,0]}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAACAPwAAgD8AAAAA"}]})");
  RenderRequest request{.scene = gltf};
  request.wavelengths_nm = {550};
  std::vector<std::string> notes;
  const PreparedScene pinhole = prepare_scene(request, noting(notes));
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("`camera_at`"), std::string::npos);
  // The ball about it, √2 in radius, fills the 40 degrees of the shorter side.
  const double distance = std::sqrt(2) / std::sin(radians(20));
  EXPECT_NEAR(depth_of_pixel_m(pinhole, {pinhole.film.columns / 2.0 + 1, pinhole.film.rows / 2.0 + 1}),
              distance, 1e-3);
  // Through a lens of a narrower view it stands farther away.
  request.camera.lens = read_lens("dgauss-50mm").lens;
  const PreparedScene lens = prepare_scene(request);
  const double half = std::min(framing(lens).view.height, framing(lens).view.width) / 2;
  EXPECT_NEAR(depth_of_pixel_m(lens, {lens.film.columns / 2.0 + 1, lens.film.rows / 2.0 + 1}),
              std::sqrt(2) / std::sin(radians(half)), 0.01);
}

TEST(Framing, AgreesWithTheThinLensWhereThatHolds) {
  const TwoWalls walls;
  RenderRequest request = walls.request();
  request.camera.f_number = 8;
  const PreparedScene scene = prepare_scene(request);
  const Framing seen = framing(scene);
  EXPECT_NEAR(seen.distance_m, 3, 1e-6);
  EXPECT_NEAR(seen.film_width_mm, 32, 1e-9);
  // 2 atan(w/2s') with s' = f/(1 − f/d), to the distortion of a lens that is no pinhole.
  const double f_m = seen.efl_mm / 1000, image_mm = seen.efl_mm / (1 - f_m / (3 - f_m));
  EXPECT_NEAR(seen.view.width, 2 * degrees(std::atan(16 / image_mm)), 0.02 * seen.view.width);
  // Depth of field for a blur of one pixel of 0.4 mm, from the hyperfocal distance H = f²/(N c): d H/(H ± d).
  const double hyperfocal_m = f_m * seen.efl_mm / (8 * 0.4);
  EXPECT_NEAR(seen.sharp.near_m, hyperfocal_m * 3 / (hyperfocal_m + 3), 0.1);
  EXPECT_TRUE(std::isinf(seen.sharp.far_m));
  EXPECT_NEAR(seen.lit_circle_mm, 40, 0.5);
  EXPECT_FALSE(lights_too_little(seen));
  request = walls.request();
  request.camera.lens = read_lens("inverse-telephoto").lens;
  EXPECT_TRUE(lights_too_little(framing(prepare_scene(request))));
}

TEST(RenderSession, GivesTheBytesOfScenesThatAreReadAnew) {
  const TwoWalls walls;
  RenderSession session;
  RenderRequest request = walls.request();
  request.columns = 16, request.rows = 12;
  std::shared_ptr<const PreparedWorld> last;
  for (const double metres : {1.0, 3.0}) {
    request.camera.focus = Focus::at_m(metres);
    request.camera_at = {0.0, 0.0, -metres};
    const PreparedScene kept = session.prepare(request);
    const Rendering with = render_scene(kept), without = render_scene(prepare_scene(request));
    EXPECT_TRUE(std::ranges::equal(with.irradiance.values(), without.irradiance.values()));
  }
  request.wavelengths_nm = {450};
  EXPECT_EQ(render_scene(session.prepare(request)).irradiance.wavelengths_nm(), std::vector<double>{450});
}

TEST(RenderEstimate, CountsSamplesAndMemory) {
  const TwoWalls walls;
  RenderRequest request = walls.request();
  request.samples_per_pixel = 64;
  const RenderEstimate fixed = estimate_render(prepare_scene(request));
  EXPECT_EQ(fixed.samples_per_pixel, 64);
  EXPECT_GT(fixed.seconds, 0);
  EXPECT_GE(fixed.memory_bytes, 80 * 60 * 2 * sizeof(double));
  request.samples_per_pixel.reset();
  request.noise = 0.05;
  // Noise falls with the root of the number of samples.
  const RenderEstimate coarse = estimate_render(prepare_scene(request));
  request.noise = 0.025;
  const RenderEstimate fine = estimate_render(prepare_scene(request));
  EXPECT_NEAR(fine.samples_per_pixel / static_cast<double>(coarse.samples_per_pixel), 4, 0.5);
  // More than a whole number holds: as many as are taken at most.
  request.noise = 1e-9;
  EXPECT_EQ(estimate_render(prepare_scene(request)).samples_per_pixel, 4096);
}

}  // namespace
}  // namespace petzval
