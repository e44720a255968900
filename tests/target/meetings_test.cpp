// SPDX-License-Identifier: BSD-3-Clause
// Polygons that meet, against looking at all pairs.
#include <gtest/gtest.h>
#include <petzval/target/meetings.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace petzval {
namespace {

bool is_inside(const Polygon& polygon, const Vertex& at) {
  bool inside = false;
  for (const Contour& contour : polygon.contours)
    for (std::size_t i = 0, j = contour.size() - 1; i < contour.size(); j = i++) {
      const Vertex &a = contour[i], &b = contour[j];
      if ((a.y > at.y) != (b.y > at.y) && at.x < a.x + (b.x - a.x) * (at.y - a.y) / (b.y - a.y))
        inside = !inside;
    }
  return inside;
}

bool cross(const Vertex& a, const Vertex& b, const Vertex& c, const Vertex& d) {
  const auto turn = [](const Vertex& p, const Vertex& q, const Vertex& r) {
    return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
  };
  return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

bool overlap(const Polygon& p, const Polygon& q) {
  for (const Contour& one : p.contours)
    for (std::size_t i = 0; i < one.size(); ++i) {
      if (is_inside(q, one[i])) return true;
      for (const Contour& other : q.contours)
        for (std::size_t j = 0; j < other.size(); ++j)
          if (is_inside(p, other[j]) ||
              cross(one[i], one[(i + 1) % one.size()], other[j], other[(j + 1) % other.size()]))
            return true;
    }
  return false;
}

TEST(Meetings, AreThosePairsThatOverlap) {
  // Rings and stars of all sizes, from a pixel to beyond the rest; no two corners coincide.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<Polygon> polygons;
  for (int i = 0; i < 90; ++i) {
    const Vertex centre{100 * share(random), 100 * share(random)};
    const double radius = std::pow(10, 2.2 * share(random));
    const int corners = 3 + static_cast<int>(6 * share(random));
    Polygon polygon{{regular_polygon(centre, radius, corners, 360 * share(random))}, 0, 0};
    if (i % 2 == 0)
      polygon.contours.push_back(regular_polygon(centre, 0.45 * radius, 40, 360 * share(random)));
    polygons.push_back(polygon);
  }
  const Meetings meetings(polygons, std::vector<bool>(polygons.size(), true));
  std::size_t met = 0, apart = 0;
  for (std::size_t i = 0; i < polygons.size(); ++i)
    for (std::size_t j = i + 1; j < polygons.size(); ++j) {
      const bool expected = overlap(polygons[i], polygons[j]);
      EXPECT_EQ(meetings.have_met(i, j), expected) << i << " " << j;
      EXPECT_EQ(meetings.have_met(j, i), expected);
      ++(expected ? met : apart);
    }
  EXPECT_GT(met, 200u);
  EXPECT_GT(apart, 200u);
}

TEST(Meetings, RingsWithinRingsDoNotMeetAndHalfPlanesDo) {
  std::vector<Polygon> polygons;
  for (int ring = 0; ring < 20; ++ring)
    polygons.push_back(
        {{regular_polygon({50, 50}, 2 * ring + 2, 300, 1), regular_polygon({50, 50}, 2 * ring + 1, 300, 2)},
         0,
         0});
  polygons.push_back({{half_plane({50, 50}, 10)}, 0, 0});
  const Meetings meetings(polygons, std::vector<bool>(polygons.size(), true));
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_TRUE(meetings.have_met(i, 20));
    for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(meetings.have_met(i, j));
  }
}

}  // namespace
}  // namespace petzval
