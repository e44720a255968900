// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/render/materials/material.h>

#include <algorithm>
#include <map>

namespace petzval::render {

namespace {

/// What materials of pbrt before version 4 are called now.
std::string name_now(const std::string& material) {
  static const std::map<std::string, const char*> now{
      {"matte", "diffuse"},         {"glass", "dielectric"},
      {"metal", "conductor"},       {"mirror", "conductor"},
      {"plastic", "coateddiffuse"}, {"substrate", "coateddiffuse"},
      {"uber", "coateddiffuse"},    {"translucent", "diffusetransmission"},
      {"roughglass", "dielectric"}, {"shinymetal", "conductor"}};
  const auto found = now.find(material);
  return found == now.end() ? "" : fmt::format(" of pbrt before version 4 (now \"{}\")", found->second);
}

void read_roughness(const Parameters& parameters, const TextureLibrary& textures, double otherwise,
                    Material& material) {
  FloatTexture both = textures.float_parameter(parameters, "roughness", otherwise);
  material.roughness_u = textures.float_parameter(parameters, "uroughness");
  material.roughness_v = textures.float_parameter(parameters, "vroughness");
  if (!material.roughness_u) material.roughness_u = both;
  if (!material.roughness_v) material.roughness_v = both;
  material.remap_roughness = parameters.boolean("remaproughness", true);
}

Microfacets facets_at(const Material& material, const TexturePoint& point, int group) {
  const auto alpha = [&](const FloatTexture& roughness) {
    const double value = std::clamp(roughness->at(point, group), 0.0, 1.0);
    return material.remap_roughness ? std::sqrt(value) : value;
  };
  const double u = alpha(material.roughness_u);
  return {u, material.roughness_v == material.roughness_u ? u : alpha(material.roughness_v)};
}

Lanes clamped_albedo(Lanes value) {
  for (float& each : value.v) each = std::clamp(each, 0.0f, 1.0f);
  return value;
}

/// The reflectance of a base of whose light, reflected from below by the coating again and again, the share
/// `seen` comes out: seen = base (1 − inside)/(1 − base · inside), solved for the base.
Lanes below_coating(Lanes seen, double inside) {
  for (float& each : seen.v) {
    const double out = static_cast<double>(each);
    each = static_cast<float>(out / (1 - inside + out * inside));
  }
  return seen;
}

void read_diffuse_transmission(const Parameters& parameters, const TextureLibrary& textures,
                               Material& material) {
  material.kind = Material::Kind::diffuse_transmission;
  material.reflectance = textures.spectrum_parameter(parameters, "reflectance", SpectrumRole::albedo, 0.25);
  material.transmittance =
      textures.spectrum_parameter(parameters, "transmittance", SpectrumRole::albedo, 0.25);
  material.transmittance_scale = parameters.number("scale", 1);
}

/// By index: what materials share.
using Coatings = std::map<double, std::shared_ptr<const CoatingAlbedo>>;

void read_coated_diffuse(const Parameters& parameters, const TextureLibrary& textures,
                         Unsupported& unsupported, Coatings& coatings, Material& material) {
  material.kind = Material::Kind::coated_diffuse;
  material.reflectance = textures.spectrum_parameter(parameters, "reflectance", SpectrumRole::albedo, 0.5);
  read_roughness(parameters, textures, 0, material);
  const double eta = parameters.number("eta", 1.5);
  if (!(eta > 1 && eta < 4))
    throw scene_error(parameters.location_of("eta"),
                      fmt::format("a coating of index {}; above 1 and below 4 would be right", eta));
  std::shared_ptr<const CoatingAlbedo>& coating = coatings[eta];
  if (!coating) coating = std::make_shared<const CoatingAlbedo>(eta);
  material.coating = coating;
  material.reflectance_through_coating = parameters.boolean("throughcoating", false);
  // A clear coating without thickness: how its light is scattered at random, and how far it travels, do not
  // matter.
  for (const char* ignored : {"thickness", "maxdepth", "nsamples", "g"}) parameters.find(ignored);
  if (const Parameter* albedo = parameters.find("albedo"))
    if (std::any_of(albedo->numbers.begin(), albedo->numbers.end(), [](double v) { return v != 0; }))
      unsupported.report(albedo->at, "a medium inside a coating");
}

void read_conductor(const Parameters& parameters, const TextureLibrary& textures, Material& material,
                    const Location& at) {
  material.kind = Material::Kind::conductor;
  read_roughness(parameters, textures, 0, material);
  material.reflectance = textures.spectrum_parameter(parameters, "reflectance", SpectrumRole::albedo);
  material.eta = textures.spectrum_parameter(parameters, "eta", SpectrumRole::unbounded);
  material.k = textures.spectrum_parameter(parameters, "k", SpectrumRole::unbounded);
  if (material.reflectance && (material.eta || material.k))
    throw scene_error(at, "a conductor has either a reflectance or eta and k");
  if (material.reflectance || (material.eta && material.k)) return;
  if (material.eta || material.k)
    throw scene_error(at, "a conductor with eta needs k, and the other way round");
  Parameters copper;
  copper.add({"spectrum", "eta", at, {}, {"metal-Cu-eta"}, {}});
  copper.add({"spectrum", "k", at, {}, {"metal-Cu-k"}, {}});
  material.eta = textures.spectrum_parameter(copper, "eta", SpectrumRole::unbounded);
  material.k = textures.spectrum_parameter(copper, "k", SpectrumRole::unbounded);
}

void read_mix(const SceneDescription& scene, const Parameters& parameters, const TextureLibrary& textures,
              Material& material) {
  material.kind = Material::Kind::mix;
  material.mix_amount = textures.float_parameter(parameters, "amount", 0.5);
  const Parameter* names = parameters.find("materials", {"string"});
  if (!names || names->strings.size() != 2)
    throw scene_error(parameters.location(), "a mix needs \"string materials\" with two names");
  for (std::size_t i = 0; i < 2; ++i) {
    const auto found = scene.named_materials.find(names->strings[i]);
    if (found == scene.named_materials.end())
      throw scene_error(names->at, fmt::format("there is no material \"{}\" to mix", names->strings[i]));
    material.mixed[i] = found->second;
  }
}

Material make_material(const SceneDescription& scene, const Entity& entity, const TextureLibrary& textures,
                       Unsupported& unsupported, Coatings& coatings) {
  const Parameters& parameters = entity.parameters;
  Material material;
  if (entity.type == "diffuse") {
    material.reflectance = textures.spectrum_parameter(parameters, "reflectance", SpectrumRole::albedo, 0.5);
  } else if (entity.type == "diffusetransmission") {
    read_diffuse_transmission(parameters, textures, material);
  } else if (entity.type == "coateddiffuse") {
    read_coated_diffuse(parameters, textures, unsupported, coatings, material);
  } else if (entity.type == "conductor") {
    read_conductor(parameters, textures, material, entity.location());
  } else if (entity.type == "dielectric") {
    material.kind = Material::Kind::dielectric;
    material.eta = textures.spectrum_parameter(parameters, "eta", SpectrumRole::unbounded, 1.5);
    read_roughness(parameters, textures, 0, material);
  } else if (entity.type == "thindielectric") {
    material.kind = Material::Kind::thin_dielectric;
    material.eta = textures.spectrum_parameter(parameters, "eta", SpectrumRole::unbounded, 1.5);
  } else if (entity.type == "interface" || entity.type.empty() || entity.type == "none") {
    material.kind = Material::Kind::none;
  } else if (entity.type == "mix") {
    read_mix(scene, parameters, textures, material);
  } else {
    unsupported.report(entity.location(),
                       fmt::format("Material \"{}\"{}", entity.type, name_now(entity.type)));
    material.reflectance = textures.spectrum_parameter(Parameters(), "", SpectrumRole::albedo, 0.5);
    return material;
  }
  parameters.find("type");
  material.normal_map = textures.normal_map(parameters);
  unsupported.report_unused(parameters, fmt::format("material \"{}\"", entity.type));
  return material;
}

/// A mixture that contains itself would never end: each may only refer to materials made before it.
void check_mixtures(const std::vector<Material>& materials, const SceneDescription& scene) {
  for (std::size_t i = 0; i < materials.size(); ++i)
    for (const int part : materials[i].mixed)
      if (materials[i].kind == Material::Kind::mix && static_cast<std::size_t>(part) >= i)
        throw scene_error(scene.materials[i].location(),
                          "this mix names a material that is made after it; the other order would be right");
}

}  // namespace

Bsdf Material::bsdf(const TexturePoint& point, int group, int hero) const {
  switch (kind) {
    case Kind::diffuse_transmission: {
      Lanes r = clamped_albedo(transmittance_scale * reflectance->at(point, group));
      Lanes t = clamped_albedo(transmittance_scale * transmittance->at(point, group));
      for (int i = 0; i < lane_count; ++i)  // no more than all light
        if (r[i] + t[i] > 1) {
          const float sum = r[i] + t[i];
          r[i] /= sum, t[i] /= sum;
        }
      return Bsdf::diffuse(r, t);
    }
    case Kind::coated_diffuse: {
      const Microfacets facets = facets_at(*this, point, group);
      Lanes base = clamped_albedo(reflectance->at(point, group));
      if (reflectance_through_coating) base = below_coating(base, coating->inside_mean(facets.mean_alpha()));
      return Bsdf::coated_diffuse(base, coating->eta(), facets, *coating);
    }
    case Kind::conductor: {
      const Microfacets facets = facets_at(*this, point, group);
      if (!reflectance) return Bsdf::conductor(eta->at(point, group), k->at(point, group), facets);
      // The k at eta = 1 that reflects as much at normal incidence (pbrt-v4).
      const Lanes r = clamped_albedo(reflectance->at(point, group));
      return Bsdf::conductor(Lanes::all(1),
                             mapped(r,
                                    [](float each) {
                                      const double value = std::min(static_cast<double>(each), 0.9999);
                                      return 2 * std::sqrt(value / (1 - value));
                                    }),
                             facets);
    }
    case Kind::dielectric:
      return Bsdf::dielectric(eta->at(point, group), hero, facets_at(*this, point, group));
    case Kind::thin_dielectric:
      return Bsdf::thin_dielectric(eta->at(point, group));
    case Kind::diffuse:
    case Kind::none:
    case Kind::mix:
      break;
  }
  return Bsdf::diffuse(reflectance ? clamped_albedo(reflectance->at(point, group)) : Lanes::all(0));
}

std::vector<Material> make_materials(const SceneDescription& scene, const TextureLibrary& textures,
                                     Unsupported& unsupported) {
  std::vector<Material> materials;
  materials.reserve(scene.materials.size());
  Coatings coatings;
  for (const Entity& entity : scene.materials)
    materials.push_back(make_material(scene, entity, textures, unsupported, coatings));
  check_mixtures(materials, scene);
  return materials;
}

bool varies(const std::vector<Material>& materials, int index) {
  const Material& material = materials[static_cast<std::size_t>(index)];
  for (const SpectrumTexture* each :
       {&material.reflectance, &material.transmittance, &material.eta, &material.k})
    if (*each && !(*each)->is_constant()) return true;
  for (const FloatTexture* each : {&material.roughness_u, &material.roughness_v, &material.mix_amount})
    if (*each && !(*each)->is_constant()) return true;
  if (material.normal_map) return true;
  return material.kind == Material::Kind::mix &&
         (varies(materials, material.mixed[0]) || varies(materials, material.mixed[1]));
}

const Material& material_at(const std::vector<Material>& materials, int index, const TexturePoint& point,
                            int group, double choice) {
  const Material* material = &materials[static_cast<std::size_t>(index)];
  while (material->kind == Material::Kind::mix) {
    const double amount = std::clamp(material->mix_amount->at(point, group), 0.0, 1.0);
    const bool second = choice < amount;
    choice = second ? choice / amount : (choice - amount) / (1 - amount);
    material = &materials[static_cast<std::size_t>(material->mixed[second ? 1 : 0])];
  }
  return *material;
}

}  // namespace petzval::render
