// SPDX-License-Identifier: BSD-3-Clause
// Pictures put together into a film.
#pragma once

#include <string>

namespace petzval::app {

/// \throws InputError unless a film of that name can be made: by its extension, and by ffmpeg being there.
void require_clip_maker(const std::string& path);

/// \param pictures  of all pictures, from 0 on: "folder/point-%04d.png". \throws Failure when ffmpeg fails.
void write_clip(const std::string& path, const std::string& pictures, double frames_per_second);

}  // namespace petzval::app
