// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/target/crossings.h>
#include <petzval/target/polygon.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

void require_size(double value, const char* what) {
  if (!(value > 0 && value <= target_reach_px))
    throw InputError(
        fmt::format("a {} of {} pixels: above 0 and up to {:g} is right", what, value, target_reach_px));
}

class PolygonCheck {
 public:
  PolygonCheck(const TargetScene& scene, std::size_t index) : scene_(scene), index_(index) {}

  void run() const {
    const Polygon& polygon = scene_.polygons[index_];
    if (!std::isfinite(polygon.level)) fail("its level is not a finite number");
    if (polygon.contours.empty()) fail("it has no contour");
    for (const Contour& contour : polygon.contours) check_contour(contour);
    if (const std::optional<Crossing> found = find_crossing(polygon))
      fail(
          fmt::format("its outline crosses or touches itself near ({:.6g}, {:.6g}), where the edges from "
                      "corners {} and {} "
                      "meet; split it into simple polygons",
                      found->at.x, found->at.y, found->first + 1, found->second + 1));
  }

 private:
  void check_contour(const Contour& contour) const {
    if (contour.size() < 3)
      fail(fmt::format("a contour of {} corners encloses nothing; at least three are right", contour.size()));
    double extent = 0;
    for (const Vertex& v : contour) {
      if (!(std::abs(v.x) <= target_reach_px && std::abs(v.y) <= target_reach_px))
        fail(fmt::format("corner ({}, {}) is not a number within {:g} pixels", v.x, v.y, target_reach_px));
      extent = std::max({extent, std::abs(v.x - contour[0].x), std::abs(v.y - contour[0].y)});
    }
    if (extent < 1e-9 || on_one_line(contour, extent))
      fail("a contour has no area: its corners lie on one line or on one point");
  }
  /// Whether no corner leaves the line from the first corner to the farthest by more than rounding.
  static bool on_one_line(const Contour& contour, double extent) {
    const Vertex& o = contour[0];
    Vertex far = o;
    for (const Vertex& v : contour)
      if (std::hypot(v.x - o.x, v.y - o.y) > std::hypot(far.x - o.x, far.y - o.y)) far = v;
    for (const Vertex& v : contour)
      if (std::abs((far.x - o.x) * (v.y - o.y) - (v.x - o.x) * (far.y - o.y)) > 1e-12 * extent * extent)
        return false;
    return true;
  }
  [[noreturn]] void fail(const std::string& what) const {
    const Polygon& polygon = scene_.polygons[index_];
    const std::string message = fmt::format("polygon {}: {}", index_ + 1, what);
    if (scene_.source.empty()) throw InputError(message);
    if (polygon.line > 0) throw InputError(scene_.source, polygon.line, message);
    throw InputError(scene_.source, message);
  }

  const TargetScene& scene_;
  std::size_t index_;
};

}  // namespace

double signed_area(const Contour& contour) {
  double twice = 0;
  for (std::size_t i = 0; i < contour.size(); ++i) {
    // About the first corner: far from the origin nothing cancels.
    const Vertex &o = contour[0], &a = contour[i], &b = contour[(i + 1) % contour.size()];
    twice += (a.x - o.x) * (b.y - o.y) - (b.x - o.x) * (a.y - o.y);
  }
  return 0.5 * twice;
}

Contour rectangle(Vertex centre, double width, double height, double angle_deg) {
  require_size(width, "rectangle width");
  require_size(height, "rectangle height");
  const double c = std::cos(angle_deg * pi / 180), s = std::sin(angle_deg * pi / 180);
  Contour contour;
  for (const auto& [u, v] : {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}})
    contour.push_back({centre.x + u * width * c - v * height * s, centre.y + u * width * s + v * height * c});
  return contour;
}

Contour half_plane(Vertex through, double angle_deg) {
  constexpr double far = 0.4 * target_reach_px;
  const double c = std::cos(angle_deg * pi / 180), s = std::sin(angle_deg * pi / 180);
  return {{through.x + far * s, through.y - far * c},
          {through.x + far * (s + c), through.y - far * (c - s)},
          {through.x - far * (s - c), through.y + far * (c + s)},
          {through.x - far * s, through.y + far * c}};
}

Contour regular_polygon(Vertex centre, double radius, int corners, double angle_deg) {
  require_size(radius, "radius");
  if (corners < 3)
    throw InputError(fmt::format("a polygon of {} corners: at least three are right", corners));
  Contour contour;
  for (int i = 0; i < corners; ++i) {
    const double angle = angle_deg * pi / 180 + 2 * pi * i / corners;
    contour.push_back({centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)});
  }
  return contour;
}

void validate(const TargetScene& scene) {
  if (!std::isfinite(scene.ground)) throw InputError("the level of the ground is not a finite number");
  for (std::size_t i = 0; i < scene.polygons.size(); ++i) PolygonCheck(scene, i).run();
}

}  // namespace petzval
