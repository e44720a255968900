// SPDX-License-Identifier: BSD-3-Clause
#include "live_format.h"

#include <petzval/live/message.h>

#include <algorithm>
#include <cmath>

#include "require.h"

namespace petzval::fuzz {

namespace {

const LiveNames& offered() {
  static const LiveNames names{
      {"tessar"}, {"studio", "grid"}, {"third-inch-vga"}, {"", "D65"}, {"mtf", "spots"}, {"none"}, {"mgf2"}};
  return names;
}

bool is_offered(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

void check_state(const BenchState& state) {
  require(state.id >= 0, "an id below 0");
  require(std::isfinite(state.f_number.value_or(0)) && std::isfinite(state.defocus_mm),
          "a number that is not finite");
  require(!state.distance_m || *state.distance_m > 0, "a distance that is not positive");
  require(std::isfinite(state.cursor_mm[0]) && std::isfinite(state.cursor_mm[1]),
          "a place that is not finite");
  require(is_offered(offered().scenes, state.scene) && is_offered(offered().sensors, state.sensor) &&
              is_offered(offered().illuminants, state.illuminant),
          "a name that was not offered");
  for (const Sun& sun : state.suns)
    require(std::abs(sun.right_deg) < 80 && std::abs(sun.up_deg) < 80, "a sun behind the camera");
  require(!state.blades || state.blades->count == 0 || state.blades->count >= 3, "a stop of two corners");
  require(std::isfinite(state.roughness_nm) && state.roughness_nm >= 0, "a roughness below 0");
  require(!state.ghost || state.ghost->first > state.ghost->second, "a ghost that nothing reflects");
  for (const auto& [surface, coating] : state.coatings)
    require(is_offered(offered().coatings, coating), "another coating");
  for (const std::string& plot : state.plots)
    require(is_offered(offered().analyses, plot), "another analysis");
}

}  // namespace

bool try_live(std::string_view bytes) {
  const bool message = accepted([&] {
    const LiveMessage read = parse_live_message(bytes, offered());
    if (const auto* state = std::get_if<BenchState>(&read)) check_state(*state);
    if (const auto* lens = std::get_if<LensWish>(&read))
      require(is_offered(offered().lenses, lens->name), "a lens that was not offered");
  });
  const bool upload = accepted([&] {
    const Upload read = parse_live_upload(bytes);
    require(is_offered(upload_lens_extensions(), read.extension) ||
                is_offered(upload_photograph_extensions(), read.extension) ||
                is_offered(upload_spectral_extensions(), read.extension),
            "another extension");
    require(read.companion_bytes.empty() || !read.companion.empty(), "a companion without a name");
    require(read.bytes.size() + read.companion_bytes.size() <= bytes.size(), "bytes from nowhere");
  });
  return message || upload;
}

}  // namespace petzval::fuzz
