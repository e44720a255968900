// SPDX-License-Identifier: BSD-3-Clause
// Materials of a glTF file in the terms of pbrt-v4.
#pragma once

#include <petzval/render/gltf/gltf_textures.h>

namespace petzval::render {

/// What a primitive is made of.
struct GltfSurface {
  int material = 0;          ///< into SceneDescription::materials
  int area_light = -1;       ///< into SceneDescription::area_lights; −1: does not shine
  int medium = -1;           ///< that it encloses, into SceneDescription::media; −1: none
  int uv_set = -1;           ///< that its textures use; −1: it has none
  bool see_through = false;  ///< its opacity, times that of the vertices, counts
  double opacity = 1;
  std::string opacity_texture{};  ///< its name, the factor in it; empty: the factor alone
  std::optional<double> cutoff{};
};

/// Adds materials to the description of a scene, each once.
///
/// A metallic-roughness material becomes a mixture: as much conductor of that reflectance as it is metallic,
/// the rest a coateddiffuse of its index of refraction, whose base looks like the base colour through its
/// coating; both with facets of alpha = roughness² (glTF 2.0, appendix B). What light the coating lets in,
/// the base colour's share of it comes out again, as B.3.5 has it. KHR_materials_transmission puts glass in
/// the place of the base: a thin sheet, or with KHR_materials_volume a body. KHR_materials_clearcoat is a
/// coat of index 1.5 on as much of the surface as its factor says: coateddiffuse and coatedconductor.
/// KHR_materials_sheen is a matter of each of these. Opacity is a matter of the shape (Geometry::opacity).
class GltfMaterials {
 public:
  GltfMaterials(const GltfFile& file, SceneDescription& scene, Unsupported& unsupported)
      : file_(file), scene_(scene), unsupported_(unsupported), textures_(file, scene, unsupported) {}

  /// \param index  −1: glTF's default material. \param tinted  vertices have colours, which multiply its own.
  /// \param path  of the primitive. \throws InputError.
  GltfSurface surface(int index, bool tinted, const std::string& path);

 private:
  struct Reading;
  GltfSurface read(int index, bool tinted);
  void read_textures(Reading& reading);
  void read_coat(Reading& reading);
  void read_sheen(Reading& reading);
  void report_rest(const Reading& reading);
  void read_alpha(const Reading& reading, GltfSurface& surface);
  int add_body(const Reading& reading, bool under_coat);
  int add_opaque(const Reading& reading, bool under_coat);
  int add_surface(const Reading& reading, bool under_coat);
  int add_glass(const Reading& reading);
  int add_metal(const Reading& reading, bool under_coat);
  /// The first material to the share 1 − amount, the second to the share `amount`, or to that of a texture.
  int add_mix(int first, int second, double amount, const std::string& texture, const std::string& path);
  int add_emission(const Reading& reading);
  int add(Entity entity);

  const GltfFile& file_;
  SceneDescription& scene_;
  Unsupported& unsupported_;
  GltfTextures textures_;
  std::map<std::pair<int, bool>, GltfSurface> read_;  ///< by index, and whether tinted
};

}  // namespace petzval::render
