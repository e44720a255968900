// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/target/crossings.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace petzval {

namespace {

struct Edge {
  Vertex a, b;
  std::size_t index, next;  ///< of the edge that begins where this one ends
  double left() const { return std::min(a.x, b.x); }
  double right() const { return std::max(a.x, b.x); }
  double top() const { return std::min(a.y, b.y); }
  double bottom() const { return std::max(a.y, b.y); }
};

double turn(const Vertex& a, const Vertex& b, const Vertex& c) {
  return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
}

bool boxes_meet(const Edge& p, const Edge& q) {
  return p.left() <= q.right() && q.left() <= p.right() && p.top() <= q.bottom() && q.top() <= p.bottom();
}

/// Edges that share no corner: do they have a point in common?
bool meet(const Edge& p, const Edge& q) {
  if (!boxes_meet(p, q)) return false;
  const double a = turn(p.a, p.b, q.a), b = turn(p.a, p.b, q.b), c = turn(q.a, q.b, p.a),
               d = turn(q.a, q.b, p.b);
  return ((a <= 0 && b >= 0) || (a >= 0 && b <= 0)) && ((c <= 0 && d >= 0) || (c >= 0 && d <= 0));
}

/// Neighbours: does the second run back over the first?
bool folds_back(const Edge& p, const Edge& q) {
  const double along = (p.b.x - p.a.x) * (q.b.x - q.a.x) + (p.b.y - p.a.y) * (q.b.y - q.a.y);
  return along < 0 && turn(p.a, p.b, q.b) == 0;
}

std::vector<Edge> edges_of(const Polygon& polygon) {
  std::vector<Edge> edges;
  for (const Contour& contour : polygon.contours) {
    const std::size_t first = edges.size(), n = contour.size();
    for (std::size_t i = 0; i < n; ++i)
      edges.push_back({contour[i], contour[(i + 1) % n], first + i, first + (i + 1) % n});
  }
  return edges;
}

}  // namespace

std::optional<Crossing> find_crossing(const Polygon& polygon) {
  std::vector<Edge> edges = edges_of(polygon);
  // Sweep along the longer side of the box, so that few edges are open at a time.
  double width = 0, height = 0;
  for (const Edge& e : edges) {
    width = std::max(width, std::abs(e.a.x - edges[0].a.x));
    height = std::max(height, std::abs(e.a.y - edges[0].a.y));
  }
  const bool turned = height > width;
  if (turned)
    for (Edge& e : edges) {
      std::swap(e.a.x, e.a.y);
      std::swap(e.b.x, e.b.y);
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& p, const Edge& q) {
    return std::pair(p.left(), p.index) < std::pair(q.left(), q.index);
  });
  std::vector<const Edge*> open;
  for (const Edge& e : edges) {
    std::erase_if(open, [&](const Edge* other) { return other->right() < e.left(); });
    for (const Edge* other : open) {
      bool bad;
      if (other->next == e.index)
        bad = folds_back(*other, e);
      else if (e.next == other->index)
        bad = folds_back(e, *other);
      else
        bad = meet(e, *other);
      if (!bad) continue;
      const Vertex at = turned ? Vertex{e.a.y, e.a.x} : e.a;
      return Crossing{std::min(e.index, other->index), std::max(e.index, other->index), at};
    }
    open.push_back(&e);
  }
  return std::nullopt;
}

}  // namespace petzval
