// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/render/textures/normal_map.h>
#include <petzval/render/textures/texture_library.h>

namespace petzval::render {

namespace {

TextureMapping mapping_of(const TextureDescription& description, Unsupported& unsupported) {
  const Parameters& parameters = description.entity.parameters;
  TextureMapping mapping;
  mapping.texture_from_world = description.world_from_texture.inverse();
  const std::string kind = parameters.string("mapping", "uv");
  mapping.offset_u = parameters.number("udelta", 0);
  mapping.offset_v = parameters.number("vdelta", 0);
  if (kind == "uv") {
    mapping.scale_u = parameters.number("uscale", 1);
    mapping.scale_v = parameters.number("vscale", 1);
    mapping.s_from_v = parameters.number("sfromv", 0);
    mapping.t_from_u = parameters.number("tfromu", 0);
  } else if (kind == "spherical") {
    mapping.kind = TextureMapping::Kind::spherical;
  } else if (kind == "cylindrical") {
    mapping.kind = TextureMapping::Kind::cylindrical;
  } else if (kind == "planar") {
    mapping.kind = TextureMapping::Kind::planar;
    if (const auto axis = parameters.triple("v1")) mapping.axis_s = {(*axis)[0], (*axis)[1], (*axis)[2]};
    if (const auto axis = parameters.triple("v2")) mapping.axis_t = {(*axis)[0], (*axis)[1], (*axis)[2]};
  } else {
    unsupported.report(parameters.location_of("mapping"), fmt::format("the texture mapping \"{}\"", kind));
  }
  return mapping;
}

template <class Map>
auto named_texture(const Map& textures, const Parameter& parameter, const char* kind) {
  const auto found = parameter.strings.size() == 1 ? textures.find(parameter.strings[0]) : textures.end();
  if (found == textures.end())
    throw scene_error(parameter.at,
                      fmt::format("there is no {} texture \"{}\" for \"{}\"", kind,
                                  parameter.strings.empty() ? "" : parameter.strings[0], parameter.name));
  return found->second;
}

}  // namespace

TextureLibrary::TextureLibrary(const SceneDescription& scene, const WavelengthGroups& groups,
                               Unsupported& unsupported)
    : groups_(groups), unsupported_(unsupported) {
  for (const TextureDescription& description : scene.textures) {
    if (description.value_type == "normal")
      normals_[description.name] = make_normal_map(description);
    else if (description.value_type == "float")
      floats_[description.name] = make_float(description);
    else
      spectra_[description.name] = make_spectrum(description);
    unsupported_.report_unused(description.entity.parameters,
                               fmt::format("texture \"{}\"", description.entity.type));
  }
}

FloatTexture TextureLibrary::float_parameter(const Parameters& parameters, const std::string& name) const {
  const Parameter* parameter = parameters.find(name);
  if (!parameter) return nullptr;
  if (parameter->type == "texture") return named_texture(floats_, *parameter, "float");
  return std::make_shared<ConstantFloat>(parameters.number(name, 0));
}

FloatTexture TextureLibrary::float_parameter(const Parameters& parameters, const std::string& name,
                                             double otherwise) const {
  FloatTexture texture = float_parameter(parameters, name);
  return texture ? texture : std::make_shared<ConstantFloat>(otherwise);
}

SpectrumTexture TextureLibrary::spectrum_parameter(const Parameters& parameters, const std::string& name,
                                                   SpectrumRole role) const {
  if (const Parameter* texture = parameters.find(name, {"texture"})) {
    const auto number = texture->strings.size() == 1 ? floats_.find(texture->strings[0]) : floats_.end();
    if (role == SpectrumRole::unbounded && number != floats_.end() && !spectra_.contains(texture->strings[0]))
      return std::make_shared<SameForAllWavelengths>(number->second);
    return named_texture(spectra_, *texture, "spectrum");
  }
  const std::optional<SceneSpectrum> spectrum =
      render::spectrum_parameter(parameters, name, role, unsupported_);
  if (!spectrum) return nullptr;
  return std::make_shared<ConstantSpectrum>(groups_.sampled(spectrum->at));
}

SpectrumTexture TextureLibrary::spectrum_parameter(const Parameters& parameters, const std::string& name,
                                                   SpectrumRole role, double otherwise) const {
  SpectrumTexture texture = spectrum_parameter(parameters, name, role);
  return texture ? texture
                 : std::make_shared<ConstantSpectrum>(groups_.sampled([&](double) { return otherwise; }));
}

const std::shared_ptr<const ReflectanceTable>& TextureLibrary::reflectances() {
  if (!reflectances_) reflectances_ = std::make_shared<const ReflectanceTable>();
  return reflectances_;
}

std::shared_ptr<const PictureFile> TextureLibrary::picture_file(const Parameters& parameters) {
  const std::string encoding = parameters.string("encoding", "");
  if (!encoding.empty() && encoding != "sRGB" && encoding != "linear")
    unsupported_.report(parameters.location_of("encoding"), fmt::format("the encoding \"{}\"", encoding));
  const std::string name = parameters.string("filename", "");
  if (name.empty()) throw scene_error(parameters.location(), "an imagemap needs a \"string filename\"");
  const std::string path = resolved_path(parameters.location(), name);
  std::shared_ptr<const PictureFile>& picture = pictures_[path + "\n" + encoding];
  if (!picture) try {
      picture = std::make_shared<const PictureFile>(
          read_picture_file(path, encoding == "sRGB"     ? PictureEncoding::srgb
                                  : encoding == "linear" ? PictureEncoding::linear
                                                         : PictureEncoding::by_format));
    } catch (const InputError& error) {
      throw scene_error(parameters.location_of("filename"), error.what());
    }
  return picture;
}

PictureSampler TextureLibrary::picture(const Parameters& parameters, PictureTextureOptions& options,
                                       const TextureDescription& description) {
  options.mapping = mapping_of(description, unsupported_);
  options.scale = parameters.number("scale", 1);
  options.invert = parameters.boolean("invert", false);
  const std::string wrap = parameters.choice("wrap", "repeat", {"repeat", "black", "clamp", "mirror"});
  const std::string filter =
      parameters.string("filter", "bilinear");  // all but "point" are taken for bilinear
  parameters.number("maxanisotropy", 8);
  const auto picture = description.picture ? description.picture : picture_file(parameters);
  return {picture,
          wrap == "repeat"   ? PictureWrap::repeat
          : wrap == "clamp"  ? PictureWrap::clamp
          : wrap == "mirror" ? PictureWrap::mirror
                             : PictureWrap::black,
          filter != "point"};
}

std::shared_ptr<const NormalMap> TextureLibrary::make_normal_map(const TextureDescription& description) {
  const Parameters& parameters = description.entity.parameters;
  PictureTextureOptions options;
  PictureSampler sampler = picture(parameters, options, description);
  return std::make_shared<const NormalMap>(std::move(sampler), options.mapping, options.scale, true);
}

std::shared_ptr<const NormalMap> TextureLibrary::normal_map(const Parameters& parameters) const {
  const Parameter* given = parameters.find("normalmap");
  if (!given) return nullptr;
  if (given->type == "texture") return named_texture(normals_, *given, "normal");
  const std::string name = parameters.string("normalmap", "");
  try {
    auto picture = std::make_shared<const PictureFile>(
        read_picture_file(resolved_path(given->at, name), PictureEncoding::linear));
    if (picture->channels != 3) throw InputError(name, "is grey; a normal map has three channels");
    return std::make_shared<const NormalMap>(PictureSampler(std::move(picture), PictureWrap::repeat, true),
                                             TextureMapping(), 1, false);
  } catch (const InputError& error) {
    throw scene_error(given->at, error.what());
  }
}

FloatTexture TextureLibrary::make_float(const TextureDescription& description) {
  const std::string& type = description.entity.type;
  const Parameters& parameters = description.entity.parameters;
  if (type == "constant") return float_parameter(parameters, "value", 1);
  if (type == "scale")
    return std::make_shared<ScaledTexture<double>>(float_parameter(parameters, "tex", 1),
                                                   float_parameter(parameters, "scale", 1));
  if (type == "mix")
    return std::make_shared<MixedTexture<double>>(float_parameter(parameters, "tex1", 0),
                                                  float_parameter(parameters, "tex2", 1),
                                                  float_parameter(parameters, "amount", 0.5));
  if (type == "checkerboard") {
    const bool solid = parameters.integer("dimension", 2) == 3;
    return std::make_shared<Checkerboard<double>>(float_parameter(parameters, "tex1", 1),
                                                  float_parameter(parameters, "tex2", 0),
                                                  mapping_of(description, unsupported_), solid);
  }
  if (type == "imagemap") {
    PictureTextureOptions options;
    PictureSampler sampler = picture(parameters, options, description);
    return std::make_shared<FloatPicture>(std::move(sampler), std::move(options));
  }
  unsupported_.report(parameters.location(), fmt::format("Texture \"{}\"", type));
  for (const Parameter* each : parameters.unused()) each->used = true;
  return std::make_shared<ConstantFloat>(1);
}

SpectrumTexture TextureLibrary::make_spectrum(const TextureDescription& description) {
  const std::string& type = description.entity.type;
  const Parameters& parameters = description.entity.parameters;
  const SpectrumRole role = SpectrumRole::albedo;
  if (type == "constant") return spectrum_parameter(parameters, "value", role, 1);
  if (type == "scale")
    return std::make_shared<ScaledTexture<Lanes>>(spectrum_parameter(parameters, "tex", role, 1),
                                                  float_parameter(parameters, "scale", 1));
  if (type == "mix")
    return std::make_shared<MixedTexture<Lanes>>(spectrum_parameter(parameters, "tex1", role, 0),
                                                 spectrum_parameter(parameters, "tex2", role, 1),
                                                 float_parameter(parameters, "amount", 0.5));
  if (type == "checkerboard") {
    const bool solid = parameters.integer("dimension", 2) == 3;
    return std::make_shared<Checkerboard<Lanes>>(spectrum_parameter(parameters, "tex1", role, 1),
                                                 spectrum_parameter(parameters, "tex2", role, 0),
                                                 mapping_of(description, unsupported_), solid);
  }
  if (type == "imagemap") {
    PictureTextureOptions options;
    PictureSampler sampler = picture(parameters, options, description);
    return std::make_shared<SpectrumPicture>(std::move(sampler), std::move(options), groups_, reflectances());
  }
  unsupported_.report(parameters.location(), fmt::format("Texture \"{}\"", type));
  for (const Parameter* each : parameters.unused()) each->used = true;
  return std::make_shared<ConstantSpectrum>(groups_.sampled([](double) { return 0.5; }));
}

}  // namespace petzval::render
