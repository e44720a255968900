// SPDX-License-Identifier: BSD-3-Clause
// The materials of a scene.
#pragma once

#include <petzval/render/materials/bsdf.h>
#include <petzval/render/materials/coating_albedo.h>
#include <petzval/render/materials/measured_brdf.h>
#include <petzval/render/materials/sheen.h>
#include <petzval/render/textures/bump_map.h>
#include <petzval/render/textures/normal_map.h>
#include <petzval/render/textures/texture_library.h>

#include <array>
#include <optional>
#include <vector>

namespace petzval::render {

/// What a surface is made of; fields that a kind does not have are empty.
struct Material {
  enum class Kind {
    diffuse,
    diffuse_transmission,
    coated_diffuse,
    layered,
    conductor,
    dielectric,
    thin_dielectric,
    measured,
    none,
    mix
  };
  Kind kind = Kind::diffuse;
  SpectrumTexture reflectance, transmittance;
  double transmittance_scale = 1;
  SpectrumTexture eta, k;
  FloatTexture roughness_u, roughness_v;
  FloatTexture base_roughness_u, base_roughness_v;  ///< of a metal under a coat
  bool remap_roughness = true;                      ///< alpha = √roughness
  Layering layering;
  FloatTexture coat_thickness;  ///< null: that of `layering`
  SpectrumTexture coat_albedo;  ///< of what scatters inside the coat; null: nothing does
  FloatTexture coat_g;
  std::shared_ptr<const CoatingAlbedo> coating;
  /// The reflectance is that of the base with its coating: the share that comes out again of light let in.
  bool reflectance_through_coating = false;
  std::shared_ptr<const MeasuredBrdf> measured;
  std::shared_ptr<const NormalMap> normal_map;  ///< null: none
  std::shared_ptr<const BumpMap> bump_map;      ///< null: none; at most one of the two
  std::shared_ptr<const Sheen> sheen;           ///< null: none
  SpectrumTexture sheen_colour;
  FloatTexture sheen_roughness;
  FloatTexture mix_amount;
  std::array<int, 2> mixed{0, 0};  ///< into the list of materials

  /// Scattering at a point. \param hero  the lane that decides where dispersed light goes. Kinds none and mix
  /// have none.
  Bsdf bsdf(const TexturePoint& point, int group, int hero) const;

 private:
  Bsdf bare_bsdf(const TexturePoint& point, int group, int hero) const;
  Bsdf layered_bsdf(const TexturePoint& point, int group) const;
};

/// All materials of a scene, in the order of its description.
std::vector<Material> make_materials(const SceneDescription& scene, const TextureLibrary& textures,
                                     Unsupported& unsupported);

/// Whether a material varies over its surface, so that texture coordinates are asked for.
bool varies(const std::vector<Material>& materials, int index);

/// The material that is there at a point: follows mixtures. \param choice  in [0, 1).
const Material& material_at(const std::vector<Material>& materials, int index, const TexturePoint& point,
                            int group, double choice);

}  // namespace petzval::render
