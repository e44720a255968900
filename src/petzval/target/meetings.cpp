// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/target/meetings.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

struct Segment {
  Vertex a, b;
  std::uint32_t polygon;
};

std::uint64_t key_of(std::size_t a, std::size_t b) {
  return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b);
}

double turn_of(const Vertex& a, const Vertex& b, const Vertex& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Whether segments cross or touch; those on one line count as touching.
bool touch(const Segment& e, const Segment& f) {
  return turn_of(e.a, e.b, f.a) * turn_of(e.a, e.b, f.b) <= 0 &&
         turn_of(f.a, f.b, e.a) * turn_of(f.a, f.b, e.b) <= 0;
}

/// Rows of equal height over nearly all corners; what lies beyond belongs to the first or the last.
class Rows {
 public:
  Rows(const std::vector<Segment>& edges) {
    constexpr std::size_t edges_each = 8, most = 1 << 16;
    count_ = std::clamp<std::size_t>(edges.size() / edges_each, 1, most);
    std::vector<double> heights;
    for (const Segment& edge : edges) heights.push_back(edge.a.y);
    const auto at = [&](double share) {
      const auto place =
          heights.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(heights.size() - 1));
      std::nth_element(heights.begin(), place, heights.end());
      return *place;
    };
    constexpr double outliers = 1e-3;
    low_ = at(outliers);
    height_ = std::max(1e-9, (at(1 - outliers) - low_) / static_cast<double>(count_));
    first_.assign(count_ + 1, 0);
    for (const Segment& edge : edges) visit(edge, [&](std::size_t row) { ++first_[row + 1]; });
    for (std::size_t row = 0; row < count_; ++row) first_[row + 1] += first_[row];
    members_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < edges.size(); ++i)
      visit(edges[i], [&](std::size_t row) { members_[next[row]++] = static_cast<std::uint32_t>(i); });
  }

  std::size_t count() const { return count_; }
  std::size_t row_of(double y) const {
    return static_cast<std::size_t>(std::clamp((y - low_) / height_, 0.0, static_cast<double>(count_ - 1)));
  }
  std::vector<std::uint32_t> members(std::size_t row) const {
    return {members_.begin() + static_cast<std::ptrdiff_t>(first_[row]),
            members_.begin() + static_cast<std::ptrdiff_t>(first_[row + 1])};
  }
  /// Range of x of an edge within a row, a little widened; the outer rows take edges whole.
  std::pair<double, double> reach(const Segment& edge, std::size_t row) const {
    const double left = std::min(edge.a.x, edge.b.x), right = std::max(edge.a.x, edge.b.x);
    if (row == 0 || row + 1 == count_ || edge.a.y == edge.b.y) return {left, right};
    const auto x_at = [&](double y) {
      return std::clamp(edge.a.x + (edge.b.x - edge.a.x) * (y - edge.a.y) / (edge.b.y - edge.a.y), left,
                        right);
    };
    const double top = low_ + static_cast<double>(row) * height_;
    const auto [from, to] = std::minmax({x_at(top), x_at(top + height_)});
    constexpr double rounding = 1e-6;
    return {from - rounding, to + rounding};
  }

 private:
  template <typename Work>
  void visit(const Segment& edge, const Work& work) const {
    const std::size_t last = row_of(std::max(edge.a.y, edge.b.y));
    for (std::size_t row = row_of(std::min(edge.a.y, edge.b.y)); row <= last; ++row) work(row);
  }

  std::size_t count_ = 1;
  double low_ = 0, height_ = 1;
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> members_;
};

void sort_out(std::vector<std::uint64_t>& keys) {
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

/// Pairs whose edges meet within one row.
std::vector<std::uint64_t> meetings_in(const std::vector<Segment>& edges, const Rows& rows, std::size_t row) {
  struct Span {
    double from, to;
    std::uint32_t edge;
  };
  std::vector<Span> spans, open;
  for (const std::uint32_t i : rows.members(row)) {
    const auto [from, to] = rows.reach(edges[i], row);
    spans.push_back({from, to, i});
  }
  std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) { return a.from < b.from; });
  std::vector<std::uint64_t> found;
  for (const Span& span : spans) {
    const Segment& edge = edges[span.edge];
    std::erase_if(open, [&](const Span& other) { return other.to < span.from; });
    for (const Span& other : open) {
      const Segment& before = edges[other.edge];
      if (before.polygon != edge.polygon && touch(before, edge))
        found.push_back(key_of(before.polygon, edge.polygon));
    }
    open.push_back(span);
  }
  sort_out(found);
  return found;
}

}  // namespace

Meetings::Meetings(const std::vector<Polygon>& polygons, const std::vector<bool>& involved) {
  std::vector<Segment> edges;
  for (std::size_t p = 0; p < polygons.size(); ++p)
    if (involved[p])
      for (const Contour& contour : polygons[p].contours)
        for (std::size_t i = 0; i < contour.size(); ++i)
          edges.push_back({contour[i], contour[(i + 1) % contour.size()], static_cast<std::uint32_t>(p)});
  if (edges.empty()) return;
  const Rows rows(edges);
  std::vector<std::vector<std::uint64_t>> found(rows.count());
  parallel_for(rows.count(), [&](std::size_t row) { found[row] = meetings_in(edges, rows, row); });
  for (const std::vector<std::uint64_t>& some : found) pairs_.insert(pairs_.end(), some.begin(), some.end());

  // Contours that lie within another polygon without meeting its outline: by their first corners.
  std::vector<bool> inside(polygons.size());
  for (std::size_t p = 0; p < polygons.size(); ++p) {
    if (!involved[p]) continue;
    for (const Contour& contour : polygons[p].contours) {
      const Vertex& at = contour[0];
      std::vector<std::uint32_t> touched;
      for (const std::uint32_t i : rows.members(rows.row_of(at.y))) {
        const Segment& e = edges[i];
        if ((e.a.y > at.y) == (e.b.y > at.y) ||
            at.x >= e.a.x + (e.b.x - e.a.x) * (at.y - e.a.y) / (e.b.y - e.a.y))
          continue;
        inside[e.polygon] = !inside[e.polygon];
        touched.push_back(e.polygon);
      }
      for (const std::uint32_t other : touched) {
        if (inside[other] && other != p) pairs_.push_back(key_of(p, other));
        inside[other] = false;
      }
    }
  }
  sort_out(pairs_);
}

bool Meetings::have_met(std::size_t a, std::size_t b) const {
  return std::binary_search(pairs_.begin(), pairs_.end(), key_of(a, b));
}

}  // namespace petzval
