// SPDX-License-Identifier: BSD-3-Clause
// Which of many lights is worth asking from a point: a tree of lights.
#pragma once

#include <petzval/render/lights/equiangular.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace petzval::render {

/// Where light is to arrive.
struct LightReceiver {
  Vector3 position;
  Vector3 normal;           ///< unit, on the side that is seen
  bool both_sides = false;  ///< whether light from behind counts, too
  bool all_around = false;  ///< a point of a medium, which has no normal: all directions count alike
};

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
/// at each fork. A node that can do nothing there is never entered, and one that can, sometimes. Some
/// nodes near the root, the entries, are weighed all at once: 8, and 32 of many lights.
class LightTree {
 public:
  static constexpr std::size_t most_entries = 32;
  using Weights = std::array<double, most_entries>;

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
  struct Way {
    std::uint64_t turns = 0;  ///< from the entry, the last bit first: 1 for the second child
    std::uint32_t entry = 0;
  };
  class Builder;

  static double importance(const Node& node, const LightReceiver& to);
  /// Of the first child of a node.
  double share_of_first(std::size_t node, const LightReceiver& to) const;
  void find_entries();
  void find_ways(std::size_t node, std::uint32_t entry, std::uint64_t turns, int depth);

  std::vector<Node> nodes_;
  std::vector<std::size_t> entries_;
  std::vector<Way> ways_;  ///< of every light
};

}  // namespace petzval::render
