// SPDX-License-Identifier: BSD-3-Clause
// Frames of a focus pull that share their paths.
#pragma once

#include <petzval/simulate/render.h>

#include <span>
#include <vector>

namespace petzval {

/// The light of every frame, as render_scene(), in a fraction of the time: the path of each frame's ray is a
/// sample of every frame whose lens lets that ray through to its film (render::render_shared_frames()).
/// Frames may differ in their lens and its focus. `samples_per_pixel` says how noisy they come out: no more
/// than frames of so many paths each. Fewer are sent, `Rendering::samples_per_pixel` of each frame. The bytes
/// of a frame depend on all of them, and on the seed.
///
///     RenderSession session;
///     std::vector<PreparedScene> frames;
///     for (int i = 0; i < 12; ++i) {
///       request.camera.focus = Focus::at_m(1 + i * 2.0 / 11);
///       frames.push_back(session.prepare(request));
///     }
///     const std::vector<Rendering> pull = render_frames(frames);
///
/// \param frames  four or more, of one world (RenderSession) and one film, whose camera stands in one place,
/// with pupils that differ by at most one stop.
/// \throws InputError for others, and for what frames cannot share: autofocus that is still to be run,
/// diffraction, and what render_shared_frames() names; Cancelled.
std::vector<Rendering> render_frames(std::span<const PreparedScene> frames, const Context& context = {});

}  // namespace petzval
