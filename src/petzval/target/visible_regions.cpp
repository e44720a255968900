// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/scene/shape_cuts.h>
#include <petzval/target/meetings.h>
#include <petzval/target/visible_regions.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

struct Box {
  double left = std::numeric_limits<double>::max(), right = -left, top = left, bottom = -left;
};

Box box_of(const Polygon& polygon) {
  Box box;
  for (const Contour& contour : polygon.contours)
    for (const Vertex& v : contour) {
      box.left = std::min(box.left, v.x);
      box.right = std::max(box.right, v.x);
      box.top = std::min(box.top, v.y);
      box.bottom = std::max(box.bottom, v.y);
    }
  return box;
}

bool is_inside(const Contour& contour, const Vertex& at) {
  bool inside = false;
  for (std::size_t i = 0, j = contour.size() - 1; i < contour.size(); j = i++) {
    const Vertex &a = contour[i], &b = contour[j];
    if ((a.y > at.y) != (b.y > at.y) && at.x < a.x + (b.x - a.x) * (at.y - a.y) / (b.y - a.y))
      inside = !inside;
  }
  return inside;
}

/// Contours that do not cross, directed by how many of the others they lie within.
std::vector<Contour> directed(const Polygon& polygon) {
  std::vector<Contour> result;
  for (std::size_t i = 0; i < polygon.contours.size(); ++i) {
    bool hole = false;
    for (std::size_t j = 0; j < polygon.contours.size(); ++j)
      if (j != i && is_inside(polygon.contours[j], polygon.contours[i][0])) hole = !hole;
    result.push_back(polygon.contours[i]);
    if ((signed_area(result.back()) < 0) != hole) std::reverse(result.back().begin(), result.back().end());
  }
  return result;
}

/// What later polygons leave of one. Clipper directs outlines as Region wants them.
std::vector<Contour> uncovered(const Polygon& polygon, const std::vector<const Polygon*>& covers) {
  ClipperLib::Clipper clipper;
  clipper.AddPaths(to_clipper(polygon.contours), ClipperLib::ptSubject, true);
  ClipperLib::Paths cover;
  for (const Polygon* each : covers)
    for (ClipperLib::Path& path : to_clipper(directed(*each))) cover.push_back(std::move(path));
  clipper.AddPaths(cover, ClipperLib::ptClip, true);
  ClipperLib::Paths rest;
  // Covers overlap each other but are directed, so that their union is what winds at all.
  clipper.Execute(ClipperLib::ctDifference, rest, ClipperLib::pftEvenOdd, ClipperLib::pftPositive);
  return from_clipper(rest);
}

/// For each polygon the later ones that meet it: of those whose boxes overlap its own, found by a sweep along
/// x.
std::vector<std::vector<const Polygon*>> possible_covers(const std::vector<Polygon>& polygons) {
  std::vector<Box> boxes;
  std::vector<std::size_t> order, open;
  for (const Polygon& polygon : polygons) {
    order.push_back(boxes.size());
    boxes.push_back(box_of(polygon));
  }
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return boxes[a].left < boxes[b].left; });
  std::vector<std::vector<const Polygon*>> covers(polygons.size());
  for (const std::size_t i : order) {
    std::erase_if(open, [&](std::size_t j) { return boxes[j].right <= boxes[i].left; });
    for (const std::size_t j : open)
      if (boxes[i].top < boxes[j].bottom && boxes[j].top < boxes[i].bottom)
        covers[std::min(i, j)].push_back(&polygons[std::max(i, j)]);
    open.push_back(i);
  }
  // Many boxes overlap where polygons do not.
  std::vector<bool> involved(polygons.size());
  for (std::size_t i = 0; i < covers.size(); ++i)
    for (const Polygon* cover : covers[i])
      involved[i] = involved[static_cast<std::size_t>(cover - polygons.data())] = true;
  const Meetings meetings(polygons, involved);
  for (std::size_t i = 0; i < covers.size(); ++i) {
    std::erase_if(covers[i], [&](const Polygon* cover) {
      return !meetings.have_met(i, static_cast<std::size_t>(cover - polygons.data()));
    });
    std::sort(covers[i].begin(), covers[i].end());
  }
  return covers;
}

double signed_distance(const Vertex& v, int side, const Vertex& low, const Vertex& high) {
  switch (side) {
    case 0:
      return v.x - low.x;
    case 1:
      return high.x - v.x;
    case 2:
      return v.y - low.y;
    default:
      return high.y - v.y;
  }
}

}  // namespace

std::vector<Region> visible_regions(const TargetScene& scene) {
  const auto covers = possible_covers(scene.polygons);
  std::vector<Region> regions;
  for (std::size_t i = 0; i < scene.polygons.size(); ++i) {
    const Polygon& polygon = scene.polygons[i];
    Region region{covers[i].empty() ? directed(polygon) : uncovered(polygon, covers[i]),
                  polygon.level - scene.ground};
    if (region.step != 0 && !region.contours.empty()) regions.push_back(std::move(region));
  }
  return regions;
}

std::vector<std::vector<Contour>> simple_parts(const std::vector<Contour>& contours, FillRule rule) {
  for (const Contour& contour : contours)
    for (const Vertex& v : contour)
      if (!(std::abs(v.x) <= target_reach_px && std::abs(v.y) <= target_reach_px))
        throw InputError(
            fmt::format("corner ({}, {}) is not a number within {:g} pixels", v.x, v.y, target_reach_px));
  ClipperLib::Clipper clipper;
  // Parts that touch at a corner are parts; to look for such corners takes the square of their number.
  constexpr std::size_t most_corners = 4096;
  std::size_t corners = 0;
  for (const Contour& contour : contours) corners += contour.size();
  clipper.StrictlySimple(corners <= most_corners);
  clipper.AddPaths(to_clipper(contours), ClipperLib::ptSubject, true);
  const ClipperLib::PolyFillType type =
      rule == FillRule::nonzero ? ClipperLib::pftNonZero : ClipperLib::pftEvenOdd;
  ClipperLib::PolyTree tree;
  clipper.Execute(ClipperLib::ctUnion, tree, type, type);
  std::vector<std::vector<Contour>> parts;
  for (const ClipperLib::PolyNode* node = tree.GetFirst(); node != nullptr; node = node->GetNext()) {
    if (node->IsHole()) continue;
    ClipperLib::Paths paths{node->Contour};
    for (const ClipperLib::PolyNode* hole : node->Childs) paths.push_back(hole->Contour);
    parts.push_back(from_clipper(paths));
  }
  return parts;
}

bool meets_frame(const TargetScene& scene, int columns, int rows) {
  for (const Polygon& polygon : scene.polygons)
    for (const Contour& contour : polygon.contours)
      if (!clip_to_box(contour, {0, 0}, {static_cast<double>(columns), static_cast<double>(rows)}).empty())
        return true;
  return false;
}

Contour clip_to_box(const Contour& contour, Vertex low, Vertex high) {
  Contour current = contour;
  for (int side = 0; side < 4 && !current.empty(); ++side) {
    Contour next;
    for (std::size_t i = 0; i < current.size(); ++i) {
      const Vertex &a = current[i], &b = current[(i + 1) % current.size()];
      const double da = signed_distance(a, side, low, high), db = signed_distance(b, side, low, high);
      if (da >= 0) next.push_back(a);
      if ((da >= 0) == (db >= 0)) continue;
      const double t = da / (da - db);
      Vertex cut{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
      // On the side exactly, whatever rounding says.
      if (side == 0) cut.x = low.x;
      if (side == 1) cut.x = high.x;
      if (side == 2) cut.y = low.y;
      if (side == 3) cut.y = high.y;
      next.push_back(cut);
    }
    current = std::move(next);
  }
  return current.size() >= 3 ? current : Contour{};
}

}  // namespace petzval
