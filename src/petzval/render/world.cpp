// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/stop.h>
#include <petzval/render/lights/alter_lights.h>
#include <petzval/render/shapes/ribbon_mesh.h>
#include <petzval/render/world.h>

#include <algorithm>
#include <map>

namespace petzval::render {

namespace {

bool is_mesh(const ShapeDescription& shape) {
  const std::string& type = shape.entity.type;
  return shape.mesh || type == "trianglemesh" || type == "bilinearmesh" || type == "plymesh" ||
         type == "loopsubdiv";
}

/// Puts the pieces of a world together.
class WorldBuilder {
 public:
  WorldBuilder(const SceneDescription& scene, const LightOptions& options, const TextureLibrary& textures,
               Unsupported& unsupported, World& world)
      : scene_(scene), options_(options), textures_(textures), unsupported_(unsupported), world_(world) {
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
      if (scene.materials[i].type != "subsurface") continue;
      below_surface_[static_cast<int>(i)] = static_cast<int>(world.media.size());
      world.media.push_back(make_subsurface(scene.materials[i], textures, unsupported));
    }
  }

  GeometryRange add(const std::vector<ShapeDescription>& shapes) {
    const std::size_t first = world_.geometries.size();
    for (const ShapeDescription& shape : shapes) add(shape);
    return {first, world_.geometries.size()};
  }

 private:
  void add(const ShapeDescription& description) {
    check_stop();
    const std::string& type = description.entity.type;
    const Parameters& parameters = description.entity.parameters;
    Geometry geometry;
    if (is_mesh(description)) {
      geometry.shape = read_triangle_mesh(description, unsupported_);
      if (FloatTexture texture = textures_.float_parameter(parameters, "alpha"))
        geometry.opacity = Opacity{std::move(texture), {}};
      const double cutoff = parameters.number("alphacutoff", -1);
      if (geometry.opacity && cutoff >= 0) geometry.opacity->cutoff = cutoff;
    } else if (type == "sphere" || type == "disk" || type == "cylinder") {
      geometry.shape = read_quadric(description, unsupported_);
    } else if (type == "curve") {
      geometry.shape = curve(description);
    } else {
      return unsupported_.report(parameters.location(), fmt::format("Shape \"{}\"", type));
    }
    unsupported_.report_unused(parameters, fmt::format("Shape \"{}\"", type));
    geometry.material = description.material;
    geometry.is_interface =
        world_.materials[static_cast<std::size_t>(description.material)].kind == Material::Kind::none;
    MediaDescription media = description.media;
    if (const auto below = below_surface_.find(description.material); below != below_surface_.end())
      media.inside = below->second;
    geometry.parts_media = media.differ();
    geometry.inside = media.inside, geometry.outside = media.outside;
    world_.media_end_openly = world_.media_end_openly || (geometry.is_interface && geometry.parts_media);
    geometry.needs_coordinates =
        varies(world_.materials, description.material) ||
        (media.inside >= 0 && world_.media[static_cast<std::size_t>(media.inside)].varied);
    geometry.reversed = description.reverse_orientation;
    geometry.swaps_handedness = description.world_from_object.swaps_handedness();
    if (description.area_light >= 0) light_up(description, geometry);
    world_.geometries.push_back(std::move(geometry));
  }

  decltype(Geometry::shape) curve(const ShapeDescription& description) {
    CurveSegments segments = read_curve(description, unsupported_);
    if (segments.kind != CurveSegments::Kind::ribbon) return segments;
    try {
      return ribbon_mesh(segments);
    } catch (const InputError& error) {
      throw scene_error(description.entity.location(), error.what());
    }
  }

  void light_up(const ShapeDescription& description, Geometry& geometry) {
    if (std::holds_alternative<CurveSegments>(geometry.shape))
      return unsupported_.report(description.entity.location(), "a curve that shines");
    if (geometry.opacity)
      return unsupported_.report(description.entity.location(), "a transparent surface that shines");
    const Entity& entity = scene_.area_lights[static_cast<std::size_t>(description.area_light)];
    double area = 0;
    check_stop();
    for (std::size_t i = 0; i < geometry.primitives(); ++i) area += geometry.primitive_area(i);
    Lights& lights = world_.lights;
    const bool two_sided = entity.parameters.boolean("twosided", false);
    const int spectrum = static_cast<int>(lights.area_spectra.size());
    lights.area_spectra.push_back(area_radiance(entity, area, world_.groups, options_, unsupported_));
    geometry.first_light = static_cast<int>(lights.areas.size());
    for (std::size_t i = 0; i < geometry.primitives(); ++i)
      lights.areas.push_back({static_cast<int>(world_.geometries.size()), i, spectrum, two_sided,
                              static_cast<int>(scene_.lights.size()) + description.area_light});
  }

  const SceneDescription& scene_;
  const LightOptions& options_;
  const TextureLibrary& textures_;
  Unsupported& unsupported_;
  World& world_;
  std::map<int, int> below_surface_;  ///< media of materials
};

}  // namespace

bool World::is_dark() const {
  return lights.empty() && std::ranges::none_of(media, [](const Medium& each) { return !!each.emission; });
}

std::unique_ptr<const World> build_world(const SceneDescription& scene, const WavelengthGroups& groups,
                                         const LightOptions& options, Unsupported& unsupported) {
  auto world =
      std::unique_ptr<World>(new World{groups, {}, {}, {}, {}, scene.camera_medium, false, {}, nullptr});
  const TextureLibrary textures(scene, world->groups, unsupported);
  world->materials = make_materials(scene, textures, unsupported);
  world->media = make_media(scene, world->groups, options, unsupported);
  WorldBuilder builder(scene, options, textures, unsupported, *world);
  const GeometryRange standing = builder.add(scene.shapes);
  std::vector<GeometryRange> objects;
  for (const auto& shapes : scene.objects) objects.push_back(builder.add(shapes));
  for (const InstanceDescription& instance : scene.instances)
    world->placed.push_back({instance.object, instance.world_from_instance});
  Lights& lights = world->lights;
  lights.sources = lights_of(scene);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const std::size_t smalls = lights.smalls.size();
    add_light(scene.lights[i], world->groups, options, unsupported, lights);
    for (std::size_t k = smalls; k < lights.smalls.size(); ++k) lights.smalls[k].source = static_cast<int>(i);
    lights.environment_sources.resize(lights.environments.size(), static_cast<int>(i));
  }
  world->intersector = std::make_unique<Intersector>(world->geometries, standing, objects, world->placed);
  lights.prepare(world->geometries);
  return world;
}

}  // namespace petzval::render
