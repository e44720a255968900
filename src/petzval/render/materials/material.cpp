// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/whole_file.h>
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

/// \param layer  "conductor." and the like: what the names of its parameters begin with.
std::array<FloatTexture, 2> read_roughness(const Parameters& parameters, const TextureLibrary& textures,
                                           const std::string& layer = "") {
  const FloatTexture both = textures.float_parameter(parameters, layer + "roughness", 0);
  std::array result{textures.float_parameter(parameters, layer + "uroughness"),
                    textures.float_parameter(parameters, layer + "vroughness")};
  for (FloatTexture& each : result)
    if (!each) each = both;
  return result;
}

void read_roughness(const Parameters& parameters, const TextureLibrary& textures, Material& material) {
  const auto [u, v] = read_roughness(parameters, textures);
  material.roughness_u = u, material.roughness_v = v;
  material.remap_roughness = parameters.boolean("remaproughness", true);
}

Microfacets facets_at(const FloatTexture& roughness_u, const FloatTexture& roughness_v, bool remap,
                      const TexturePoint& point, int group) {
  const auto alpha = [&](const FloatTexture& roughness) {
    const double value = std::clamp(roughness->at(point, group), 0.0, 1.0);
    return remap ? std::sqrt(value) : value;
  };
  const double u = alpha(roughness_u);
  return {u, roughness_v == roughness_u ? u : alpha(roughness_v)};
}

Microfacets facets_at(const Material& material, const TexturePoint& point, int group) {
  return facets_at(material.roughness_u, material.roughness_v, material.remap_roughness, point, group);
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
  if (parameters.find("scale", {"texture"})) {
    const FloatTexture scale = textures.float_parameter(parameters, "scale");
    for (SpectrumTexture* each : {&material.reflectance, &material.transmittance})
      *each = std::make_shared<ScaledTexture<Lanes>>(*each, scale);
  } else {
    material.transmittance_scale = parameters.number("scale", 1);
  }
}

/// What materials share.
struct SharedParts {
  std::map<double, std::shared_ptr<const CoatingAlbedo>> coatings;      ///< by index
  std::map<std::string, std::shared_ptr<const MeasuredBrdf>> measured;  ///< by path
  std::shared_ptr<const Sheen> sheen;
};

/// Of a coat in which light is scattered, if not given; pbrt-v4's.
constexpr double thickness_of_turbid = 0.01;

/// Index of a coat, one number: of a glass at the d line.
double read_coat_index(const Parameters& parameters, const char* name, Unsupported& unsupported) {
  constexpr double d_line_nm = 587.56, otherwise = 1.5;
  if (const Parameter* texture = parameters.find(name, {"texture"})) {
    unsupported.report(texture->at, fmt::format("a texture of \"{}\"", name));
    return otherwise;
  }
  const auto spectrum = spectrum_parameter(parameters, name, SpectrumRole::unbounded, unsupported);
  const double index = spectrum ? spectrum->at(d_line_nm) : otherwise;
  if (!(index > 1 && index < 4))
    throw scene_error(parameters.location_of(name),
                      fmt::format("a coating of index {}; above 1 and below 4 would be right", index));
  return index;
}

/// What scatters light inside a coat: "albedo" and "g" of pbrt-v4.
void read_turbidity(const Parameters& parameters, const TextureLibrary& textures, Material& material) {
  material.coat_g = textures.float_parameter(parameters, "g", 0);
  if (material.coat_g->is_constant() && !(std::abs(material.coat_g->at({}, 0)) < 1))
    throw scene_error(parameters.location_of("g"), "a mean cosine above -1 and below 1 would be right");
  const Parameter* albedo = parameters.find("albedo");
  if (albedo && (albedo->type == "texture" || albedo->numbers.empty() ||
                 std::ranges::any_of(albedo->numbers, [](double each) { return each != 0; })))
    material.coat_albedo = textures.spectrum_parameter(parameters, "albedo", SpectrumRole::albedo);
}

/// What a clear coat is: pbrt-v4's parameters of coateddiffuse and coatedconductor.
const Layering& read_layering(const Parameters& parameters, const TextureLibrary& textures,
                              Unsupported& unsupported, const char* eta, Material& material) {
  Layering& layering = material.layering;
  layering.eta = read_coat_index(parameters, eta, unsupported);
  read_turbidity(parameters, textures, material);
  if (parameters.find("thickness", {"texture"}))
    material.coat_thickness = textures.float_parameter(parameters, "thickness");
  else
    layering.thickness = parameters.number("thickness", material.coat_albedo ? thickness_of_turbid : 0);
  if (!(layering.thickness >= 0))
    throw scene_error(parameters.location_of("thickness"), "0 or more would be right");
  const auto count = [&](const char* name, int otherwise) {
    const int value = parameters.integer(name, otherwise);
    if (parameters.find(name) && !(value >= 1 && value <= 1000))
      throw scene_error(parameters.location_of(name), "a number from 1 to 1000 would be right");
    return value;
  };
  layering.max_depth = count("maxdepth", 0);
  layering.walks = count("nsamples", 1);
  return layering;
}

void read_coated_diffuse(const Parameters& parameters, const TextureLibrary& textures,
                         Unsupported& unsupported, SharedParts& shared, Material& material) {
  material.kind = Material::Kind::coated_diffuse;
  material.reflectance = textures.spectrum_parameter(parameters, "reflectance", SpectrumRole::albedo, 0.5);
  read_roughness(parameters, textures, material);
  const double eta = read_layering(parameters, textures, unsupported, "eta", material).eta;
  material.reflectance_through_coating = parameters.boolean("throughcoating", false);
  // The closed form has all orders of reflection and nothing that is absorbed.
  if (material.layering.thickness > 0 || material.coat_thickness || material.layering.max_depth > 0)
    material.kind = Material::Kind::layered;
  std::shared_ptr<const CoatingAlbedo>& coating = shared.coatings[eta];
  if (!coating) coating = std::make_shared<const CoatingAlbedo>(eta);
  material.coating = coating;
}

/// \param layer  as for read_roughness().
void read_metal(const Parameters& parameters, const TextureLibrary& textures, Material& material,
                const Location& at, const std::string& layer = "") {
  material.reflectance = textures.spectrum_parameter(parameters, "reflectance", SpectrumRole::albedo);
  material.eta = textures.spectrum_parameter(parameters, layer + "eta", SpectrumRole::unbounded);
  material.k = textures.spectrum_parameter(parameters, layer + "k", SpectrumRole::unbounded);
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

void read_conductor(const Parameters& parameters, const TextureLibrary& textures, Material& material,
                    const Location& at) {
  material.kind = Material::Kind::conductor;
  read_roughness(parameters, textures, material);
  read_metal(parameters, textures, material, at);
}

void read_coated_conductor(const Parameters& parameters, const TextureLibrary& textures,
                           Unsupported& unsupported, Material& material, const Location& at) {
  material.kind = Material::Kind::layered;
  read_layering(parameters, textures, unsupported, "interface.eta", material);
  material.layering.metal = true;
  const auto [u, v] = read_roughness(parameters, textures, "interface.");
  material.roughness_u = u, material.roughness_v = v;
  const auto [base_u, base_v] = read_roughness(parameters, textures, "conductor.");
  material.base_roughness_u = base_u, material.base_roughness_v = base_v;
  material.remap_roughness = parameters.boolean("remaproughness", true);
  read_metal(parameters, textures, material, at, "conductor.");
}

/// The boundary of pbrt-v4's "subsurface"; what is below it is a medium (make_subsurface()).
void read_subsurface(const Parameters& parameters, const TextureLibrary& textures, Material& material) {
  material.kind = Material::Kind::dielectric;
  material.eta = textures.spectrum_parameter(parameters, "eta", SpectrumRole::unbounded, 1.33);
  read_roughness(parameters, textures, material);
  for (const char* name : {"sigma_a", "sigma_s", "reflectance", "mfp", "scale", "g", "name"})
    parameters.find(name);
}

void read_measured(const Parameters& parameters, const TextureLibrary& textures, SharedParts& shared,
                   Material& material) {
  material.kind = Material::Kind::measured;
  const std::string name = parameters.string("filename", "");
  if (name.empty())
    throw scene_error(parameters.location(), "a measured material needs \"string filename\", a .bsdf file");
  const Location& at = parameters.location_of("filename");
  const std::string path = resolved_path(at, name);
  std::shared_ptr<const MeasuredBrdf>& measured = shared.measured[path];
  if (!measured) try {
      measured = std::make_shared<const MeasuredBrdf>(read_whole_file(path), name, textures.groups());
    } catch (const InputError& error) {
      throw scene_error(at, error.what());
    }
  material.measured = measured;
}

/// Petzval's own, for KHR_materials_sheen of glTF.
void read_sheen(const Parameters& parameters, const TextureLibrary& textures, Unsupported& unsupported,
                SharedParts& shared, Material& material) {
  using enum Material::Kind;
  const Parameter* colour = parameters.find("sheencolor");
  if (!colour) return;
  if (material.kind != diffuse && material.kind != coated_diffuse && material.kind != conductor)
    return unsupported.report(colour->at, "sheen on a material of this kind");
  material.sheen_colour = textures.spectrum_parameter(parameters, "sheencolor", SpectrumRole::albedo, 0);
  material.sheen_roughness = textures.float_parameter(parameters, "sheenroughness", 0);
  if (!shared.sheen) shared.sheen = std::make_shared<const Sheen>();
  material.sheen = shared.sheen;
}

/// What tilts its shading normal.
void read_tilt(const Parameters& parameters, const TextureLibrary& textures, Material& material) {
  material.normal_map = textures.normal_map(parameters);
  if (material.kind == Material::Kind::mix || material.kind == Material::Kind::none) return;
  const FloatTexture height = textures.float_parameter(parameters, "displacement");
  if (!height || height->is_constant()) return;
  if (material.normal_map)
    throw scene_error(parameters.location_of("displacement"),
                      "a material with both a normal map and a displacement; one of them would be right");
  material.bump_map = std::make_shared<const BumpMap>(height);
}

void read_mix(const SceneDescription& scene, const Parameters& parameters, const TextureLibrary& textures,
              Unsupported& unsupported, Material& material) {
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
    if (scene.materials[static_cast<std::size_t>(found->second)].type == "subsurface")
      unsupported.report(names->at, "a mix with a subsurface material");
  }
}

/// Of a metal, against air: its index, real and imaginary.
std::array<Lanes, 2> metal_at(const Material& metal, const TexturePoint& point, int group) {
  if (!metal.reflectance) return {metal.eta->at(point, group), metal.k->at(point, group)};
  // The k at eta = 1 that reflects as much at normal incidence (pbrt-v4).
  const Lanes r = clamped_albedo(metal.reflectance->at(point, group));
  return {Lanes::all(1), mapped(r, [](float each) {
            const double value = std::min(static_cast<double>(each), 0.9999);
            return 2 * std::sqrt(value / (1 - value));
          })};
}

/// The reflectance of Lambert's surface under a coat.
Lanes base_at(const Material& material, const Microfacets& coat, const TexturePoint& point, int group) {
  const Lanes base = clamped_albedo(material.reflectance->at(point, group));
  return material.reflectance_through_coating
             ? below_coating(base, material.coating->inside_mean(coat.mean_alpha()))
             : base;
}

Material make_material(const SceneDescription& scene, const Entity& entity, const TextureLibrary& textures,
                       Unsupported& unsupported, SharedParts& shared) {
  const Parameters& parameters = entity.parameters;
  Material material;
  if (entity.type == "diffuse") {
    material.reflectance = textures.spectrum_parameter(parameters, "reflectance", SpectrumRole::albedo, 0.5);
  } else if (entity.type == "diffusetransmission") {
    read_diffuse_transmission(parameters, textures, material);
  } else if (entity.type == "coateddiffuse") {
    read_coated_diffuse(parameters, textures, unsupported, shared, material);
  } else if (entity.type == "coatedconductor") {
    read_coated_conductor(parameters, textures, unsupported, material, entity.location());
  } else if (entity.type == "conductor") {
    read_conductor(parameters, textures, material, entity.location());
  } else if (entity.type == "dielectric") {
    material.kind = Material::Kind::dielectric;
    material.eta = textures.spectrum_parameter(parameters, "eta", SpectrumRole::unbounded, 1.5);
    read_roughness(parameters, textures, material);
  } else if (entity.type == "subsurface") {
    read_subsurface(parameters, textures, material);
  } else if (entity.type == "measured") {
    read_measured(parameters, textures, shared, material);
  } else if (entity.type == "thindielectric") {
    material.kind = Material::Kind::thin_dielectric;
    material.eta = textures.spectrum_parameter(parameters, "eta", SpectrumRole::unbounded, 1.5);
  } else if (entity.type == "interface" || entity.type.empty() || entity.type == "none") {
    material.kind = Material::Kind::none;
  } else if (entity.type == "mix") {
    read_mix(scene, parameters, textures, unsupported, material);
  } else {
    unsupported.report(entity.location(),
                       fmt::format("Material \"{}\"{}", entity.type, name_now(entity.type)));
    material.reflectance = textures.spectrum_parameter(Parameters(), "", SpectrumRole::albedo, 0.5);
    return material;
  }
  parameters.find("type");
  read_sheen(parameters, textures, unsupported, shared, material);
  read_tilt(parameters, textures, material);
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
  Bsdf result = bare_bsdf(point, group, hero);
  if (!sheen) return result;
  const double roughness = std::clamp(sheen_roughness->at(point, group), 0.0, 1.0);
  result.cover(*sheen, clamped_albedo(sheen_colour->at(point, group)), roughness * roughness);
  return result;
}

Bsdf Material::bare_bsdf(const TexturePoint& point, int group, int hero) const {
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
      return Bsdf::coated_diffuse(base_at(*this, facets, point, group), coating->eta(), facets, *coating);
    }
    case Kind::layered:
      return layered_bsdf(point, group);
    case Kind::conductor: {
      const auto [n, absorption] = metal_at(*this, point, group);
      return Bsdf::conductor(n, absorption, facets_at(*this, point, group));
    }
    case Kind::dielectric:
      return Bsdf::dielectric(eta->at(point, group), hero, facets_at(*this, point, group));
    case Kind::thin_dielectric:
      return Bsdf::thin_dielectric(eta->at(point, group));
    case Kind::measured:
      return Bsdf::measured(*measured, group);
    case Kind::diffuse:
    case Kind::none:
    case Kind::mix:
      break;
  }
  return Bsdf::diffuse(reflectance ? clamped_albedo(reflectance->at(point, group)) : Lanes::all(0));
}

Bsdf Material::layered_bsdf(const TexturePoint& point, int group) const {
  const Microfacets coat = facets_at(*this, point, group);
  std::optional<double> thickness;
  if (coat_thickness) thickness = std::max(0.0, coat_thickness->at(point, group));
  const auto layered = [&] {
    if (!layering.metal)
      return Bsdf::layered(base_at(*this, coat, point, group), Lanes::all(0), coat, {0, 0}, layering,
                           thickness);
    const auto [n, absorption] = metal_at(*this, point, group);
    return Bsdf::layered(n, absorption, coat,
                         facets_at(base_roughness_u, base_roughness_v, remap_roughness, point, group),
                         layering, thickness);
  };
  Bsdf bsdf = layered();
  if (!coat_albedo || !(thickness.value_or(layering.thickness) > 0)) return bsdf;
  constexpr double most_g = 0.999;  // of a texture
  const double g = std::clamp(coat_g->at(point, group), -most_g, most_g);
  const Lanes albedo = clamped_albedo(coat_albedo->at(point, group));
  if (!albedo.is_black()) bsdf.make_turbid(albedo, g);
  return bsdf;
}

std::vector<Material> make_materials(const SceneDescription& scene, const TextureLibrary& textures,
                                     Unsupported& unsupported) {
  std::vector<Material> materials;
  materials.reserve(scene.materials.size());
  SharedParts shared;
  for (const Entity& entity : scene.materials)
    materials.push_back(make_material(scene, entity, textures, unsupported, shared));
  check_mixtures(materials, scene);
  return materials;
}

bool varies(const std::vector<Material>& materials, int index) {
  const Material& material = materials[static_cast<std::size_t>(index)];
  for (const SpectrumTexture* each : {&material.reflectance, &material.transmittance, &material.eta,
                                      &material.k, &material.sheen_colour, &material.coat_albedo})
    if (*each && !(*each)->is_constant()) return true;
  for (const FloatTexture* each :
       {&material.roughness_u, &material.roughness_v, &material.base_roughness_u, &material.base_roughness_v,
        &material.mix_amount, &material.sheen_roughness, &material.coat_thickness, &material.coat_g})
    if (*each && !(*each)->is_constant()) return true;
  if (material.normal_map || material.bump_map) return true;
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
