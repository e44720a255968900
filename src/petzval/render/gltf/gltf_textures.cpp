// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/stop.h>
#include <petzval/colour/display.h>
#include <petzval/image/formats/jpeg.h>
#include <petzval/image/formats/png.h>
#include <petzval/render/gltf/gltf_extensions.h>
#include <petzval/render/gltf/gltf_textures.h>
#include <petzval/render/pbrt/entity_maker.h>

#include <algorithm>

namespace petzval::render {

namespace {

constexpr std::size_t pixels_between_questions = 1 << 16;

const char* wrap_of(const GltfFile& file, int mode, const std::string& path) {
  switch (mode) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT:
      return "repeat";
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return "clamp";
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return "mirror";
    default:
      throw scene_error(file.at(path),
                        fmt::format("{} is no way of wrapping; 10497, 33071 or 33648 would be right", mode));
  }
}

}  // namespace

GltfTexture GltfTextures::reference(int index, int uv_set, const tinygltf::ExtensionMap& extensions,
                                    const std::string& path) {
  GltfTexture texture{index, uv_set, 0, 0, 1, 1, 0, path};
  if (index < 0) return texture;
  file_.entry(file_.model.textures, index, "textures", path + ".index");
  GltfExtension transform(file_, extensions, "KHR_texture_transform", path);
  if (transform.is_there()) {
    const std::vector<double> offset = transform.numbers("offset", {0, 0}),
                              scale = transform.numbers("scale", {1, 1});
    texture.offset_u = offset[0], texture.offset_v = offset[1];
    texture.scale_u = scale[0], texture.scale_v = scale[1];
    if (transform.has("texCoord")) texture.uv_set = transform.index("texCoord");
    texture.turn = transform.number("rotation", 0, -1e6, 1e6);
    transform.report_rest(unsupported_);
  }
  report_gltf_extensions(file_, extensions, path, {"KHR_texture_transform"}, unsupported_);
  if (texture.uv_set < 0) throw scene_error(file_.at(path + ".texCoord"), "0 or more would be right");
  return texture;
}

GltfTextures::Decoded GltfTextures::decode(int index) const {
  const tinygltf::Image& image = file_.model.images[static_cast<std::size_t>(index)];
  const std::string path = fmt::format("images[{}]", index);
  std::string bytes(image.image.begin(), image.image.end());
  if (image.bufferView >= 0) {
    const std::span<const unsigned char> view = file_.view(image.bufferView, path + ".bufferView");
    bytes.assign(view.begin(), view.end());
  }
  try {
    if (bytes.empty())
      throw InputError(
          fmt::format("\"{}\" cannot be read; a file in the folder of the scene or base64 data would "
                      "be right",
                      image.uri));
    if (bytes.rfind("\x89PNG", 0) == 0) {
      const PngImage png = parse_png(std::move(bytes), "this picture");
      return {png.columns, png.rows, static_cast<std::size_t>(png.channels), png.samples,
              (1 << png.bits) - 1};
    }
    if (bytes.rfind("\xFF\xD8", 0) == 0) {
      const JpegImage jpeg = parse_jpeg(bytes, "this picture");
      return {jpeg.columns,
              jpeg.rows,
              static_cast<std::size_t>(jpeg.channels),
              {jpeg.samples.begin(), jpeg.samples.end()},
              255};
    }
    throw InputError("is neither a PNG nor a JPEG picture");
  } catch (const InputError& error) {
    throw scene_error(file_.at(path), error.what());
  }
}

const GltfTextures::Decoded& GltfTextures::decoded(const GltfTexture& texture) {
  const std::string path = fmt::format("textures[{}]", texture.index);
  const tinygltf::Texture& entry = file_.model.textures[static_cast<std::size_t>(texture.index)];
  file_.entry(file_.model.images, entry.source, "images", path + ".source");
  const auto found = decoded_.find(entry.source);
  return found != decoded_.end() ? found->second
                                 : decoded_.emplace(entry.source, decode(entry.source)).first->second;
}

std::string GltfTextures::add(const GltfTexture& texture, const char* value_type, PictureFile picture,
                              double scale) {
  const tinygltf::Texture& entry = file_.model.textures[static_cast<std::size_t>(texture.index)];
  tinygltf::Sampler sampler;
  const std::string path = fmt::format("samplers[{}]", entry.sampler);
  if (entry.sampler >= 0)
    sampler = file_.entry(file_.model.samplers, entry.sampler, "samplers",
                          fmt::format("textures[{}].sampler", texture.index));
  const std::string wrap = wrap_of(file_, sampler.wrapS, path + ".wrapS");
  if (wrap != wrap_of(file_, sampler.wrapT, path + ".wrapT"))
    unsupported_.report(file_.at(path + ".wrapT"), "another way of wrapping for T than for S");
  TextureDescription description;
  description.name = fmt::format("textures {}", scene_.textures.size());
  description.value_type = value_type;
  description.picture = std::make_shared<const PictureFile>(std::move(picture));
  // v is counted upwards in a scene: t = 1 − v′ with (u′, v′) = turn · scale · (u, 1 − v) + offset.
  const double cos = std::cos(texture.turn), sin = std::sin(texture.turn);
  description.entity =
      EntityMaker("imagemap", file_.at(texture.path))
          .text("wrap", {wrap})
          .text("filter", {sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST ? "point" : "bilinear"})
          .number("scale", scale)
          .number("uscale", cos * texture.scale_u)
          .number("sfromv", -sin * texture.scale_v)
          .number("udelta", texture.offset_u + sin * texture.scale_v)
          .number("vscale", cos * texture.scale_v)
          .number("tfromu", sin * texture.scale_u)
          .number("vdelta", 1 - cos * texture.scale_v - texture.offset_v)
          .made();
  scene_.textures.push_back(description);
  return description.name;
}

std::vector<double> GltfTextures::Decoded::linear() const {
  std::vector<double> light;
  light.reserve(static_cast<std::size_t>(white) + 1);
  for (int level = 0; level <= white; ++level)
    light.push_back(srgb_decoded(static_cast<double>(level) / white));
  return light;
}

std::string GltfTextures::add_colour(const GltfTexture& texture, const std::array<double, 3>& factor) {
  const Decoded& from = decoded(texture);
  const std::vector<double> linear = from.linear();
  PictureFile picture{from.width, from.height, 3, {}};
  picture.values.reserve(3 * from.pixels());
  for (std::size_t i = 0; i < from.pixels(); ++i) {
    if (i % pixels_between_questions == 0) check_stop();
    for (std::size_t c = 0; c < 3; ++c)
      picture.values.push_back(static_cast<float>(factor[c] * linear[from.sample(i, c)]));
  }
  return add(texture, "spectrum", std::move(picture));
}

std::string GltfTextures::add_channel(const GltfTexture& texture, std::size_t channel, double factor) {
  const Decoded& from = decoded(texture);
  PictureFile picture{from.width, from.height, 1, {}};
  picture.values.reserve(from.pixels());
  for (std::size_t i = 0; i < from.pixels(); ++i) {
    if (i % pixels_between_questions == 0) check_stop();
    picture.values.push_back(static_cast<float>(factor * from.sample(i, channel) / from.white));
  }
  return add(texture, "float", std::move(picture));
}

std::string GltfTextures::add_flat(const std::array<double, 3>& colour, const Location& at) {
  TextureDescription description;
  description.name = fmt::format("textures {}", scene_.textures.size());
  description.value_type = "spectrum";
  PictureFile picture{1, 1, 3, {}};
  for (const double each : colour) picture.values.push_back(static_cast<float>(each));
  description.picture = std::make_shared<const PictureFile>(std::move(picture));
  description.entity = EntityMaker("imagemap", at).made();
  scene_.textures.push_back(description);
  return description.name;
}

std::string GltfTextures::add_opacity(const GltfTexture& texture, double factor) {
  const Decoded& from = decoded(texture);
  PictureFile picture{from.width, from.height, 1, {}};
  picture.values.reserve(from.pixels());
  for (std::size_t i = 0; i < from.pixels(); ++i)
    picture.values.push_back(static_cast<float>(factor * from.opacity(i)));
  return add(texture, "float", std::move(picture));
}

std::string GltfTextures::add_normals(const GltfTexture& texture, double scale) {
  const Decoded& from = decoded(texture);
  PictureFile picture{from.width, from.height, 3, {}};
  picture.values.reserve(3 * from.pixels());
  for (std::size_t i = 0; i < from.pixels(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      picture.values.push_back(static_cast<float>(static_cast<double>(from.sample(i, c)) / from.white));
  return add(texture, "normal", std::move(picture), scale);
}

std::string GltfTextures::add_square(const std::string& texture, const Location& at) {
  TextureDescription description;
  description.name = fmt::format("textures {}", scene_.textures.size());
  description.value_type = "float";
  description.entity = EntityMaker("scale", at).texture("tex", texture).texture("scale", texture).made();
  scene_.textures.push_back(description);
  return description.name;
}

std::array<double, 3> GltfTextures::mean_colour(const GltfTexture& texture) {
  const Decoded& from = decoded(texture);
  const std::vector<double> linear = from.linear();
  std::array<double, 3> sum{};
  for (std::size_t i = 0; i < from.pixels(); ++i)
    for (std::size_t c = 0; c < 3; ++c) sum[c] += linear[from.sample(i, c)];
  for (double& each : sum) each /= static_cast<double>(from.pixels());
  return sum;
}

double GltfTextures::least_alpha(const GltfTexture& texture) {
  const Decoded& from = decoded(texture);
  double least = 1;
  for (std::size_t i = 0; i < from.pixels(); ++i) least = std::min(least, from.opacity(i));
  return least;
}

}  // namespace petzval::render
