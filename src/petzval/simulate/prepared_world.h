// SPDX-License-Identifier: BSD-3-Clause
// What a prepared scene holds that users of the library need not see.
#pragma once

#include <petzval/render/camera/scene_camera.h>
#include <petzval/render/renderer.h>
#include <petzval/simulate/render.h>

#include <memory>
#include <mutex>
#include <string>

namespace petzval {

/// A world of fewer wavelengths, for looking at: built when it is first asked for.
struct WorldForFocus {
  std::once_flag once;
  std::unique_ptr<const render::World> world;
};

struct PreparedWorld {
  std::shared_ptr<const render::SceneDescription> description;
  render::SceneCamera camera;  ///< but for its lens, which is that of the PreparedScene
  std::shared_ptr<const render::World> world;
  std::shared_ptr<WorldForFocus> for_focus;
  render::PathOptions path;
};

/// The camera with the lens as it is used.
render::SceneCamera scene_camera(const PreparedScene& scene);

/// What a path follows from the request: sampling is left to the caller.
render::RenderOptions render_options(const PreparedScene& scene);

/// And the sampling, with a fingerprint where there is a checkpoint.
render::RenderOptions sampling_of(const PreparedScene& scene, const Context& context);

/// Tells a rendering where it comes from and through which lens.
void add_facts(const PreparedScene& scene, const Context& context, Rendering& picture);

/// How many samples a pixel has at most.
int samples_asked(const PreparedScene& scene);

/// The world of a description at these wavelengths.
std::unique_ptr<const render::World> build_world_at(const render::SceneDescription& description,
                                                    const RenderRequest& request,
                                                    const std::vector<double>& wavelengths_nm,
                                                    render::Unsupported& unsupported);

/// The world that autofocus looks at: the picture's if its wavelengths were asked for; otherwise eight of
/// them, which one path serves, are quicker.
const render::World& world_for_focus(const PreparedScene& scene);

/// What decides about the light of a rendering, one line for each thing, its name first: version, options,
/// camera, lens with its indices, and every file of the scene with a hash of its bytes. A checkpoint of
/// anything else is refused. \throws InputError for a file that can no longer be read.
std::string render_fingerprint(const PreparedScene& scene, const render::RenderOptions& options);

}  // namespace petzval
