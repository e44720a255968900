// SPDX-License-Identifier: BSD-3-Clause
#include "option_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

namespace petzval::app {

namespace {

/// Parameters whose options are not called after them.
constexpr std::array<std::pair<std::string_view, std::string_view>, 18> other_names{
    {{"autofocus.from_mm", "--focus-from"},
     {"autofocus.to_mm", "--focus-to"},
     {"focus_pixel", "--focus"},
     {"gain_mode", "--conversion-gain"},
     {"least_scene_angle_deg", "--scene-angle-least"},
     {"losses", "--fresnel, --coating or --absorption"},
     {"samples_per_pixel", "--spp"},
     {"zones", "--zone"},
     {"scene.background_k", "--scene-background"},
     {"scene.file_bands_nm", "--scene-bands"},
     {"scene.horizontal_angle_deg", "--scene-angle"},
     {"scene.band_width_nm", "--band-width"},
     {"scene.illuminance_lx", "--illuminance"},
     {"scene.illuminant", "--illuminant"},
     {"scene.irradiance_w_m2", "--illuminance"},
     {"scene.mean_luminance_cd_m2", "--scene-luminance"},
     {"scene.negative_is_zero", "--scene-negative-zero"},
     {"scene.radiance_unit", "--scene-unit"}}};

/// Endings that say a unit.
constexpr std::array<std::string_view, 13> units{"_cpmm", "_mm", "_um", "_nm", "_m",  "_deg", "_s",
                                                 "_ev",   "_k",  "_c",  "_sr", "_px", "_lx"};

bool is_name(std::string_view text) {
  return !text.empty() && std::islower(static_cast<unsigned char>(text.front())) &&
         std::ranges::all_of(text, [](unsigned char c) {
           return std::islower(c) || std::isdigit(c) || c == '_' || c == '.';
         });
}

}  // namespace

std::string option_of(const std::string& parameter) {
  for (const auto& [name, option] : other_names)
    if (parameter == name) return std::string(option);
  std::string_view name = parameter;
  for (const std::string_view unit : units)
    if (name.ends_with(unit)) {
      name.remove_suffix(unit.size());
      break;
    }
  std::string option = "--" + std::string(name);
  std::ranges::replace_if(
      option, [](char c) { return c == '_' || c == '.'; }, '-');
  return option;
}

std::string with_option_names(const std::string& text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t open = text.find('`', at);
    const std::size_t close = open == text.npos ? text.npos : text.find('`', open + 1);
    if (close == text.npos) return result + text.substr(at);
    const std::string name = text.substr(open + 1, close - open - 1);
    result += text.substr(at, open - at);
    if (is_name(name)) {
      result += option_of(name);
      at = close + 1;
    } else {
      result += '`';
      at = open + 1;
    }
  }
  return result;
}

}  // namespace petzval::app
