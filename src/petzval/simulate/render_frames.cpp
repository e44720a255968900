// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/render/lamps.h>
#include <petzval/render/shared_frames.h>
#include <petzval/simulate/prepared_world.h>
#include <petzval/simulate/render_frames.h>

#include <algorithm>

namespace petzval {

namespace {

/// Of pupils: paths through a wide one seldom pass a narrow one, which would come out noisy.
constexpr double most_stops_apart = 1;

[[noreturn]] void refuse_difference(const char* what) {
  throw InputError(fmt::format(
      "frames that share paths differ in lens and focus alone, and these in their {}; frames of their own "
      "paths would be right",
      what));
}

/// \throws InputError unless one path can serve both.
void require_alike(const PreparedScene& a, const PreparedScene& b) {
  const render::SceneCamera &one = a.world->camera, &other = b.world->camera;
  if (a.world->world != b.world->world) refuse_difference("scene, lights or wavelengths");
  if (!(a.film.columns == b.film.columns && a.film.rows == b.film.rows &&
        a.film.pitch_um == b.film.pitch_um && a.photosite == b.photosite && one.crop == other.crop))
    refuse_difference("film");
  if (one.world_from_camera.matrix() != other.world_from_camera.matrix() ||
      a.request.scene_unit_mm != b.request.scene_unit_mm ||
      a.request.camera_origin != b.request.camera_origin)
    refuse_difference("camera's place");
  if (a.world->path.max_depth != b.world->path.max_depth || one.clipping.near != other.clipping.near ||
      one.clipping.far != other.clipping.far)
    refuse_difference("paths");
  if (samples_asked(a) != samples_asked(b)) refuse_difference("`samples_per_pixel`");
}

void require_shareable(std::span<const PreparedScene> frames) {
  if (frames.size() < render::fewest_sharing_frames)
    throw InputError(fmt::format("{} frames have too little to share; {} or more would be right",
                                 frames.size(), render::fewest_sharing_frames));
  for (const PreparedScene& frame : frames) {
    if (!frame.lens) throw InputError("frames share paths through lenses; a `lens` would be right");
    if (frame.wants_autofocus())
      throw InputError("frames that share paths are in focus already; a distance as `focus` would be right");
    if (frame.request.diffraction)
      throw InputError("frames that share paths have no `diffraction`; without it would be right");
    require_alike(frames.front(), frame);
  }
}

void require_like_pupils(std::span<const render::LensCamera> cameras) {
  constexpr std::size_t rays = 1024;
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const render::LensCamera& camera : cameras) {
    const double sr = camera.etendue_sr(0, 0, 0, 0, rays);
    least = std::min(least, sr), most = std::max(most, sr);
  }
  if (most > least * std::exp2(most_stops_apart)) refuse_difference("stop, by more than one");
}

}  // namespace

std::vector<Rendering> render_frames(std::span<const PreparedScene> frames, const Context& context) {
  require_shareable(frames);
  const PreparedScene& first = frames.front();
  const render::World& world = *first.world->world;
  if (world.is_dark()) send_note(context, "the scene has no lights; the pictures will be black");
  std::vector<Rendering> pictures = result_within(context, [&](const ProgressCallback& progress) {
    std::vector<render::LensCamera> cameras;
    for (const PreparedScene& frame : frames) {
      render::SceneCamera camera = scene_camera(frame);
      camera.options.lamps = render::lamps_of(world, camera.world_from_camera);
      camera.options.lands = true;
      cameras.emplace_back(*camera.lens, camera.film, world.groups, camera.options);
    }
    require_like_pupils(cameras);
    render::RenderOptions options = sampling_of(first, context);
    options.window = first.world->camera.crop;
    return render::render_shared_frames(world, cameras, first.world->camera.world_from_camera, first.film,
                                        options, progress);
  });
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    add_facts(frames[i], context, pictures[i]);
    pictures[i].irradiance.provenance +=
        fmt::format(", shared by {} frames as good as {}", frames.size(), samples_asked(first));
  }
  return pictures;
}

}  // namespace petzval
