// SPDX-License-Identifier: BSD-3-Clause
// Which of many lights is worth asking from a point: a tree of lights.
#pragma once

#include <petzval/render/lights/equiangular.h>
#include <petzval/render/lights/light_importance.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace petzval::render {

/// A ray through a medium that is to scatter light.
struct LightedRay {
  Vector3 origin, way;    ///< way: unit
  double length = 0;      ///< may be infinite
  double extinction = 0;  ///< [1/unit]
  const AngleShares& shares;
};

/// Where some lights stand, and where they shine to.
struct LightBounds {
  std::array<Vector3, 2> box;  ///< least and greatest corner
  double radius = 0;           ///< of a ball about the middle of the box that holds them
  Vector3 axis{0, 0, 1};       ///< of the cone that holds all directions in which they shine strongest; unit
  double spread = 0;           ///< half angle of that cone, 0 … π [rad]
  double reach = 0;            ///< beyond the cone by so much they shine at all, 0 … π/2 [rad]
  bool two_sided = false;
  double strength = 0;  ///< intensity along the axis [radiance × unit²]
};

/// Lights by place, direction and strength (Conty Estevez & Kulla, "Importance sampling of many lights with
/// adaptive tree splitting", PACMCGIT 1 (2018) 2): a bound of what the lights of a node do at a point decides
/// which is entered. One that can do nothing there never is, and one that can, sometimes. Up to 32 nodes
/// near the root, the entries, are weighed all at once, and those that are near to the point by what their
/// children do; from there on a node has up to 16 children. So up to 32 lights are weighed one by one, of
/// some hundreds those near to the point.
class LightTree {
 public:
  static constexpr std::size_t most_together = 32;
  using Weights = std::array<double, most_together>;

  LightTree() = default;
  explicit LightTree(std::span<const LightBounds> lights);
  bool empty() const { return nodes_.empty(); }

  /// Nearly the irradiance that each entry gives a point in the open. Returns the sum.
  double weigh(const LightReceiver& to, Weights& weights) const;

  struct Choice {
    std::size_t light = 0;
    double probability = 0;  ///< 0 where no light can reach
  };
  /// \param weights, sum  of weigh(). \param choice  in [0, 1).
  Choice choose(const LightReceiver& to, const Weights& weights, double sum, double choice) const;
  /// The probability with which choose() comes to a light.
  double probability(const LightReceiver& to, const Weights& weights, double sum, std::size_t light) const;
  /// Distances on a ray that are near to one of the lights, which is chosen by nearly the light that it sends
  /// to the ray. Not of an empty tree.
  Equiangular beside(const LightedRay& ray, double choice) const;

 private:
  /// A node is followed by its first child.
  struct Node {
    Vector3 centre, axis;
    double radius2, cos_spread, sin_spread, cos_reach, strength;
    bool two_sided;
    std::uint32_t second = 0;  ///< second child; 0: a single light
    std::uint32_t light = 0;
  };
  class Builder;

  /// Nodes that are weighed together: the entries, or the children of a node.
  struct Family {
    std::size_t first = 0;                ///< of its members
    std::uint32_t count = 0, filled = 0;  ///< filled up as LightNodes are
    std::uint32_t parent = 0;             ///< member whose children these are
    bool all_ways = true;
  };
  struct Member {
    std::uint32_t family = 0;  ///< that it is in
    std::uint32_t opened = 0;  ///< family of its children; 0: a single light
    std::uint32_t light = 0;
  };

  /// A node, opened where most is unknown of most light.
  std::vector<std::size_t> opened(std::size_t node, std::size_t most) const;
  void add_family(const std::vector<std::size_t>& nodes, std::uint32_t parent);
  /// \param near  see light_importances().
  double weigh_family(std::size_t family, const LightReceiver& to, Weights& weights,
                      std::uint32_t& near) const;
  /// The same for children of a node that was chosen: of which one must be, then.
  double weigh_children(std::size_t family, const LightReceiver& to, Weights& weights) const;

  std::vector<Node> nodes_;
  std::vector<Family> families_;  ///< the first one has the entries
  std::vector<Member> members_;
  std::vector<double> numbers_;  ///< of LightNodes, family by family
  std::vector<std::uint32_t> member_of_light_;
};

}  // namespace petzval::render
