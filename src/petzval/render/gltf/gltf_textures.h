// SPDX-License-Identifier: BSD-3-Clause
// Pictures of a glTF file as textures of a scene.
#pragma once

#include <petzval/render/gltf/gltf_file.h>
#include <petzval/render/pbrt/scene_description.h>
#include <petzval/render/textures/picture_file.h>

#include <array>
#include <map>
#include <optional>

namespace petzval::render {

/// A texture as a material refers to it.
struct GltfTexture {
  int index = -1;  ///< −1: there is none
  int uv_set = 0;
  double offset_u = 0, offset_v = 0, scale_u = 1, scale_v = 1;  ///< KHR_texture_transform, v downwards
  double turn = 0;   ///< anticlockwise as one sees the coordinates [rad]
  std::string path;  ///< "materials[0].emissiveTexture"

  explicit operator bool() const { return index >= 0; }
};

/// Adds textures to the description of a scene. Each picture is decoded once.
class GltfTextures {
 public:
  GltfTextures(const GltfFile& file, SceneDescription& scene, Unsupported& unsupported)
      : file_(file), scene_(scene), unsupported_(unsupported) {}

  GltfTexture reference(int index, int uv_set, const tinygltf::ExtensionMap& extensions,
                        const std::string& path);
  /// sRGB colours times a factor, as a spectrum texture. \return its name.
  std::string add_colour(const GltfTexture& texture, const std::array<double, 3>& factor);
  /// The same colour everywhere, as a picture that takes the colours of vertices. \return its name.
  std::string add_flat(const std::array<double, 3>& colour, const Location& at);
  /// Opacity as it stands, 1 where the picture has none, times a factor, as a float texture. \return its
  /// name.
  std::string add_opacity(const GltfTexture& texture, double factor);
  /// One channel (0 red … 2 blue) as it stands, times a factor, as a float texture. \return its name.
  std::string add_channel(const GltfTexture& texture, std::size_t channel, double factor);
  /// A normal map, `scale` times as steep. \return its name.
  std::string add_normals(const GltfTexture& texture, double scale);
  /// The square of a float texture. \return its name.
  std::string add_square(const std::string& texture, const Location& at);

  /// The mean of its colours in linear light.
  std::array<double, 3> mean_colour(const GltfTexture& texture);
  /// The least opacity of its pixels: 0 to 1.
  double least_alpha(const GltfTexture& texture);

 private:
  /// A picture as its file has it.
  struct Decoded {
    int width = 0, height = 0;
    std::size_t channels = 0;
    std::vector<std::uint16_t> samples;  ///< from 0 to `white`
    int white = 255;

    std::size_t pixels() const { return samples.size() / channels; }
    /// Of a colour (0 red … 2 blue) in a pixel; grey has one.
    std::uint16_t sample(std::size_t pixel, std::size_t colour) const {
      return samples[pixel * channels + (channels < 3 ? 0 : colour)];
    }
    double opacity(std::size_t pixel) const {
      const bool has = channels == 2 || channels == 4;
      return has ? static_cast<double>(samples[(pixel + 1) * channels - 1]) / white : 1;
    }
    /// Linear light of every sample.
    std::vector<double> linear() const;
  };
  const Decoded& decoded(const GltfTexture& texture);
  Decoded decode(int image) const;
  std::string add(const GltfTexture& texture, const char* value_type, PictureFile picture, double scale = 1);

  const GltfFile& file_;
  SceneDescription& scene_;
  Unsupported& unsupported_;
  std::map<int, Decoded> decoded_;  ///< by image
};

}  // namespace petzval::render
