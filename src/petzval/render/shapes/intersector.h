// SPDX-License-Identifier: BSD-3-Clause
// Finds what a ray meets. intersector.cpp is the only file that knows how: by Embree, in single precision.
#pragma once

#include <petzval/render/shapes/geometry.h>

#include <memory>
#include <optional>
#include <span>

namespace petzval::render {

/// An object placed in the scene: the surfaces [first, last) of the list, from their space to the world.
struct PlacedObject {
  int object = 0;
  Transform world_from_object;
};

/// The surfaces [first, last) of one object.
struct GeometryRange {
  std::size_t first = 0, last = 0;
};

class Intersector {
 public:
  /// \param geometries  must outlive this and stay where they are. \param scene  those that stand in the
  /// world by themselves. \param objects  those that only appear where they are placed. \throws Failure when
  /// memory runs out.
  Intersector(const std::vector<Geometry>& geometries, GeometryRange scene,
              const std::vector<GeometryRange>& objects, const std::vector<PlacedObject>& placed);
  ~Intersector();
  Intersector(const Intersector&) = delete;
  Intersector& operator=(const Intersector&) = delete;

  /// The first surface in (0, limit) of the direction's length.
  std::optional<Hit> nearest(Vector3 origin, Vector3 direction, double limit) const;
  bool blocked(Vector3 origin, Vector3 direction, double limit) const;
  /// Corners of the box around everything; absent for an empty scene.
  std::optional<std::array<Vector3, 2>> bounds() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace petzval::render
