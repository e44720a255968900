// SPDX-License-Identifier: BSD-3-Clause
// Poses of surfaces, groups and the sensor: where things come to stand, in files, in settings, and what is
// refused.
#include <petzval/lens/pose.h>
#include <petzval/lens/scaled_lens.h>

#include "sample_lenses.h"

namespace petzval {
namespace {

using namespace testing;

Lens triplet_of_poses() {
  return read_lens("cooke-triplet").lens;
}

Lens triplet_set(const std::string& assignment) {
  return with_setting(triplet_of_poses(), assignment);
}

std::string complaint(const std::string& assignment) {
  return error_of([&] { triplet_set(assignment); });
}

void expect_vector(const Frame::Vector& value, const Frame::Vector& expected) {
  for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(value[a], expected[a], 1e-15) << a;
}

TEST(Pose, TiltsAreRightHanded) {
  Lens lens = triplet_of_poses();
  lens.surfaces[1].pose.tilt_x_deg = 30;
  expect_vector(frames_of(lens)[1].to_lens({0, 1, 0}), {0, std::sqrt(0.75), 0.5});
  lens.surfaces[1].pose = {0, 0, 0, 0, 30, 0};
  expect_vector(frames_of(lens)[1].to_lens({0, 0, 1}), {0.5, 0, std::sqrt(0.75)});
  lens.surfaces[1].pose = {0, 0, 0, 0, 0, 30};
  expect_vector(frames_of(lens)[1].to_lens({1, 0, 0}), {std::sqrt(0.75), 0.5, 0});
}

TEST(Pose, LaterTurnsAreAboutAxesThatHaveTurnedAlong) {
  // Tilted by 30° about x, then by 45° about the y axis that this has tilted: the normal is first (0, −s, c)
  // of 30°, then turned towards x, which has stayed.
  Lens lens = triplet_of_poses();
  lens.surfaces[2].pose = {0, 0, 0, 30, 45, 0};
  const double half = std::sqrt(0.5);
  expect_vector(frames_of(lens)[2].to_lens({0, 0, 1}), {half, -0.5 * half, std::sqrt(0.75) * half});
}

TEST(Pose, AGroupTurnsAboutItsPivot) {
  // A barrel of two surfaces 3 mm apart, tilted about a point 1 mm behind the first vertex.
  Lens lens = triplet_of_poses();
  lens.surfaces[2].thickness_mm = 3;
  lens.groups = {{2, 3, {0.1, 0, 0, 30, 0, 0}, 1}};
  const std::vector<Frame> frames = frames_of(lens);
  EXPECT_TRUE(frames[1].is_none());
  EXPECT_TRUE(frames[4].is_none());
  expect_vector(frames[2].offset_mm, {0.1, 0.5, 1 - std::sqrt(0.75)});
  expect_vector(frames[3].offset_mm, {0.1, -1, 2 * std::sqrt(0.75) - 2});
}

TEST(Pose, LaterGroupsCarryEarlierOnes) {
  // An element decentred in a barrel that is turned by 90° about its axis: it comes out decentred the other
  // way.
  Lens lens = triplet_of_poses();
  lens.groups = {{2, 3, {0.1, 0, 0, 0, 0, 0}, 0}, {0, 5, {0, 0, 0, 0, 0, 90}, 0}};
  expect_vector(frames_of(lens)[2].offset_mm, {0, 0.1, 0});
  std::swap(lens.groups[0], lens.groups[1]);
  expect_vector(frames_of(lens)[2].offset_mm, {0.1, 0, 0});
}

TEST(Pose, GroupsMayTakeTheSensorAlong) {
  Lens lens = triplet_of_poses();
  lens.groups = {{5, lens.surfaces.size(), {0, 0.2, 0, 0, 0, 0}, 0}};
  EXPECT_EQ(frames_of(lens).back().offset_mm[1], 0.2);
}

TEST(Pose, TurnsBackWhatItTurned) {
  Lens lens = triplet_of_poses();
  lens.surfaces[0].pose = {0.1, 0.2, 0.3, 10, -20, 30};
  const Frame frame = frames_of(lens)[0];
  const Frame::Vector v{0.3, -0.5, 0.8};
  expect_vector(frame.from_lens(frame.to_lens(v)), v);
  expect_vector(frame.point_from_lens(frame.point_to_lens(v, 0.25), 0.25), v);
  expect_vector(frame.point_to_lens({0, 0, 0.25}, 0.25), {0.1, 0.2, 0.55});
}

TEST(Pose, IsReachedBySettings) {
  const Lens lens = triplet_set("surfaces[3].pose.tilt_x_deg=0.2");
  EXPECT_EQ(lens.surfaces[3].pose.tilt_x_deg, 0.2);
  EXPECT_TRUE(has_poses(lens));
  EXPECT_FALSE(has_poses(with_setting(lens, "surfaces[3].pose=null")));
  EXPECT_EQ(triplet_set("sensor_pose.tilt_y_deg=-1").sensor_pose.tilt_y_deg, -1);
  const Lens grouped =
      triplet_set(R"(groups=[{"surfaces": [2, 3], "pose": {"decentre_y_mm": 0.1}, "pivot_mm": 0.5}])");
  ASSERT_EQ(grouped.groups.size(), 1u);
  EXPECT_EQ(grouped.groups[0].pose.decentre_y_mm, 0.1);
  EXPECT_EQ(with_setting(grouped, "groups[0].pose.tilt_x_deg=1").groups[0].pose.tilt_x_deg, 1);
  EXPECT_FALSE(has_poses(as_designed(grouped)));
}

TEST(Pose, SaysWhatWouldBeRight) {
  expect_mentions(complaint("surfaces[3].pose.tilt_deg=1"), {"surfaces[3].pose.tilt_deg", "tilt_x_deg"});
  expect_mentions(complaint("surfaces[3].pose.tilt_x_deg=61"),
                  {"surfaces[3].pose.tilt_x_deg", "within 60 degrees"});
  expect_mentions(complaint("surfaces[3].pose.tilt_x_deg=one"), {"tilt_x_deg", "an angle in degrees"});
  expect_mentions(complaint("surfaces[3].pose=5"), {"surfaces[3].pose"});
  expect_mentions(complaint(R"(groups=[{"surfaces": [3]}])"), {"groups[0].surfaces", "[2, 3]"});
  expect_mentions(complaint(R"(groups=[{"surfaces": [3, 99]}])"), {"groups[0].surfaces", "for the sensor"});
  expect_mentions(complaint(R"(groups=[{"surfaces": [3, 2]}])"), {"groups[0].surfaces"});
  expect_mentions(complaint(R"(groups=[{"surfaces": [1.5, 2]}])"), {"groups[0].surfaces[0]", "from 0"});
  expect_mentions(complaint(R"(groups=[{"pose": {}}])"), {"groups[0]", "surfaces"});
  expect_mentions(complaint("sensor_pose.decentre_x_mm=1e999"), {"1e999"});
}

TEST(Pose, OtherFormatsAreRefused) {
  const Lens lens = triplet_set("surfaces[3].pose.tilt_x_deg=0.2");
  expect_mentions(error_of([&] { write_lens(lens, "posed.dat"); }), {"surfaces[3].pose", ".json"});
}

TEST(Pose, ScalesWithTheLens) {
  Lens lens = triplet_set("surfaces[3].pose.decentre_x_mm=0.2");
  lens.surfaces[3].pose.tilt_x_deg = 0.5;
  const Lens twice = scaled_lens(lens, 2);
  EXPECT_EQ(twice.surfaces[3].pose.decentre_x_mm, 0.4);
  EXPECT_EQ(twice.surfaces[3].pose.tilt_x_deg, 0.5);
}

}  // namespace
}  // namespace petzval
