// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/lens/lens_file.h>
#include <petzval/optics/build.h>
#include <petzval/simulate/imaging_memory.h>
#include <petzval/simulate/imaging_session.h>

#include <algorithm>

namespace petzval {
namespace {

Camera session_camera() {
  Camera camera;
  camera.lens = read_lens("dgauss-50mm").lens;
  camera.sensor = read_sensor("48x36@200");
  return camera;
}

SceneRequest session_request(const char* name = "studio") {
  return {.name = name, .options = {.columns = 96, .rows = 72, .wavelengths_nm = {500, 600}}};
}

/// Cameras as somebody turns them: gaps, a stop, a distance, a sensor of other pixels, and back.
std::vector<Camera> turned_cameras() {
  std::vector<Camera> cameras(6, session_camera());
  cameras[1].lens.surfaces[3].thickness_mm *= 1.01;
  cameras[2].f_number = 4;
  cameras[3].focus = Focus::at_m(2);
  cameras[4].sensor = read_sensor("40x40@240");
  return cameras;
}

void expect_same_bytes(const SpectralImage& a, const SpectralImage& b) {
  EXPECT_EQ(a.columns(), b.columns());
  EXPECT_TRUE(std::ranges::equal(a.values(), b.values()));
  EXPECT_EQ(a.provenance, b.provenance);
}

TEST(ImagingSession, HasTheBytesOfOneImageAfterTheOther) {
  const SceneRequest request = session_request();
  ImagingSession session(request);
  for (const Camera& camera : turned_cameras())
    expect_same_bytes(session.image(camera), image(request, camera));
}

TEST(ImagingSession, HasThemOfSkiesThatAreDrawnToTheirAngle) {
  SceneRequest request{.name = "stars", .options = {.wavelengths_nm = {550}}};
  ImagingSession session(request);
  for (const Camera& camera : turned_cameras())
    expect_same_bytes(session.image(camera), image(request, camera));
}

TEST(ImagingSession, HasThemOfScenesWithDepth) {
  SceneRequest request = session_request("cards");
  request.options.wavelengths_nm = {550};
  ImagingSession session(request);
  for (const double gap : {1.0, 1.002}) {
    Camera camera = session_camera();
    camera.lens.surfaces[3].thickness_mm *= gap;
    expect_same_bytes(session.image(camera), image(request, camera));
  }
}

TEST(ImagingSession, DoesOnlyWhatAnAlterationAsksFor) {
  ImagingSession session(session_request());
  Camera camera = session_camera();
  session.image(camera);
  session.image(camera);
  EXPECT_EQ(session.work().images_formed, 1);
  camera.sensor->name = "another";  // nothing to light
  session.image(camera);
  EXPECT_EQ(session.work().images_formed, 1);
  camera.sensor->photosite.width = 0.5;
  session.image(camera);
  EXPECT_EQ(session.work().images_formed, 2);
  EXPECT_EQ(session.work().tables_made, 1);
  camera.lens.surfaces[3].thickness_mm *= 1.01;
  session.image(camera);
  EXPECT_EQ(session.work().images_formed, 3);
  EXPECT_EQ(session.work().tables_made, 2);
  EXPECT_EQ(session.work().scenes_read, 1);
}

TEST(ImagingMemory, KnowsTheDetailOfTheSceneBehindTheNextLens) {
  ImagingMemory memory;
  Camera camera = session_camera();
  for (const double gap : {1.0, 1.0001, 1.0001}) {
    camera.lens.surfaces[3].thickness_mm *= gap;
    ImagePlan plan = plan_image(session_request(), camera, {}, {}, memory);
    ASSERT_NE(plan.memory, nullptr);
    image(plan);
    EXPECT_EQ(plan.memory->detail.looks(), 1);
    memory.give_back(plan);
  }
}

TEST(ImagingSession, TellsItsNotesEachTime) {
  SceneRequest request = session_request();
  request.options.horizontal_angle_deg = 30;
  Camera camera = session_camera();
  camera.sensor.reset();
  ImagingSession session(request);
  for (int round = 0; round < 2; ++round) {
    std::vector<std::string> kept, alone;
    Context context;
    context.note = [&](const std::string& text) { kept.push_back(text); };
    session.image(camera, context);
    context.note = [&](const std::string& text) { alone.push_back(text); };
    image(request, camera, {}, context);
    EXPECT_FALSE(alone.empty());
    EXPECT_EQ(kept, alone);
  }
}

TEST(ImagingSession, GoesOnAfterItWasStopped) {
  const SceneRequest request = session_request();
  ImagingSession session(request);
  Camera camera = session_camera();
  session.image(camera);
  camera.f_number = 2.8;
  for (int calls : {1, 20, 60}) {
    Context context;
    context.progress = [&](double, const std::string&) { return --calls > 0; };
    try {
      session.image(camera, context);
    } catch (const Cancelled&) {
    }
  }
  expect_same_bytes(session.image(camera), image(request, camera));
}

TEST(ImagingSession, TakesTablesAndScenesInMemory) {
  SceneRequest request = session_request();
  request.options.horizontal_angle_deg = 30;
  const Scene scene = read_scene(request.name, request.options);
  ImagingSession session(scene);
  const ImagePlan plan = plan_image(request, session_camera());
  const TableCamera table{plan.table, session_camera().sensor};
  const SpectralImage alone = image(scene, table);
  expect_same_bytes(session.image(table), alone);
  expect_same_bytes(session.image(table), alone);
}

}  // namespace
}  // namespace petzval
