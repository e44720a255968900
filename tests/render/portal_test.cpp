// SPDX-License-Identifier: BSD-3-Clause
// Skies behind a portal against the solid angle of a rectangle, and against the same room without a portal.
#include <gtest/gtest.h>
#include <petzval/base/scratch_folder.h>
#include <petzval/base/units.h>

#include <fstream>
#include <numeric>

#include "media_scenes.h"

namespace petzval::render {
namespace {

TEST(WindowedDistribution, DrawsWindowsByTheirWeight) {
  constexpr int side = 8, samples = 1 << 14;
  std::vector<double> weights;
  for (int i = 0; i < side * side; ++i) weights.push_back(i % 7 == 3 ? 0 : 0.2 + (i * 5) % 9);
  const WindowedDistribution map(weights, side);
  EXPECT_NEAR(map.integral({{0, 0}, {1, 1}}), std::accumulate(weights.begin(), weights.end(), 0.0) / 64,
              1e-12);
  EXPECT_NEAR(map.integral({{0.26, 0.51}, {0.3, 0.6}}), 0.04 * 0.09 * map.weight(0.28, 0.55), 1e-12);
  for (const SquareWindow& window : {SquareWindow{{0, 0}, {1, 1}},
                                     {{0.11, 0.3}, {0.83, 0.97}},
                                     {{0.26, 0.51}, {0.3, 0.6}},
                                     {{0.5, 0.25}, {0.75, 0.5}}}) {
    // Parts of the window.
    std::array<double, 16> found{};
    const auto at = [&](std::size_t axis, double share) {
      return window.low[axis] + share * (window.high[axis] - window.low[axis]);
    };
    for (std::uint32_t i = 0; i < samples; ++i) {
      const auto [u, v] = SobolSample(3, i).next2();
      const auto point = map.sample(window, u, v);
      const double x = (point.u - window.low[0]) / (window.high[0] - window.low[0]),
                   y = (point.v - window.low[1]) / (window.high[1] - window.low[1]);
      ASSERT_TRUE(x >= -1e-9 && x <= 1 + 1e-9 && y >= -1e-9 && y <= 1 + 1e-9);
      const auto part = [](double share) {
        return static_cast<std::size_t>(std::clamp(share * 4, 0.0, 3.0));
      };
      found[4 * part(y) + part(x)] += 1.0 / samples;
    }
    for (std::size_t i = 0; i < 16; ++i) {
      const double x = static_cast<double>(i % 4), y = static_cast<double>(i / 4);
      const double share =
          map.integral({{at(0, x / 4), at(1, y / 4)}, {at(0, (x + 1) / 4), at(1, (y + 1) / 4)}}) /
          map.integral(window);
      EXPECT_NEAR(found[i], share, 4.5 * std::sqrt(share / samples) + 1e-9) << i;
    }
  }
}

/// Of a rectangle at this height above a point, from its corner at the foot (closed form).
double rectangle_angle(double x, double y, double h) {
  return std::atan(x * y / (h * std::sqrt(x * x + y * y + h * h)));
}

TEST(Portal, DirectionsFillItByWhatIsSeenThere) {
  // x is the world's y, y is its z, and the sky lies towards +x.
  Portal portal({Vector3{2, 1, -1}, {2, 1, 1}, {2, 2, 1}, {2, 2, -1}});
  const auto luminance = [](Vector3 d) { return 1 + d.y + 0.5 * d.z * d.z; };
  portal.rectify(256, luminance, {});
  constexpr int samples = 1 << 14;
  for (const Vector3 from : {Vector3{0, 0, 0}, {1.9, 1.5, 0}, {-20, 7, 3}, {1.5, 5, -4}}) {
    double angle = 0, light = 0, squares = 0;
    for (std::uint32_t i = 0; i < samples; ++i) {
      const auto [u, v] = SobolSample(4, i).next2();
      const Portal::Sample each = portal.sample(from, u, v);
      ASSERT_GT(each.pdf, 0);
      ASSERT_NEAR(length(each.direction), 1, 1e-12);
      ASSERT_TRUE(portal.lets_out(from, each.direction));
      angle += 1 / each.pdf / samples, squares += 1 / (each.pdf * each.pdf) / samples;
      light += luminance(each.direction) / each.pdf / samples;
    }
    const double h = 2 - from.x, left = 1 - from.y, right = 2 - from.y, near = -1 - from.z, far = 1 - from.z;
    const double expected = rectangle_angle(right, far, h) - rectangle_angle(left, far, h) -
                            rectangle_angle(right, near, h) + rectangle_angle(left, near, h);
    EXPECT_NEAR(angle, expected, 4.5 * std::sqrt(std::max(0.0, squares - angle * angle) / samples) + 1e-6);
    EXPECT_NEAR(portal.fluence(from), light, 0.01 * light);
  }
  EXPECT_EQ(portal.sample({2.5, 1.5, 0}, 0.5, 0.5).pdf, 0);  // beyond it
  EXPECT_FALSE(portal.lets_out({2.5, 1.5, 0}, {1, 0, 0}));
  EXPECT_FALSE(portal.lets_out({0, 0, 0}, {-1, 0, 0}));
  EXPECT_FALSE(portal.lets_out({0, 0, 0}, {1, 0, 0}));
  EXPECT_EQ(portal.pdf({0, 0, 0}, {1, 0, 0}), 0);
  EXPECT_EQ(portal.irradiance({0, 0, 0}, {-1, 0, 0}, false), 0);
  EXPECT_GT(portal.irradiance({0, 0, 0}, {-1, 0, 0}, true), 0);
}

class PortalLight : public testing::Test {
 protected:
  /// Dim all around, bright in one direction that the window shows.
  std::string sky(const std::string& portal) {
    const std::string path = folder_.path() + "/sky.hdr";
    constexpr int side = 32;
    std::ofstream file(path, std::ios::binary);
    file << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " << side << " +X " << side << "\n";
    for (int row = 0; row < side; ++row)
      for (int column = 0; column < side; ++column) {
        const Vector3 to = sphere_from_square((column + 0.5) / side, (row + 0.5) / side);
        const bool bright = dot(to, normalised({1, 0.35, 0.1})) > 0.97;
        file << "\x80\x80\x80" << (bright ? '\x86' : '\x81');
      }
    return "LightSource \"infinite\" \"string filename\" \"" + path + "\" " + portal + "\n";
  }
  ScratchFolder folder_;
};

std::string side_of_room(Vector3 p, Vector3 a, Vector3 b) {
  std::string text = "Shape \"bilinearmesh\" \"point3 P\" [";
  for (const Vector3 corner : {p, p + a, p + b, p + a + b})
    for (const double each : {corner.x, corner.y, corner.z}) text += " " + std::to_string(each);
  return text + " ]\n";
}

/// 4 wide and deep, 3 high, with a window in its wall at x = 2.
std::string room_with_window() {
  const Vector3 x{4, 0, 0}, y{0, 3, 0}, z{0, 0, 4}, corner{-2, 0, -2};
  return "Material \"diffuse\" \"spectrum reflectance\" [ 300 .6 900 .6 ]\n" + side_of_room(corner, x, z) +
         side_of_room(corner + y, x, z) + side_of_room(corner, y, z) + side_of_room(corner, x, y) +
         side_of_room(corner + z, x, y) + side_of_room({2, 0, -2}, {0, 1, 0}, z) +
         side_of_room({2, 2, -2}, {0, 1, 0}, z) + side_of_room({2, 1, -2}, {0, 1, 0}, {0, 0, 1}) +
         side_of_room({2, 1, 1}, {0, 1, 0}, {0, 0, 1});
}
const char* const portal_of_room = "\"point3 portal\" [ 2 1 -1  2 1 1  2 2 1  2 2 -1 ]";

TEST_F(PortalLight, IsThatOfTheWindowWithLessNoise) {
  const auto open = world_of(sky("") + room_with_window()),
             portal = world_of(sky(portal_of_room) + room_with_window());
  constexpr int samples = 1 << 14;
  for (const Vector3 along : {Vector3{0.3, -1, 0.2}, {-1, 0.1, 0.1}, {0.2, 1, 0}}) {
    const Estimate expected = seen(*open, {-0.5, 1.5, 0}, along, samples, PathOptions::Lights::both, 3);
    for (const auto lights :
         {PathOptions::Lights::both, PathOptions::Lights::by_chance, PathOptions::Lights::sampled}) {
      const Estimate found = seen(*portal, {-0.5, 1.5, 0}, along, samples, lights, 3);
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(found.mean[i], expected.mean[i],
                    4.5 * std::hypot(found.deviation[i], expected.deviation[i]))
            << i;
      if (lights == PathOptions::Lights::both) {
        EXPECT_LT(found.deviation[1], 0.8 * expected.deviation[1]);
      }
    }
  }
}

TEST_F(PortalLight, IsSeenThroughItOnly) {
  const auto world = world_of(sky(portal_of_room));
  const auto open = world_of(sky(""));
  const auto light = [](const World& of, Vector3 from, Vector3 along) {
    return seen(of, from, along, 1).mean[1];
  };
  const Vector3 bright{1, 0.35, 0.1};
  EXPECT_EQ(light(*world, {0, 1, 0}, bright), light(*open, {0, 1, 0}, bright));
  EXPECT_EQ(light(*world, {0, 0, 0}, bright), 0);  // passes below
  EXPECT_EQ(light(*world, {3, 1, 0}, bright), 0);  // beyond
  EXPECT_EQ(light(*world, {0, 1, 0}, {-1, 0, 0}), 0);
  const auto even =
      world_of("LightSource \"infinite\" \"spectrum L\" [ 300 2 900 2 ] " + std::string(portal_of_room));
  EXPECT_EQ(light(*even, {0, 1, 0}, bright), 2);
  EXPECT_EQ(light(*even, {0, 0, 0}, bright), 0);
}

TEST_F(PortalLight, RefusesWhatIsNoRectangle) {
  const auto with = [](const std::string& corners) {
    return media_message("LightSource \"infinite\"\n\"point3 portal\" [ " + corners + " ]");
  };
  EXPECT_EQ(with("0 0 0 1 0 0 1 1 0"), "test.pbrt:4:1: 9 numbers; four corners of three would be right");
  for (const char* corners : {"0 0 0 1 0 0 1 1 0 0 2 0", "0 0 0 1 0 0 2 1 0 1 1 0", "0 0 0 0 0 0 1 1 0 1 1 0",
                              "0 0 0 1 0 0 1 1 1 0 1 0"})
    EXPECT_EQ(with(corners),
              "test.pbrt:4:1: these corners are no rectangle; four of one in turn would be right");
  EXPECT_EQ(with("0 0 0 1 0 0 1 1 0 0 1 0"), "nothing");
}

}  // namespace
}  // namespace petzval::render
