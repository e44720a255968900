// SPDX-License-Identifier: BSD-3-Clause
// What decides about the light of a rendering: a checkpoint of anything else is refused.
#pragma once

#include <petzval/render/renderer.h>

#include <string>

#include "render_option.h"

namespace petzval::app {

/// One line for each thing, its name first: version, options, camera, lens with its indices, and every file
/// of the scene with a hash of its bytes. \throws InputError for a file that can no longer be read.
std::string render_fingerprint(const RenderChoice& choice, const PreparedScene& scene,
                               const render::RenderOptions& options);

}  // namespace petzval::app
