// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/stop.h>
#include <petzval/base/units.h>
#include <petzval/render/lights/light_tree.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace petzval::render {

namespace {

constexpr int bins = 12;
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
/// So many nodes stand for one that is not an entry.
constexpr std::size_t most_children = 16;
/// A bound says little of the lights of a node that is nearer than so many of its radii.
constexpr double nearness = 2;
/// A tree that has become this deep is halved by number from there on: 2^32 lights more are no deeper
/// than 64.
constexpr int depth_of_even_halves = 30;

Vector3 middle(const std::array<Vector3, 2>& box) {
  return 0.5 * (box[0] + box[1]);
}

std::array<Vector3, 2> joined(const std::array<Vector3, 2>& a, const std::array<Vector3, 2>& b) {
  return {Vector3{std::min(a[0].x, b[0].x), std::min(a[0].y, b[0].y), std::min(a[0].z, b[0].z)},
          Vector3{std::max(a[1].x, b[1].x), std::max(a[1].y, b[1].y), std::max(a[1].z, b[1].z)}};
}

/// The cone that holds two cones.
void join_cones(const LightBounds& a, const LightBounds& b, LightBounds& sum) {
  const LightBounds &wide = a.spread >= b.spread ? a : b, &narrow = a.spread >= b.spread ? b : a;
  double between = std::acos(std::clamp(dot(wide.axis, narrow.axis), -1.0, 1.0));
  Vector3 towards = narrow.axis;
  // One that shines to both sides may be held by the end that is nearer.
  if (narrow.two_sided && wide.two_sided && between > pi / 2) between = pi - between, towards = -towards;
  sum.axis = wide.axis, sum.spread = wide.spread;
  if (between + narrow.spread <= wide.spread) return;
  sum.spread = (wide.spread + between + narrow.spread) / 2;
  const Vector3 across = towards - dot(towards, wide.axis) * wide.axis;
  if (sum.spread >= pi || !(dot(across, across) > 0)) {
    sum.spread = pi;
    return;
  }
  const double turn = sum.spread - wide.spread;
  sum.axis = normalised(std::cos(turn) * wide.axis + std::sin(turn) * normalised(across));
}

LightBounds joined(const LightBounds& a, const LightBounds& b) {
  if (!(a.strength > 0)) return b;
  if (!(b.strength > 0)) return a;
  LightBounds sum;
  sum.box = joined(a.box, b.box);
  sum.radius = length(sum.box[1] - sum.box[0]) / 2;
  join_cones(a, b, sum);
  sum.reach = std::max(a.reach, b.reach);
  sum.two_sided = a.two_sided || b.two_sided;
  sum.strength = a.strength + b.strength;
  return sum;
}

/// How much light how far and to how many directions: what a split should make small (equation 1).
double cost(const LightBounds& of) {
  const double wide = std::min(of.spread + of.reach, pi), spread = of.spread;
  const double directions =
      2 * pi * (1 - std::cos(spread)) + pi / 2 *
                                            (2 * wide * std::sin(spread) - std::cos(spread - 2 * wide) -
                                             2 * spread * std::sin(spread) + std::cos(spread));
  return of.strength * directions * of.radius * of.radius;
}

double along(Vector3 v, int axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

}  // namespace

class LightTree::Builder {
 public:
  Builder(std::span<const LightBounds> lights, std::vector<Node>& nodes) : lights_(lights), nodes_(nodes) {
    for (std::size_t i = 0; i < lights.size(); ++i)
      if (lights[i].strength > 0) order_.push_back(static_cast<std::uint32_t>(i));
  }
  void build() {
    if (!order_.empty()) build(0, order_.size(), 0);
  }

 private:
  LightBounds build(std::size_t first, std::size_t last, int depth) {
    check_stop();
    const std::size_t at = nodes_.size();
    nodes_.emplace_back();
    LightBounds all;
    if (last - first == 1) {
      all = lights_[order_[first]];
      nodes_[at].light = order_[first];
    } else {
      const std::size_t split = split_of(first, last, depth);
      const LightBounds one = build(first, split, depth + 1);
      nodes_[at].second = static_cast<std::uint32_t>(nodes_.size());
      all = joined(one, build(split, last, depth + 1));
    }
    Node& node = nodes_[at];
    node.centre = middle(all.box), node.radius2 = all.radius * all.radius;
    node.axis = all.axis, node.two_sided = all.two_sided, node.strength = all.strength;
    node.cos_spread = std::cos(all.spread), node.sin_spread = std::sin(all.spread);
    node.cos_reach = std::cos(all.reach);
    return all;
  }

  /// Puts the lights of one side before those of the other; returns where the other begins.
  std::size_t split_of(std::size_t first, std::size_t last, int depth) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::array<Vector3, 2> middles{Vector3{infinity, infinity, infinity},
                                   Vector3{-infinity, -infinity, -infinity}};
    for (std::size_t i = first; i < last; ++i) {
      const Vector3 at = middle(lights_[order_[i]].box);
      middles = joined(middles, {at, at});
    }
    const Vector3 size = middles[1] - middles[0];
    const double longest = std::max({size.x, size.y, size.z});
    if (depth >= depth_of_even_halves || !(longest > 0)) return (first + last) / 2;
    Split best{infinity, 0, 0};
    for (int axis = 0; axis < 3; ++axis)
      if (along(size, axis) > 0)
        try_axis(first, last, axis, along(middles[0], axis), along(size, axis), longest, best);
    const double low = along(middles[0], best.axis), wide = along(size, best.axis);
    const auto middle_of =
        std::partition(order_.begin() + static_cast<std::ptrdiff_t>(first),
                       order_.begin() + static_cast<std::ptrdiff_t>(last),
                       [&](std::uint32_t light) { return bin_of(light, best.axis, low, wide) <= best.bin; });
    const auto split = static_cast<std::size_t>(middle_of - order_.begin());
    return split == first || split == last ? (first + last) / 2 : split;
  }

  struct Split {
    double cost;
    int axis, bin;
  };
  int bin_of(std::uint32_t light, int axis, double low, double wide) const {
    const double at = (along(middle(lights_[light].box), axis) - low) / wide;
    return std::clamp(static_cast<int>(at * bins), 0, bins - 1);
  }
  void try_axis(std::size_t first, std::size_t last, int axis, double low, double wide, double longest,
                Split& best) const {
    std::array<LightBounds, bins> in_bin;
    for (std::size_t i = first; i < last; ++i) {
      LightBounds& bin = in_bin[static_cast<std::size_t>(bin_of(order_[i], axis, low, wide))];
      bin = joined(bin, lights_[order_[i]]);
    }
    std::array<double, bins> after{};
    LightBounds sum;
    for (std::size_t bin = bins - 1; bin > 0; --bin) {
      sum = joined(in_bin[bin], sum);
      after[bin - 1] = sum.strength > 0 ? cost(sum) : std::numeric_limits<double>::infinity();
    }
    sum = {};
    for (std::size_t bin = 0; bin + 1 < bins; ++bin) {
      sum = joined(sum, in_bin[bin]);
      if (!(sum.strength > 0)) continue;
      // Thin slices are not worth much (equation 2).
      const double both = longest / wide * (cost(sum) + after[bin]);
      if (both < best.cost) best = {both, axis, static_cast<int>(bin)};
    }
  }

  std::span<const LightBounds> lights_;
  std::vector<Node>& nodes_;
  std::vector<std::uint32_t> order_;
};

LightTree::LightTree(std::span<const LightBounds> lights) : member_of_light_(lights.size(), none) {
  Builder(lights, nodes_).build();
  if (!nodes_.empty()) add_family(opened(0, most_together), none);
}

std::vector<std::size_t> LightTree::opened(std::size_t node, std::size_t most) const {
  std::vector<std::size_t> result = {node};
  while (result.size() < most) {
    std::size_t open = result.size();
    double unknown = -1;
    for (std::size_t i = 0; i < result.size(); ++i) {
      const Node& each = nodes_[result[i]];
      if (each.second && each.strength * each.radius2 > unknown)
        unknown = each.strength * each.radius2, open = i;
    }
    if (open == result.size()) break;
    result.push_back(nodes_[result[open]].second);
    result[open] += 1;
  }
  return result;
}

void LightTree::add_family(const std::vector<std::size_t>& nodes, std::uint32_t parent) {
  const auto index = static_cast<std::uint32_t>(families_.size());
  Family family;
  family.first = members_.size(), family.count = static_cast<std::uint32_t>(nodes.size());
  constexpr std::size_t together = LightNodes::together;
  const std::size_t filled = (nodes.size() + together - 1) / together * together;
  family.filled = static_cast<std::uint32_t>(filled), family.parent = parent;
  members_.resize(family.first + filled);
  numbers_.resize(members_.size() * LightNodes::columns);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Node& node = nodes_[nodes[i]];
    const double values[LightNodes::columns] = {node.centre.x,
                                                node.centre.y,
                                                node.centre.z,
                                                node.axis.x,
                                                node.axis.y,
                                                node.axis.z,
                                                std::sqrt(node.radius2),
                                                node.radius2,
                                                node.cos_spread,
                                                node.sin_spread,
                                                node.cos_reach,
                                                node.strength,
                                                node.two_sided ? 1.0 : 0.0};
    for (std::size_t column = 0; column < LightNodes::columns; ++column)
      numbers_[family.first * LightNodes::columns + column * filled + i] = values[column];
    family.all_ways = family.all_ways && !(node.cos_spread > -1);
    members_[family.first + i] = {index, 0, node.light};
    if (!node.second) member_of_light_[node.light] = static_cast<std::uint32_t>(family.first + i);
  }
  families_.push_back(family);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!nodes_[nodes[i]].second) continue;
    members_[family.first + i].opened = static_cast<std::uint32_t>(families_.size());
    add_family(opened(nodes[i], most_children), static_cast<std::uint32_t>(family.first + i));
  }
}

double LightTree::weigh_family(std::size_t index, const LightReceiver& to, Weights& weights,
                               std::uint32_t& near) const {
  const Family& family = families_[index];
  near = light_importances({&numbers_[family.first * LightNodes::columns], family.filled, family.all_ways},
                           to, nearness, weights.data());
  return std::accumulate(weights.begin(), weights.begin() + family.count, 0.0);
}

double LightTree::weigh(const LightReceiver& to, Weights& weights) const {
  if (nodes_.empty()) return 0;
  std::uint32_t near = 0, unused;
  const double sum = weigh_family(0, to, weights, near);
  if (!near) return sum;
  for (std::size_t i = 0; i < families_[0].count; ++i) {
    if (!(near >> i & 1) || !members_[i].opened || !(weights[i] > 0)) continue;
    Weights within;
    weights[i] = weigh_family(members_[i].opened, to, within, unused);
  }
  return std::accumulate(weights.begin(), weights.begin() + families_[0].count, 0.0);
}

double LightTree::weigh_children(std::size_t family, const LightReceiver& to, Weights& weights) const {
  std::uint32_t unused;
  const double sum = weigh_family(family, to, weights, unused);
  if (sum > 0) return sum;
  // What a node's bound has let in may be nothing for all of them.
  weights.fill(1);
  return families_[family].count;
}

LightTree::Choice LightTree::choose(const LightReceiver& to, const Weights& weights, double sum,
                                    double choice) const {
  if (!(sum > 0)) return {};
  Weights children;
  const Weights* of = &weights;
  double probability = 1;
  for (std::size_t family = 0;;) {
    std::size_t chosen = 0;
    double left = choice * sum;
    for (std::size_t i = 0; i < families_[family].count; ++i) {
      if (!((*of)[i] > 0)) continue;
      chosen = i;  // the last one, should rounding lead beyond it
      if (left < (*of)[i]) break;
      left -= (*of)[i];
    }
    probability *= (*of)[chosen] / sum;
    const Member& member = members_[families_[family].first + chosen];
    if (!member.opened) return {member.light, probability};
    constexpr double below_one = 1 - 0x1p-53;
    choice = std::min(left / (*of)[chosen], below_one);
    family = member.opened;
    sum = weigh_children(family, to, children);
    of = &children;
  }
}

double LightTree::probability(const LightReceiver& to, const Weights& weights, double sum,
                              std::size_t light) const {
  std::uint32_t at = member_of_light_[light];
  if (!(sum > 0) || at == none) return 0;
  double probability = 1;
  while (const std::uint32_t family = members_[at].family) {
    Weights children;
    const double all = weigh_children(family, to, children);
    probability *= children[at - families_[family].first] / all;
    at = families_[family].parent;
  }
  return probability * weights[at] / sum;
}

Equiangular LightTree::beside(const LightedRay& ray, double choice) const {
  struct Seen {
    Equiangular distances;
    double light;
  };
  const auto see = [&](const Node& node) {
    const Equiangular distances(ray.origin, ray.way, ray.length, node.centre, node.radius2, ray.shares);
    const double dimmed = ray.extinction * std::clamp(distances.nearest(), 0.0, ray.length);
    return Seen{distances, node.strength * distances.light() * std::exp(-dimmed)};
  };
  std::size_t node = 0;
  Seen at = see(nodes_[node]);
  while (nodes_[node].second) {
    const Seen one = see(nodes_[node + 1]), other = see(nodes_[nodes_[node].second]);
    const double sum = one.light + other.light, first = sum > 0 ? one.light / sum : 0.5;
    const bool is_first = choice < first;
    choice = is_first ? choice / first : (choice - first) / (1 - first);
    node = is_first ? node + 1 : nodes_[node].second;
    at = is_first ? one : other;
  }
  return at.distances;
}

}  // namespace petzval::render
