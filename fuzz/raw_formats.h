// SPDX-License-Identifier: BSD-3-Clause
// Entries of the formats that sensors and raw files come in.
#pragma once

#include <string_view>

namespace petzval::fuzz {

/// A sensor is refused in one line, or it exposes a frame of four pixels.
bool try_sensor(std::string_view bytes);

/// A raw file is refused in one line, or it is developed, and what is written of it reads back the same.
bool try_dng(std::string_view bytes);

}  // namespace petzval::fuzz
