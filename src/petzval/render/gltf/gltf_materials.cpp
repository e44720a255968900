// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/colour/observer.h>
#include <petzval/render/gltf/gltf_extensions.h>
#include <petzval/render/gltf/gltf_materials.h>
#include <petzval/render/gltf/gltf_volume.h>
#include <petzval/render/pbrt/entity_maker.h>

#include <algorithm>
#include <limits>

namespace petzval::render {

namespace {

constexpr double unbounded = std::numeric_limits<double>::max();

bool is_white(const std::vector<double>& rgb) {
  return std::all_of(rgb.begin(), rgb.end(), [](double each) { return each == 1; });
}

}  // namespace

/// A material while it is read.
struct GltfMaterials::Reading {
  const tinygltf::Material& material;
  std::string path;  ///< "materials[2]"
  GltfExtension transmission, volume, ior, specular, strength, clearcoat, sheen;
  GltfTexture base{}, metal_and_roughness{}, emission{}, lean{}, coat{}, coat_roughness{}, sheen_colour{},
      sheen_roughness{};
  /// Names of textures; empty: the factors alone.
  std::string colour{}, metallic{}, alpha{}, normals{}, coat_share{}, coat_alpha{}, fibres{},
      fibre_roughness{};
  double index_of_refraction = 1.5, specular_factor = 1, coat_factor = 0, coat_roughness_factor = 0,
         sheen_roughness_factor = 0;
  std::array<double, 3> sheen_factor{0, 0, 0};

  Reading(const GltfFile& file, const tinygltf::Material& of, std::string at)
      : material(of),
        path(std::move(at)),
        transmission(file, of.extensions, "KHR_materials_transmission", path),
        volume(file, of.extensions, "KHR_materials_volume", path),
        ior(file, of.extensions, "KHR_materials_ior", path),
        specular(file, of.extensions, "KHR_materials_specular", path),
        strength(file, of.extensions, "KHR_materials_emissive_strength", path),
        clearcoat(file, of.extensions, "KHR_materials_clearcoat", path),
        sheen(file, of.extensions, "KHR_materials_sheen", path) {}

  bool shines_as_cloth() const { return sheen_factor != std::array<double, 3>{0, 0, 0}; }
  void with_sheen(EntityMaker& maker) const {
    if (!shines_as_cloth()) return;
    if (fibres.empty())
      maker.rgb("sheencolor", sheen_factor);
    else
      maker.texture("sheencolor", fibres);
    if (fibre_roughness.empty())
      maker.number("sheenroughness", sheen_roughness_factor);
    else
      maker.texture("sheenroughness", fibre_roughness);
  }

  const tinygltf::PbrMetallicRoughness& pbr() const { return material.pbrMetallicRoughness; }
  std::array<double, 3> base_factor() const {
    const std::vector<double>& f = pbr().baseColorFactor;
    return {f[0], f[1], f[2]};
  }
  int uv_set() const {
    for (const GltfTexture* texture :
         {&base, &metal_and_roughness, &lean, &coat, &coat_roughness, &sheen_colour, &sheen_roughness})
      if (*texture) return texture->uv_set;
    return -1;
  }
  void with_normals(EntityMaker& maker) const {
    if (!normals.empty()) maker.texture("normalmap", normals);
  }
  void with_colour(EntityMaker& maker) const {
    if (colour.empty())
      maker.rgb("reflectance", base_factor());
    else
      maker.texture("reflectance", colour);
  }
  void with_roughness(EntityMaker& maker, const char* name = "roughness") const {
    maker.flag("remaproughness", false);
    if (alpha.empty())
      maker.number(name, pbr().roughnessFactor * pbr().roughnessFactor);
    else
      maker.texture(name, alpha);
  }
  void with_coat(EntityMaker& maker, const char* name) const {
    if (coat_alpha.empty())
      maker.number(name, coat_roughness_factor * coat_roughness_factor);
    else
      maker.texture(name, coat_alpha);
  }
};

namespace {

/// \throws InputError unless all are from 0 to 1.
void check_factors(const GltfFile& file, const std::string& path, const std::vector<double>& values,
                   std::size_t count) {
  const bool right = values.size() == count && std::all_of(values.begin(), values.end(), [](double each) {
                       return each >= 0 && each <= 1;
                     });
  if (!right)
    throw scene_error(file.at(path), fmt::format("{} from 0 to 1 would be right",
                                                 count == 1 ? "a number" : fmt::format("{} numbers", count)));
}

}  // namespace

GltfSurface GltfMaterials::surface(int index, bool tinted, const std::string& path) {
  if (index >= 0) file_.entry(file_.model.materials, index, "materials", path + ".material");
  const std::pair key(index, tinted);
  const auto found = read_.find(key);
  return found != read_.end() ? found->second : read_.emplace(key, read(index, tinted)).first->second;
}

GltfSurface GltfMaterials::read(int index, bool tinted) {
  static const tinygltf::Material none;
  const tinygltf::Material& material =
      index < 0 ? none : file_.model.materials[static_cast<std::size_t>(index)];
  Reading reading(file_, material, fmt::format("materials[{}]", index));
  const std::string pbr = reading.path + ".pbrMetallicRoughness";
  check_factors(file_, pbr + ".baseColorFactor", reading.pbr().baseColorFactor, 4);
  check_factors(file_, pbr + ".metallicFactor", {reading.pbr().metallicFactor}, 1);
  check_factors(file_, pbr + ".roughnessFactor", {reading.pbr().roughnessFactor}, 1);
  reading.index_of_refraction = reading.ior.number("ior", 1.5, 1, 3.99);
  reading.specular_factor = reading.specular.number("specularFactor", 1, 0, 1);
  read_textures(reading);
  // A picture takes the colours of vertices; without one, a picture of one colour does.
  if (tinted && reading.colour.empty())
    reading.colour = textures_.add_flat(reading.base_factor(), file_.at(reading.path));

  GltfSurface surface;
  read_alpha(reading, surface);
  surface.uv_set = reading.uv_set();
  surface.area_light = add_emission(reading);
  const int filling = add_gltf_volume(file_, reading.volume, scene_);
  if (reading.transmission.number("transmissionFactor", 0, 0, 1) > 0) surface.medium = filling;
  if (reading.coat_factor == 0) {
    surface.material = add_surface(reading, false);
  } else if (reading.coat_factor == 1 && reading.coat_share.empty()) {
    surface.material = add_surface(reading, true);
  } else {
    const int bare = add_surface(reading, false), coated = add_surface(reading, true);
    surface.material =
        add_mix(bare, coated, reading.coat_factor, reading.coat_share, reading.clearcoat.path());
  }
  report_rest(reading);
  return surface;
}

int GltfMaterials::add_surface(const Reading& reading, bool under_coat) {
  const double metallic = reading.pbr().metallicFactor;
  if (metallic == 0) return add_body(reading, under_coat);
  if (metallic == 1 && reading.metallic.empty()) return add_metal(reading, under_coat);
  const int body = add_body(reading, under_coat), metal = add_metal(reading, under_coat);
  return add_mix(body, metal, metallic, reading.metallic, reading.path + ".pbrMetallicRoughness");
}

int GltfMaterials::add_mix(int first, int second, double amount, const std::string& texture,
                           const std::string& path) {
  EntityMaker mix("mix", file_.at(path));
  mix.text("materials", {fmt::format("gltf {}", first), fmt::format("gltf {}", second)});
  if (texture.empty())
    mix.number("amount", amount);
  else
    mix.texture("amount", texture);
  return add(mix.made());
}

void GltfMaterials::read_textures(Reading& reading) {
  const tinygltf::PbrMetallicRoughness& pbr = reading.pbr();
  const std::string path = reading.path + ".pbrMetallicRoughness";
  reading.base = textures_.reference(pbr.baseColorTexture.index, pbr.baseColorTexture.texCoord,
                                     pbr.baseColorTexture.extensions, path + ".baseColorTexture");
  const tinygltf::TextureInfo& second = pbr.metallicRoughnessTexture;
  reading.metal_and_roughness = textures_.reference(second.index, second.texCoord, second.extensions,
                                                    path + ".metallicRoughnessTexture");
  const tinygltf::TextureInfo& third = reading.material.emissiveTexture;
  reading.emission =
      textures_.reference(third.index, third.texCoord, third.extensions, reading.path + ".emissiveTexture");
  const tinygltf::NormalTextureInfo& fourth = reading.material.normalTexture;
  reading.lean =
      textures_.reference(fourth.index, fourth.texCoord, fourth.extensions, reading.path + ".normalTexture");
  if (reading.clearcoat.is_there()) read_coat(reading);
  if (reading.sheen.is_there()) read_sheen(reading);
  for (const GltfTexture* each : {&reading.metal_and_roughness, &reading.lean, &reading.coat,
                                  &reading.coat_roughness, &reading.sheen_colour, &reading.sheen_roughness})
    if (*each && each->uv_set != reading.uv_set())
      unsupported_.report(file_.at(each->path + ".texCoord"),
                          "another set of texture coordinates than that of the first texture");
  if (reading.lean) reading.normals = textures_.add_normals(reading.lean, fourth.scale);
  if (reading.base) reading.colour = textures_.add_colour(reading.base, reading.base_factor());
  if (!reading.metal_and_roughness) return;
  const double metallic = pbr.metallicFactor, roughness = pbr.roughnessFactor;
  if (metallic > 0) reading.metallic = textures_.add_channel(reading.metal_and_roughness, 2, metallic);
  if (roughness > 0)
    reading.alpha = textures_.add_square(textures_.add_channel(reading.metal_and_roughness, 1, roughness),
                                         file_.at(reading.metal_and_roughness.path));
}

void GltfMaterials::read_coat(Reading& reading) {
  GltfExtension& coat = reading.clearcoat;
  const auto texture = [&](const char* member) {
    const tinygltf::TextureInfo info = coat.texture(member);
    return textures_.reference(info.index, info.texCoord, info.extensions, coat.path() + "." + member);
  };
  reading.coat_factor = coat.number("clearcoatFactor", 0, 0, 1);
  reading.coat_roughness_factor = coat.number("clearcoatRoughnessFactor", 0, 0, 1);
  reading.coat = texture("clearcoatTexture");
  reading.coat_roughness = texture("clearcoatRoughnessTexture");
  const GltfTexture lean = texture("clearcoatNormalTexture");
  coat.report_rest(unsupported_);
  if (reading.coat_factor == 0) return;
  if (lean.index != reading.lean.index)
    unsupported_.report(file_.at(coat.path() + ".clearcoatNormalTexture"),
                        "a coat whose normals are not those of what it covers");
  if (reading.coat) reading.coat_share = textures_.add_channel(reading.coat, 0, reading.coat_factor);
  if (reading.coat_roughness && reading.coat_roughness_factor > 0)
    reading.coat_alpha =
        textures_.add_square(textures_.add_channel(reading.coat_roughness, 1, reading.coat_roughness_factor),
                             file_.at(reading.coat_roughness.path));
}

void GltfMaterials::read_sheen(Reading& reading) {
  GltfExtension& sheen = reading.sheen;
  const auto texture = [&](const char* member) {
    const tinygltf::TextureInfo info = sheen.texture(member);
    return textures_.reference(info.index, info.texCoord, info.extensions, sheen.path() + "." + member);
  };
  const std::vector<double> colour = sheen.numbers("sheenColorFactor", {0, 0, 0});
  check_factors(file_, sheen.path() + ".sheenColorFactor", colour, 3);
  std::copy(colour.begin(), colour.end(), reading.sheen_factor.begin());
  reading.sheen_roughness_factor = sheen.number("sheenRoughnessFactor", 0, 0, 1);
  reading.sheen_colour = texture("sheenColorTexture");
  reading.sheen_roughness = texture("sheenRoughnessTexture");
  sheen.report_rest(unsupported_);
  if (!reading.shines_as_cloth()) return;
  if (reading.coat_factor > 0) unsupported_.report(file_.at(sheen.path()), "sheen below a clear coat");
  GltfExtension transmission = reading.transmission;
  if (transmission.number("transmissionFactor", 0, 0, 1) > 0)
    unsupported_.report(file_.at(sheen.path()), "sheen on glass");
  if (reading.sheen_colour) reading.fibres = textures_.add_colour(reading.sheen_colour, reading.sheen_factor);
  if (reading.sheen_roughness)
    reading.fibre_roughness = textures_.add_opacity(reading.sheen_roughness, reading.sheen_roughness_factor);
}

void GltfMaterials::read_alpha(const Reading& reading, GltfSurface& surface) {
  const std::string& mode = reading.material.alphaMode;
  if (mode == "OPAQUE" || mode.empty()) return;
  if (mode != "MASK" && mode != "BLEND")
    throw scene_error(file_.at(reading.path + ".alphaMode"), "OPAQUE, MASK or BLEND would be right");
  surface.see_through = true;
  surface.opacity = reading.pbr().baseColorFactor[3];
  if (mode == "MASK") {
    surface.cutoff = reading.material.alphaCutoff;
    if (!(*surface.cutoff >= 0))
      throw scene_error(file_.at(reading.path + ".alphaCutoff"), "0 or more would be right");
  }
  // Pictures without transparency, as many exporters write them, cost nothing.
  if (reading.base && textures_.least_alpha(reading.base) < 1)
    surface.opacity_texture = textures_.add_opacity(reading.base, surface.opacity);
}

int GltfMaterials::add(Entity entity) {
  const int index = static_cast<int>(scene_.materials.size());
  scene_.materials.push_back(std::move(entity));
  scene_.named_materials[fmt::format("gltf {}", index)] = index;
  return index;
}

int GltfMaterials::add_metal(const Reading& reading, bool under_coat) {
  EntityMaker metal(under_coat ? "coatedconductor" : "conductor", file_.at(reading.path));
  reading.with_colour(metal);
  reading.with_roughness(metal, under_coat ? "conductor.roughness" : "roughness");
  if (under_coat) reading.with_coat(metal, "interface.roughness");
  reading.with_normals(metal);
  if (!under_coat) reading.with_sheen(metal);
  return add(metal.made());
}

int GltfMaterials::add_opaque(const Reading& reading, bool under_coat) {
  const bool coated = under_coat || (reading.specular_factor > 0 && reading.index_of_refraction > 1);
  EntityMaker body(coated ? "coateddiffuse" : "diffuse", file_.at(reading.path));
  reading.with_colour(body);
  reading.with_normals(body);
  if (!under_coat) reading.with_sheen(body);
  if (under_coat)
    reading.with_coat(body.flag("remaproughness", false), "roughness");
  else if (coated)
    reading.with_roughness(body);
  // The coat has the index of lacquer and fills the facets of what it covers.
  if (coated) body.number("eta", under_coat ? 1.5 : reading.index_of_refraction).flag("throughcoating", true);
  return add(body.made());
}

int GltfMaterials::add_glass(const Reading& reading) {
  GltfExtension volume = reading.volume;
  const bool thin = !is_gltf_body(volume);
  if (!reading.colour.empty() || reading.base_factor() != std::array<double, 3>{1, 1, 1})
    unsupported_.report(file_.at(reading.transmission.path()), "light that is coloured by passing a surface");
  EntityMaker glass(thin ? "thindielectric" : "dielectric", file_.at(reading.transmission.path()));
  glass.number("eta", reading.index_of_refraction);
  reading.with_normals(glass);
  if (!thin)
    reading.with_roughness(glass);
  else if (!reading.alpha.empty() || reading.pbr().roughnessFactor > 0.03)  // below, alpha makes a mirror
    unsupported_.report(file_.at(reading.path + ".pbrMetallicRoughness.roughnessFactor"),
                        "a thin sheet that is rough (KHR_materials_volume makes a body)");
  return add(glass.made());
}

int GltfMaterials::add_body(const Reading& reading, bool under_coat) {
  GltfExtension transmission = reading.transmission;
  const double share = transmission.number("transmissionFactor", 0, 0, 1);
  if (share == 0) return add_opaque(reading, under_coat);
  if (under_coat) unsupported_.report(file_.at(reading.clearcoat.path()), "a clear coat on glass");
  if (share == 1) return add_glass(reading);
  const int opaque = add_opaque(reading, under_coat), glass = add_glass(reading);
  return add_mix(opaque, glass, share, "", transmission.path());
}

int GltfMaterials::add_emission(const Reading& reading) {
  const std::vector<double>& factor = reading.material.emissiveFactor;
  if (factor.empty()) return -1;
  check_factors(file_, reading.path + ".emissiveFactor", factor, 3);
  GltfExtension strength = reading.strength;
  const double nit = strength.number("emissiveStrength", 1, 0, unbounded);
  std::array<double, 3> colour{factor[0], factor[1], factor[2]};
  if (*std::max_element(colour.begin(), colour.end()) == 0 || nit == 0) return -1;
  if (reading.emission) {
    unsupported_.report(file_.at(reading.emission.path), "a picture that shines");
    const std::array<double, 3> mean = textures_.mean_colour(reading.emission);
    for (std::size_t c = 0; c < 3; ++c) colour[c] *= mean[c];
  }
  scene_.area_lights.push_back(EntityMaker("diffuse", file_.at(reading.path + ".emissiveFactor"))
                                   .rgb("L", colour)
                                   .number("scale", nit / lumens_per_watt)
                                   .flag("twosided", reading.material.doubleSided)
                                   .made());
  return static_cast<int>(scene_.area_lights.size()) - 1;
}

void GltfMaterials::report_rest(const Reading& reading) {
  const auto report = [&](bool there, const std::string& path, const char* what) {
    if (there) unsupported_.report(file_.at(path), what);
  };
  // An occlusion map is what light in corners does; here it is followed.
  GltfExtension transmission = reading.transmission, volume = reading.volume, ior = reading.ior,
                specular = reading.specular, strength = reading.strength;
  transmission.number("transmissionFactor", 0, 0, 1);
  is_gltf_body(volume);
  ior.number("ior", 1.5, 0, 4);
  const double shine = specular.number("specularFactor", 1, 0, 1);
  report(shine > 0 && shine < 1, specular.path() + ".specularFactor",
         "a coating that reflects less than its index says");
  if (shine == 0 || is_white(specular.numbers("specularColorFactor", {1, 1, 1})))
    specular.numbers("specularColorFactor", {1, 1, 1});
  else
    report(true, specular.path() + ".specularColorFactor", "a coating that colours what it reflects");
  strength.number("emissiveStrength", 1, 0, unbounded);
  for (const GltfExtension* each : {&transmission, &volume, &ior, &specular, &strength})
    each->report_rest(unsupported_);
  report_gltf_extensions(
      file_, reading.material.extensions, reading.path,
      {"KHR_materials_transmission", "KHR_materials_volume", "KHR_materials_ior", "KHR_materials_specular",
       "KHR_materials_emissive_strength", "KHR_materials_clearcoat", "KHR_materials_sheen"},
      unsupported_);
}

}  // namespace petzval::render
