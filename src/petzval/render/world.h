// SPDX-License-Identifier: BSD-3-Clause
// A scene that is ready to be rendered.
#pragma once

#include <petzval/render/lights/light_reader.h>
#include <petzval/render/materials/material.h>
#include <petzval/render/media/medium.h>
#include <petzval/render/shapes/intersector.h>

#include <memory>
#include <vector>

namespace petzval::render {

/// Shapes, materials and lights at the wavelengths of one picture. Immutable once built.
struct World {
  WavelengthGroups groups;
  std::vector<Geometry> geometries;
  std::vector<PlacedObject> placed;
  std::vector<Material> materials;
  std::vector<Medium> media;
  int camera_medium = -1;         ///< into media; −1: none
  bool media_end_openly = false;  ///< somewhere two media meet at a surface that light passes as it is
  Lights lights;
  std::unique_ptr<Intersector> intersector;

  bool is_dark() const;  ///< nothing shines
  const Transform* place_of(const Hit& hit) const {
    return hit.instance < 0 ? nullptr : &placed[static_cast<std::size_t>(hit.instance)].world_from_object;
  }
};

/// \throws InputError with file, line and column, and through `unsupported`; Failure.
std::unique_ptr<const World> build_world(const SceneDescription& scene, const WavelengthGroups& groups,
                                         const LightOptions& options, Unsupported& unsupported);

}  // namespace petzval::render
