// SPDX-License-Identifier: BSD-3-Clause
// What is altered of a single light of a scene.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace petzval::render {

/// One light made stronger, turned or coloured. Lights are counted from 0: sources of light in the order of
/// the scene's file, then surfaces that shine, one for each "AreaLightSource", then media that shine.
struct LightChange {
  enum class Kind {
    scale,     ///< so many times as strong; 0: off
    turn_deg,  ///< about the origin and the axis of the world nearest to the camera's up, by the right hand
    kelvin     ///< the colour of a black body, at the luminance that it has
  };
  Kind kind = Kind::scale;
  std::size_t light = 0;
  double value = 1;

  bool operator==(const LightChange&) const = default;
  /// "scale@0=2".
  std::string text() const;
};

/// \throws InputError for what is not written like scale@0=2, turn_deg@0=30 or kelvin@1=3200, and for values
/// that no light has.
LightChange parse_light_change(std::string_view text);

}  // namespace petzval::render
