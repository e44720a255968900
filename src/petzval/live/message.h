// SPDX-License-Identifier: BSD-3-Clause
// What a page may say to the live server. Whatever else comes is refused (docs/LIVE.md, "Protocol").
#pragma once

#include <petzval/flare/ghost_way.h>
#include <petzval/lens/stop_blades.h>
#include <petzval/simulate/expose.h>
#include <petzval/simulate/flare.h>
#include <petzval/simulate/focus.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace petzval {

/// The names that a page may choose from; nothing else is looked up, so that no message is a path.
struct LiveNames {
  std::vector<std::string> lenses, scenes, sensors, illuminants, analyses, tones, coatings;
};
/// Those of the bundled data.
LiveNames bundled_live_names();
/// Of the scenes, those in three dimensions, which are rendered.
const std::vector<std::string>& solid_scenes();
bool is_solid_scene(const std::string& name);

/// All that is on the bench. The lens is native JSON, read later, so that a fault in it is told as one of the
/// lens and not of the message.
struct BenchState {
  std::int64_t id = 0;
  std::string lens_json = {};
  std::map<std::size_t, std::string> coatings = {};  ///< surface → a bundled coating
  std::optional<double> f_number = {};
  std::optional<StopBlades> blades = {};  ///< absent: as the prescription has them
  Focus focus = {};
  std::optional<double> distance_m = {};  ///< of the scene from the sensor; absent: infinity
  double defocus_mm = 0;
  std::string scene = {}, illuminant = {}, sensor = {};
  Exposure exposure = {};
  double compensation_ev = 0;
  bool noise = true;
  double denoise = 0, sharpen = 0;
  std::string tone = "none";
  std::array<double, 2> cursor_mm =
      {};                      ///< a place on the sensor, as the upright picture shows it: x right, y up
  std::vector<Sun> suns = {};  ///< added to the scene
  std::size_t chosen_sun = 0;  ///< of them, whose light shows the way of a ghost
  /// Of suns, and of what the scene itself holds that is brighter than `threshold` times its mean.
  bool ghosts = false, starburst = false;
  double threshold = SourceSearch().threshold;
  double roughness_nm = 0;              ///< of surfaces that do not say how they scatter; 0: nothing scatters
  std::optional<GhostPair> ghost = {};  ///< whose way the layout shows
  /// The lens and how it is used: what is alike here is the same.
  std::string camera_key() const;
  /// The same of stray light, empty: none; and of exposure and development.
  std::string stray_key() const;
  std::string shot_key() const;
  /// "surfaces[0]=mgf2,surfaces[2]=mgf2"; empty: none.
  std::string coating_text() const;
  bool has_stray_light() const { return !suns.empty() || ghosts || starburst || roughness_nm > 0; }
  std::vector<std::string> plots = {};  ///< analyses that are shown
  bool picture = true;
};

struct LiveGreeting {};
/// A bundled lens.
struct LensWish {
  std::int64_t id = 0;
  std::string name = {};
};
/// Glasses by a part of their name, or near an index and an Abbe number.
struct GlassWish {
  std::int64_t id = 0;
  std::string text = {};
};
/// Focus on what the picture shows at a place (x right, y up, on the sensor [mm]).
struct FocusWish {
  std::int64_t id = 0;
  std::array<double, 2> place_mm = {};
};
/// A file of what was shown last: a lens as ".json", ".zmx" or ".seq", a picture as ".png", ".tif", ".dng" or
/// ".exr".
struct SaveWish {
  std::int64_t id = 0;
  std::string extension = {};
};
/// A lens, a photograph or a spectral file that was dropped onto the page.
struct Upload {
  std::int64_t id = 0;
  std::string extension = {};  ///< ".zmx", one of upload_extensions()
  std::string label = {};      ///< the name without it, as people read it; never part of a path
  std::string bytes = {};
  /// A second file that a spectral one is read with: the numbers of an ENVI header, the .json of a .npy. Its
  /// name, for messages alone; empty: there is none.
  std::string companion = {};
  std::string companion_bytes = {};

  /// Of the name that the companion is given on the server, whatever name it had.
  std::string companion_extension() const { return extension == ".npy" ? ".json" : ".img"; }
};

using LiveMessage = std::variant<LiveGreeting, BenchState, LensWish, GlassWish, FocusWish, SaveWish>;

constexpr std::size_t most_message_bytes = std::size_t{1} << 20;
/// Spectral files are large: 512 × 512 samples in 31 bands of four bytes are 31 MiB.
constexpr std::size_t most_upload_bytes = std::size_t{64} << 20;

/// Of a text. \throws InputError for whatever is not exactly a message: other or missing keys, other types,
/// numbers out of range, names that are not among the lists, more than `most_message_bytes`.
LiveMessage parse_live_message(std::string_view text, const LiveNames& names);

/// Of bytes: the length of a JSON header in four bytes, the lowest first, the header, the file, its
/// companion. \throws InputError.
Upload parse_live_upload(std::string_view bytes);
/// Lenses, then photographs, then spectral files.
const std::vector<std::string>& upload_lens_extensions();
const std::vector<std::string>& upload_photograph_extensions();
const std::vector<std::string>& upload_spectral_extensions();

}  // namespace petzval
