// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/whole_file.h>
#include <petzval/render/lights/alter_lights.h>
#include <petzval/render/media/diffuse_albedo.h>
#include <petzval/render/media/emission_reader.h>
#include <petzval/render/media/medium.h>
#include <petzval/render/media/named_media.h>
#include <petzval/render/media/nanovdb_file.h>
#include <petzval/render/media/varied_medium.h>
#include <petzval/render/pbrt/entity_maker.h>
#include <petzval/render/spectra/named_spectra.h>
#include <petzval/render/textures/texture_library.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>

namespace petzval::render {

namespace {

/// pbrt-v4's.
constexpr double subsurface_index = 1.33;

/// The coefficient `name` times `scale`.
BandSpectrum read_coefficient(const Parameters& parameters, const char* name, double otherwise, double scale,
                              const WavelengthGroups& groups, Unsupported& unsupported) {
  const auto given = spectrum_parameter(parameters, name, SpectrumRole::unbounded, unsupported);
  const SceneSpectrum spectrum = given ? *given : constant_spectrum(otherwise);
  return groups.sampled([&](double nm) {
    const double value = scale * spectrum.at(nm);
    if (!(value >= 0 && value <= densest))
      throw scene_error(
          parameters.location_of(name),
          fmt::format("a coefficient of {:g} at {:g} nm; 0 to {:g} would be right", value, nm, densest));
    return value;
  });
}

/// Petzval's own: what is left of light after a distance, as KHR_materials_volume of glTF has it.
BandSpectrum read_attenuation(const Parameters& parameters, double scale, const WavelengthGroups& groups,
                              Unsupported& unsupported) {
  const auto left = spectrum_parameter(parameters, "attenuation", SpectrumRole::albedo, unsupported);
  const double distance = parameters.number("attenuationdistance", 1);
  if (!(distance > 0 && std::isfinite(scale / distance)))
    throw scene_error(parameters.location_of("attenuationdistance"), "a distance above 0 would be right");
  return groups.sampled([&](double nm) {
    constexpr double least = 1e-6;  // black has no logarithm
    return -scale / distance * std::log(std::clamp(left->at(nm), least, 1.0));
  });
}

/// The coefficients of the measured medium that the parameter `which` names; of whole milk without it, as
/// pbrt-v4 does.
void read_named(const Parameters& parameters, const char* which, double scale, const WavelengthGroups& groups,
                Unsupported& unsupported, Medium& medium) {
  const std::string name = parameters.string(which, "Wholemilk");
  const NamedMedium* found = named_medium(name);
  if (!found) {
    unsupported.report(parameters.location_of(which), fmt::format("a medium named \"{}\"", name));
    found = named_medium("Wholemilk");
  }
  const Entity entity = EntityMaker("", parameters.location_of(which))
                            .rgb("sigma_a", found->absorption)
                            .rgb("sigma_s", found->scattering)
                            .made();
  medium.absorption = read_coefficient(entity.parameters, "sigma_a", 0, scale, groups, unsupported);
  medium.scattering = read_coefficient(entity.parameters, "sigma_s", 0, scale, groups, unsupported);
}

/// Coefficients that give light the colour "reflectance" and the mean free path "mfp", pbrt-v4's way.
void read_reflectance(const Parameters& parameters, double scale, const WavelengthGroups& groups,
                      Unsupported& unsupported, Medium& medium) {
  const auto given = [&](const char* name, SpectrumRole role, double otherwise) {
    const auto spectrum = spectrum_parameter(parameters, name, role, unsupported);
    return spectrum ? *spectrum : constant_spectrum(otherwise);
  };
  const SceneSpectrum reflectance = given("reflectance", SpectrumRole::albedo, 0.5),
                      mfp = given("mfp", SpectrumRole::unbounded, 1),
                      eta = given("eta", SpectrumRole::unbounded, subsurface_index);
  const auto extinction = [&](double nm) {
    const double value = 1 / (scale * mfp.at(nm));
    if (!(value >= 0 && value <= densest))
      throw scene_error(parameters.location_of("mfp"),
                        fmt::format("a mean free path of {:g} at {:g} nm; {:g} or more would be right",
                                    scale * mfp.at(nm), nm, 1 / densest));
    return value;
  };
  std::map<double, double> albedos;  // by wavelength
  const auto albedo = [&](double nm) {
    const double index = eta.at(nm);
    if (!(index >= 1))
      throw scene_error(parameters.location_of("eta"),
                        fmt::format("an index of {:g} at {:g} nm; 1 or more would be right below a surface "
                                    "of known reflectance",
                                    index, nm));
    const auto [at, is_new] = albedos.try_emplace(nm);
    if (is_new) at->second = scattering_albedo(reflectance.at(nm), index, medium.g);
    return at->second;
  };
  medium.scattering = groups.sampled([&](double nm) { return albedo(nm) * extinction(nm); });
  medium.absorption = groups.sampled([&](double nm) { return (1 - albedo(nm)) * extinction(nm); });
}

double read_scale(const Parameters& parameters) {
  const double scale = parameters.number("scale", 1);
  if (!(scale >= 0)) throw scene_error(parameters.location_of("scale"), "0 or more would be right");
  return scale;
}

double read_g(const Parameters& parameters) {
  const double g = parameters.number("g", 0);
  if (!(std::abs(g) < 1))
    throw scene_error(parameters.location_of("g"),
                      fmt::format("a mean cosine of {:g}; above -1 and below 1 would be right", g));
  return g;
}

/// A collision costs time, and so many on a way are enough for any cloud.
constexpr double most_collisions = 1e5;

/// pbrt-v4's "uniformgrid".
std::shared_ptr<const DensityGrid> read_grid(const MediumDescription& description, const GridBox& box,
                                             Unsupported& unsupported) {
  const Parameters& parameters = description.entity.parameters;
  const Parameter* given = parameters.find("density");
  if (!given) throw scene_error(parameters.location(), "a uniformgrid needs \"float density\", its samples");
  if (given->type == "rgb") {
    unsupported.report(given->at, "a density in colours");
    return nullptr;
  }
  return make_density_grid(description, box, read_grid_samples(parameters, "density", box, 0, "density"));
}

void check_depth(const Medium& medium, const Location& at) {
  double most = 0;
  for (std::size_t group = 0; group < medium.absorption.size(); ++group)
    most = std::max(most, static_cast<double>(medium.extinction(static_cast<int>(group)).largest()));
  const double collisions = most * medium.density->greatest() * medium.density->diagonal();
  if (!(collisions <= most_collisions))
    throw scene_error(at, fmt::format("{:g} mean free paths across this medium; up to {:g} would be right",
                                      collisions, most_collisions));
}

bool scatters(const Medium& medium) {
  return std::ranges::any_of(medium.scattering, [](const Lanes& each) { return !each.is_black(); });
}

/// pbrt-v4's "rgbgrid".
void read_colours(const MediumDescription& description, const WavelengthGroups& groups,
                  const LightOptions& options, int source, Medium& medium) {
  const Parameters& parameters = description.entity.parameters;
  if (!parameters.find("sigma_a") && !parameters.find("sigma_s"))
    throw scene_error(parameters.location(), "a rgbgrid needs \"rgb sigma_a\" or \"rgb sigma_s\"");
  const GridBox box = read_grid_box(description);
  const double scale = read_scale(parameters);
  const BandSpectrum white = groups.sampled([&](double) { return scale; });
  const auto read = [&](const char* name) -> std::shared_ptr<const ColourSamples> {
    if (!parameters.find(name)) return nullptr;
    return std::make_shared<const ColourSamples>(box.cells, read_grid_colours(parameters, name, box), white,
                                                 groups);
  };
  const auto colours =
      std::make_shared<const ColourCoefficients>(ColourCoefficients{read("sigma_a"), read("sigma_s"), scale});
  std::vector<float> bounds;
  constexpr double roundings = 1e-5;  // of sums of floats
  for (std::size_t cell = 0; static_cast<double>(cell) < box.count(); ++cell) {
    const double back = colours->scattering ? colours->scattering->greatest(cell) : scale;
    const double all = (colours->absorption ? colours->absorption->greatest(cell) : scale) + back;
    if (!(all <= densest))
      throw scene_error(parameters.location(),
                        fmt::format("a coefficient of {:g}; 0 to {:g} would be right", all, densest));
    medium.scatters = medium.scatters || back > 0;
    bounds.push_back(static_cast<float>((1 + roundings) * all));
  }
  medium.colours = colours;
  medium.density = make_density_grid(description, box, std::move(bounds));
  medium.absorption = groups.sampled([](double) { return 1; });
  medium.scattering = groups.sampled([](double) { return 0; });
  const auto emission = read_colour_emission(parameters, box, groups, options);
  if (emission) emission->source = source;
  medium.emission = emission;
}

/// pbrt-v4's "nanovdb": the grid "density" of a file, in the space that the file gives it.
std::shared_ptr<const DensityGrid> read_voxels(const MediumDescription& description,
                                               Unsupported& unsupported) {
  const Parameters& parameters = description.entity.parameters;
  const std::string name = parameters.string("filename", "");
  if (name.empty())
    throw scene_error(parameters.location(), "a nanovdb medium needs \"string filename\", a .nvdb file");
  const Location& at = parameters.location_of("filename");
  try {
    const std::string bytes = read_whole_file(resolved_path(at, name));
    if (has_nanovdb_grid(bytes, name, "temperature"))
      unsupported.report(at, "a grid \"temperature\" of a nanovdb medium, which would shine");
    VoxelGrid voxels = read_nanovdb(bytes, name, "density");
    if (!std::ranges::all_of(voxels.values,
                             [](float each) { return each >= 0 && static_cast<double>(each) <= densest; }))
      throw InputError(name, "has a density below 0 or without end");
    const auto& m = voxels.world_from_index;
    const auto& o = voxels.origin;
    MediumDescription placed = description;
    placed.world_from_medium =
        description.world_from_medium *
        Transform(Matrix4{
            {{m[0], m[1], m[2], o[0]}, {m[3], m[4], m[5], o[1]}, {m[6], m[7], m[8], o[2]}, {0, 0, 0, 1}}});
    // The values are those at the whole indices, so that half a cell more is within the box.
    const auto corner = [&](double more) {
      const auto along = [&](std::size_t axis) {
        return voxels.first[axis] - 0.5 + more * voxels.size[axis];
      };
      return Vector3{along(0), along(1), along(2)};
    };
    return make_density_grid(placed, {voxels.size, corner(0), corner(1)}, std::move(voxels.values));
  } catch (const InputError& error) {
    throw scene_error(at, error.what());
  }
}

/// \param source  of the light that it sends out, if it does.
Medium make_medium(const MediumDescription& description, const WavelengthGroups& groups,
                   const LightOptions& options, int source, Unsupported& unsupported) {
  const Parameters& parameters = description.entity.parameters;
  const std::string& type = description.entity.type;
  Medium medium;
  medium.g = read_g(parameters);
  medium.angle_shares = AngleShares(medium.g);
  const auto done = [&] {
    if (medium.density) check_depth(medium, parameters.location());
    parameters.find("type");
    unsupported.report_unused(parameters, fmt::format("medium \"{}\"", description.name));
    return medium;
  };
  if (type == "rgbgrid") {
    read_colours(description, groups, options, source, medium);
    return done();
  }
  if (type != "homogeneous" && type != "uniformgrid" && type != "nanovdb") {
    unsupported.report(parameters.location(), fmt::format("a medium \"{}\"", type));
    medium.absorption = medium.scattering = groups.sampled([](double) { return 0; });
    return medium;
  }
  const double scale = read_scale(parameters);
  const bool attenuates = parameters.find("attenuation", {"rgb", "spectrum", "float"}) != nullptr;
  if (const std::string preset = parameters.string("preset", ""); !preset.empty()) {
    if (attenuates || parameters.find("sigma_a") || parameters.find("sigma_s"))
      throw scene_error(parameters.location_of("preset"),
                        "a medium has either a preset or coefficients of its own");
    read_named(parameters, "preset", scale, groups, unsupported, medium);
  } else {
    medium.absorption = attenuates ? read_attenuation(parameters, scale, groups, unsupported)
                                   : read_coefficient(parameters, "sigma_a", 1, scale, groups, unsupported);
    medium.scattering =
        read_coefficient(parameters, "sigma_s", attenuates ? 0 : 1, scale, groups, unsupported);
  }
  medium.scatters = scatters(medium);
  std::optional<GridBox> box;
  if (type == "uniformgrid") {
    box = read_grid_box(description);
    medium.density = read_grid(description, *box, unsupported);
  } else if (type == "nanovdb") {
    medium.density = read_voxels(description, unsupported);
    return done();
  }
  const auto emission = read_emission(parameters, box ? &*box : nullptr, groups, options, unsupported);
  if (emission) emission->source = source;
  medium.emission = emission;
  return done();
}

/// How a subsurface material is stated.
struct SubsurfaceStatement {
  bool by_coefficients, by_reflectance, by_name;

  explicit SubsurfaceStatement(const Parameters& parameters)
      : by_coefficients(parameters.find("sigma_a") || parameters.find("sigma_s")),
        by_reflectance(parameters.find("reflectance")),
        by_name(parameters.find("name")) {
    if (by_coefficients + by_reflectance + by_name > 1)
      throw scene_error(parameters.location(),
                        "a subsurface material is stated more than once; one of \"name\", \"reflectance\" "
                        "(with \"mfp\") and \"sigma_a\" with \"sigma_s\" would be right");
  }
};

Medium even_subsurface(const Parameters& parameters, const SubsurfaceStatement& is,
                       const WavelengthGroups& groups, Unsupported& unsupported) {
  const double scale = read_scale(parameters);
  Medium medium;
  medium.g = read_g(parameters);
  if (is.by_name && medium.g != 0)
    throw scene_error(parameters.location_of("g"),
                      "named media scatter as if evenly; without \"g\" would be right");
  if (is.by_reflectance) {
    read_reflectance(parameters, scale, groups, unsupported, medium);
  } else if (is.by_coefficients) {
    medium.absorption = read_coefficient(parameters, "sigma_a", 0, scale, groups, unsupported);
    medium.scattering = read_coefficient(parameters, "sigma_s", 0, scale, groups, unsupported);
  } else {
    read_named(parameters, "name", scale, groups, unsupported, medium);
  }
  medium.angle_shares = AngleShares(medium.g);
  medium.scatters = scatters(medium);
  return medium;
}

/// For the boundary's index at each wavelength.
auto albedo_tables(const Parameters& parameters, const WavelengthGroups& groups, Unsupported& unsupported) {
  if (const Parameter* texture = parameters.find("eta", {"texture"}))
    unsupported.report(texture->at, "a texture of \"eta\" below which \"reflectance\" counts");
  const auto given = spectrum_parameter(parameters, "eta", SpectrumRole::unbounded, unsupported);
  std::map<float, std::shared_ptr<const AlbedoTable>> tables;
  decltype(VariedMedium::albedos) result;
  for (const Lanes& index : groups.sampled(given ? given->at : constant_spectrum(subsurface_index).at)) {
    result.emplace_back();
    for (int lane = 0; lane < lane_count; ++lane) {
      if (!(index[lane] >= 1))
        throw scene_error(parameters.location_of("eta"),
                          "1 or more would be right below a surface of known reflectance");
      std::shared_ptr<const AlbedoTable>& table = tables[index[lane]];
      if (!table) table = std::make_shared<const AlbedoTable>(static_cast<double>(index[lane]));
      result.back()[static_cast<std::size_t>(lane)] = table;
    }
  }
  return result;
}

Medium varied_subsurface(const Parameters& parameters, const SubsurfaceStatement& is,
                         const TextureLibrary& textures, Unsupported& unsupported) {
  const auto varied = std::make_shared<VariedMedium>();
  varied->scale = textures.float_parameter(parameters, "scale", 1);
  varied->g = textures.float_parameter(parameters, "g", 0);
  if (!parameters.find("scale", {"texture"})) read_scale(parameters);
  if (!parameters.find("g", {"texture"})) read_g(parameters);
  const auto read = [&](const char* name, SpectrumRole role, double otherwise) {
    return textures.spectrum_parameter(parameters, name, role, otherwise);
  };
  if (is.by_reflectance) {
    varied->reflectance = read("reflectance", SpectrumRole::albedo, 0.5);
    varied->mfp = read("mfp", SpectrumRole::unbounded, 1);
    varied->albedos = albedo_tables(parameters, textures.groups(), unsupported);
  } else if (is.by_coefficients) {
    varied->absorption = read("sigma_a", SpectrumRole::unbounded, 0);
    varied->scattering = read("sigma_s", SpectrumRole::unbounded, 0);
  } else {
    Medium named;
    read_named(parameters, "name", 1, textures.groups(), unsupported, named);
    varied->coefficients[0] = named.absorption, varied->coefficients[1] = named.scattering;
  }
  Medium medium;
  medium.scatters = true;
  medium.absorption = medium.scattering = textures.groups().sampled([](double) { return 0; });
  medium.varied = varied;
  return medium;
}

}  // namespace

Medium make_subsurface(const Entity& material, const TextureLibrary& textures, Unsupported& unsupported) {
  const Parameters& parameters = material.parameters;
  const SubsurfaceStatement is(parameters);
  if (const Parameter* mfp = parameters.find("mfp"); mfp && !is.by_reflectance)
    unsupported.report(mfp->at, "a mean free path without a \"reflectance\"");
  for (const char* name : {"sigma_a", "sigma_s", "reflectance", "mfp", "scale", "g"})
    if (parameters.find(name, {"texture"})) return varied_subsurface(parameters, is, textures, unsupported);
  return even_subsurface(parameters, is, textures.groups(), unsupported);
}

std::vector<Medium> make_media(const SceneDescription& scene, const WavelengthGroups& groups,
                               const LightOptions& options, Unsupported& unsupported) {
  std::vector<Medium> media;
  std::size_t lights = scene.lights.size() + scene.area_lights.size();
  for (const MediumDescription& description : scene.media) {
    media.push_back(make_medium(description, groups, options, static_cast<int>(lights), unsupported));
    lights += shines(description);
  }
  return media;
}

}  // namespace petzval::render
