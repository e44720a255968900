// SPDX-License-Identifier: BSD-3-Clause
// The textures of a scene, made from their descriptions.
#pragma once

#include <petzval/render/pbrt/scene_description.h>
#include <petzval/render/spectra/named_spectra.h>
#include <petzval/render/textures/picture_texture.h>
#include <petzval/render/textures/simple_textures.h>

#include <map>
#include <optional>

namespace petzval::render {

class NormalMap;

/// Makes and keeps the textures of a scene by name, and reads parameters that are textures or plain values.
class TextureLibrary {
 public:
  /// \throws InputError with file, line and column; through `unsupported`. The references must outlive this.
  TextureLibrary(const SceneDescription& scene, const WavelengthGroups& groups, Unsupported& unsupported);

  /// Those that textures are made for.
  const WavelengthGroups& groups() const { return groups_; }

  /// The parameter as a texture: "texture name" refers to one, anything else is a constant. Nothing if
  /// absent.
  FloatTexture float_parameter(const Parameters& parameters, const std::string& name) const;
  FloatTexture float_parameter(const Parameters& parameters, const std::string& name, double otherwise) const;
  SpectrumTexture spectrum_parameter(const Parameters& parameters, const std::string& name,
                                     SpectrumRole role) const;
  SpectrumTexture spectrum_parameter(const Parameters& parameters, const std::string& name, SpectrumRole role,
                                     double otherwise) const;

  /// "string normalmap", a file, or "texture normalmap", a texture of value type normal. Nothing if absent.
  std::shared_ptr<const NormalMap> normal_map(const Parameters& parameters) const;

 private:
  std::shared_ptr<const NormalMap> make_normal_map(const TextureDescription& description);
  FloatTexture make_float(const TextureDescription& description);
  SpectrumTexture make_spectrum(const TextureDescription& description);
  PictureSampler picture(const Parameters& parameters, PictureTextureOptions& options,
                         const TextureDescription& description);
  std::shared_ptr<const PictureFile> picture_file(const Parameters& parameters);
  const std::shared_ptr<const ReflectanceTable>& reflectances();

  const WavelengthGroups& groups_;
  Unsupported& unsupported_;
  std::map<std::string, FloatTexture> floats_;
  std::map<std::string, SpectrumTexture> spectra_;
  std::map<std::string, std::shared_ptr<const NormalMap>> normals_;
  std::map<std::string, std::shared_ptr<const PictureFile>> pictures_;
  std::shared_ptr<const ReflectanceTable> reflectances_;
};

}  // namespace petzval::render
