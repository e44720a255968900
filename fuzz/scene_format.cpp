// SPDX-License-Identifier: BSD-3-Clause
#include "scene_format.h"

#include <petzval/render/camera/scene_camera.h>
#include <petzval/render/gltf/gltf_scene.h>
#include <petzval/render/materials/measured_brdf.h>
#include <petzval/render/media/nanovdb_file.h>
#include <petzval/render/path_tracer.h>

#include <cmath>

#include "require.h"

namespace petzval::fuzz {

namespace {

/// Radiance along a few rays from the camera's place: a number, however absurd the lights are.
void follow_light(const render::World& world, const render::Transform& world_from_camera) {
  using namespace render;
  PathOptions options;
  options.max_depth = 3;
  const PathTracer tracer(world, options);
  for (const double slope : {-0.3, 0.0, 0.4}) {
    SobolSample sample(1, static_cast<std::uint32_t>(10 * (slope + 1)));
    const Vector3 direction = world_from_camera.direction({slope, 0.1 * slope, 1});
    if (!(length(direction) > 0) || !std::isfinite(length(direction))) continue;
    const PathLight light =
        tracer.trace(world_from_camera.point({0, 0, 0}), normalised(direction), 0, 0, sample);
    require(light.shared[0] >= 0 && light.alone >= 0, "light that is negative or no number");
  }
}

template <class Read>
bool try_described(Read read) {
  using namespace render;
  return accepted([&] {
    Unsupported unsupported;
    const SceneDescription scene = read(unsupported);
    const SceneCamera camera = set_up_camera(scene, {}, unsupported);
    const auto world = build_world(scene, WavelengthGroups({550, 600}), {}, unsupported);
    follow_light(*world, camera.world_from_camera);
  });
}

}  // namespace

bool try_scene(std::string_view bytes) {
  return try_described([&](render::Unsupported& unsupported) {
    return render::parse_scene_description(std::string(bytes), "/nowhere/fuzz.pbrt", unsupported);
  });
}

bool try_gltf(std::string_view bytes) {
  return try_described([&](render::Unsupported& unsupported) {
    return render::parse_gltf_scene(std::string(bytes), "/nowhere/fuzz.gltf", unsupported);
  });
}

bool try_nanovdb(std::string_view bytes) {
  return accepted([&] {
    const render::VoxelGrid grid = render::read_nanovdb(bytes, "fuzz.nvdb", "density");
    require(static_cast<double>(grid.values.size()) ==
                static_cast<double>(grid.size[0]) * grid.size[1] * grid.size[2],
            "a grid of another size than it says");
  });
}

bool try_ply(std::string_view bytes) {
  return accepted([&] {
    const render::TriangleMesh mesh = render::parse_ply(bytes, "fuzz");
    for (const auto& triangle : mesh.triangles)
      for (const auto corner : triangle)
        require(static_cast<std::size_t>(corner) < mesh.positions.size(), "a corner that is not there");
    for (const auto& position : mesh.positions)
      for (const float each : position) require(std::isfinite(each), "a vertex that is no place");
  });
}

bool try_measured_brdf(std::string_view bytes) {
  using namespace render;
  return accepted([&] {
    const MeasuredBrdf brdf(bytes, "fuzz", WavelengthGroups({550, 600}));
    for (const double slope : {-2.0, 0.0, 0.4})
      for (const double share : {0.0, 0.3, 1 - 0x1p-32}) {
        const Vector3 wo = normalised(Vector3{slope, 0.1 * slope, slope < 0 ? -1.0 : 1.0});
        const auto chosen = brdf.sample(wo, share, 0.7, 0);
        if (!chosen) continue;
        require(chosen->pdf > 0 && std::isfinite(chosen->pdf), "a density that is none");
        const float most = std::max(chosen->weight.largest(), brdf.value(wo, chosen->wi, 0).largest());
        require(most >= 0 && !std::isnan(brdf.pdf(wo, chosen->wi)), "light that is negative or no number");
      }
  });
}

}  // namespace petzval::fuzz
