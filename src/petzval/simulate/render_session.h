// SPDX-License-Identifier: BSD-3-Clause
// Many pictures of one scene.
#pragma once

#include <petzval/simulate/render.h>

#include <optional>

namespace petzval {

/// Prepares scenes, and keeps the world of the last one: where only the camera is altered, nothing is read
/// and built again.
///
///     RenderSession session;
///     for (const double distance_m : {1.0, 1.5, 2.0}) {
///       request.camera.focus = Focus::at_m(distance_m);
///       const Rendering picture = render_scene(session.prepare(request));
///     }
class RenderSession {
 public:
  /// As prepare_scene(). A scene's file that was altered since is not read again.
  PreparedScene prepare(const RenderRequest& request, const Context& context = {}) {
    PreparedScene scene = last_ ? prepare_scene(request, *last_, context) : prepare_scene(request, context);
    last_ = scene;
    return scene;
  }

 private:
  std::optional<PreparedScene> last_;
};

}  // namespace petzval
