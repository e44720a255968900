// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/lens/formats/json_document.h>
#include <petzval/live/message.h>
#include <petzval/scene/scene_file.h>
#include <petzval/simulate/analysis.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace petzval {

namespace {

/// More than any message has, so that what is refused is refused soon.
constexpr std::size_t most_upload_header_bytes = 4096, most_name_bytes = 200, most_plots = 16, most_suns = 16;

double number_within(const JsonEntry& entry, double least, double most) {
  const double value = entry.number("a number");
  if (!(value >= least && value <= most)) entry.fail(fmt::format("must be {:g} to {:g}", least, most));
  return value;
}

std::optional<double> optional_within(const JsonEntry& entry, double least, double most) {
  if (entry.is_null()) return {};
  return number_within(entry, least, most);
}

std::int64_t id_of(const JsonEntry& message) {
  constexpr double most = 9e15;  // whole numbers that a double tells apart
  const JsonEntry entry = message.at("id");
  const double id = number_within(entry, 0, most);
  if (id != std::floor(id)) entry.fail("must be a whole number");
  return static_cast<std::int64_t>(id);
}

std::size_t count_of(const JsonEntry& entry, double most) {
  const double number = number_within(entry, 0, most);
  if (number != std::floor(number)) entry.fail("must be a whole number");
  return static_cast<std::size_t>(number);
}

std::string short_text(const JsonEntry& entry) {
  std::string text = entry.text("a text");
  if (text.size() > most_name_bytes) entry.fail(fmt::format("must be of at most {} bytes", most_name_bytes));
  if (std::ranges::any_of(text, [](char c) { return static_cast<unsigned char>(c) < ' '; }))
    entry.fail("must be without control characters");
  return text;
}

std::string one_of(const JsonEntry& entry, const std::vector<std::string>& names) {
  std::string text = short_text(entry);
  if (std::ranges::find(names, text) == names.end())
    entry.fail("must be one of the names that the server gave");
  return text;
}

/// On the sensor.
std::array<double, 2> place_of(const JsonEntry& entry) {
  const std::vector<JsonEntry> place = entry.items("two numbers");
  if (place.size() != 2) entry.fail("must be two numbers");
  return {number_within(place[0], -1e4, 1e4), number_within(place[1], -1e4, 1e4)};
}

void read_camera(const JsonEntry& camera, BenchState& state) {
  camera.allow_only({"f_number", "blades", "focus", "distance_m", "defocus_mm"});
  if (const JsonEntry blades = camera.at("blades"); !blades.is_null()) {
    state.blades = StopBlades{.count = static_cast<int>(count_of(blades, StopBlades::most))};
    state.blades->validate();
  }
  state.f_number = optional_within(camera.at("f_number"), 0.1, 1000);
  state.focus = Focus::parse(short_text(camera.at("focus")));
  state.distance_m = optional_within(camera.at("distance_m"), 1e-3, 1e6);
  state.defocus_mm = number_within(camera.at("defocus_mm"), -100, 100);
}

void read_shot(const JsonEntry& shot, BenchState& state) {
  shot.allow_only({"exposure", "compensation_ev", "noise", "denoise", "sharpen", "tone"});
  state.exposure = Exposure::parse(short_text(shot.at("exposure")));
  state.compensation_ev = number_within(shot.at("compensation_ev"), -20, 20);
  state.noise = shot.at("noise").truth();
  state.denoise = number_within(shot.at("denoise"), 0, 10);
  state.sharpen = number_within(shot.at("sharpen"), 0, 10);
}

/// Angles of a sun reach as far as Sun::at() takes them.
void read_stray(const JsonEntry& stray, BenchState& state) {
  stray.allow_only({"suns", "sun", "ghosts", "starburst", "threshold", "roughness_nm", "ghost"});
  for (const JsonEntry& sun : stray.at("suns").items("suns")) {
    constexpr double most_deg = 79;
    sun.allow_only({"deg", "lx"});
    const std::vector<JsonEntry> angles = sun.at("deg").items("two numbers");
    if (angles.size() != 2) sun.at("deg").fail("must be two numbers");
    state.suns.push_back({.right_deg = number_within(angles[0], -most_deg, most_deg),
                          .up_deg = number_within(angles[1], -most_deg, most_deg),
                          .illuminance_lx = number_within(sun.at("lx"), 1e-3, 1e7)});
  }
  if (state.suns.size() > most_suns) stray.at("suns").fail(fmt::format("must be at most {}", most_suns));
  state.chosen_sun = count_of(stray.at("sun"), most_suns);
  state.threshold = number_within(stray.at("threshold"), 1, 1e6);
  state.ghosts = stray.at("ghosts").truth();
  state.starburst = stray.at("starburst").truth();
  state.roughness_nm = number_within(stray.at("roughness_nm"), 0, 100);
  if (const JsonEntry ghost = stray.at("ghost"); !ghost.is_null()) {
    constexpr double most_surfaces = 1000;
    const std::vector<JsonEntry> pair = ghost.items("two surfaces");
    if (pair.size() != 2) ghost.fail("must be two surfaces");
    state.ghost = GhostPair{count_of(pair[0], most_surfaces), count_of(pair[1], most_surfaces)};
    if (state.ghost->first <= state.ghost->second)
      ghost.fail("must be the surface that reflects first and one in front of it");
  }
}

BenchState read_state(const JsonEntry& message, const JsonDocument& document, const LiveNames& names) {
  message.allow_only({"kind", "id", "lens", "coatings", "camera", "scene", "illuminant", "sensor", "shot",
                      "stray", "cursor_mm", "plots", "picture"});
  BenchState state;
  state.id = id_of(message);
  if (!message.at("lens").is_object()) message.at("lens").fail("must be a lens");
  state.lens_json = document.root().at("lens").dump();
  const std::vector<JsonEntry> coatings = message.at("coatings").items("a coating or null for each surface");
  for (std::size_t i = 0; i < coatings.size(); ++i)
    if (!coatings[i].is_null()) state.coatings[i] = one_of(coatings[i], names.coatings);
  read_camera(message.at("camera"), state);
  state.scene = one_of(message.at("scene"), names.scenes);
  state.illuminant = one_of(message.at("illuminant"), names.illuminants);
  state.sensor = one_of(message.at("sensor"), names.sensors);
  read_shot(message.at("shot"), state);
  state.tone = one_of(message.at("shot").at("tone"), names.tones);
  read_stray(message.at("stray"), state);
  state.cursor_mm = place_of(message.at("cursor_mm"));
  for (const JsonEntry& plot : message.at("plots").items("names of analyses"))
    state.plots.push_back(one_of(plot, names.analyses));
  if (state.plots.size() > most_plots) message.at("plots").fail("must be fewer");
  state.picture = message.at("picture").truth();
  return state;
}

std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

}  // namespace

std::string BenchState::camera_key() const {
  return fmt::format("{}|{}|{}|{}|{}|{}|{}", lens_json, coating_text(), f_number.value_or(0),
                     blades ? blades->count : -1, focus.text(), distance_m.value_or(0), defocus_mm);
}

std::string BenchState::stray_key() const {
  if (!has_stray_light()) return {};
  std::string key = fmt::format("{}|{}|{}|{}", ghosts, starburst, threshold, roughness_nm);
  for (const Sun& sun : suns) key += fmt::format("|{},{}:{}", sun.right_deg, sun.up_deg, sun.illuminance_lx);
  return key;
}

std::string BenchState::shot_key() const {
  return fmt::format("{}|{}|{}|{}|{}|{}|{}", static_cast<int>(exposure.kind), exposure.value, compensation_ev,
                     noise, denoise, sharpen, tone);
}

std::string BenchState::coating_text() const {
  std::string text;
  for (const auto& [surface, name] : coatings)
    text += fmt::format("{}surfaces[{}]={}", text.empty() ? "" : ",", surface, name);
  return text;
}

const std::vector<std::string>& solid_scenes() {
  static const std::vector<std::string> names = bundled_names("scenes", ".pbrt");
  return names;
}

bool is_solid_scene(const std::string& name) {
  return std::ranges::find(solid_scenes(), name) != solid_scenes().end();
}

LiveNames bundled_live_names() {
  LiveNames names;
  names.lenses = all_bundled_names("lenses", ".json");
  for (const BuiltinScene& scene : builtin_scenes()) {
    const std::string name = scene.name.substr(0, scene.name.find('['));
    if (!is_deep_chart(name)) names.scenes.push_back(name);
  }
  names.scenes.insert(names.scenes.end(), solid_scenes().begin(), solid_scenes().end());
  names.sensors = bundled_names("sensors", ".json");
  names.illuminants = {"", "D65", "D50", "A", "F11", "2856K", "4000K", "6500K", "9000K"};
  for (const Analysis& analysis : analyses()) names.analyses.push_back(analysis.name);
  names.tones = {"none", "soft"};
  names.coatings = bundled_names("coatings", ".json");
  return names;
}

LiveMessage parse_live_message(std::string_view text, const LiveNames& names) {
  if (text.size() > most_message_bytes)
    throw InputError(fmt::format("a message has at most {} bytes", most_message_bytes));
  const JsonDocument document(std::string(text), "message");
  const JsonEntry message(document);
  const std::string kind = short_text(message.at("kind"));
  if (kind == "state") return read_state(message, document, names);
  if (kind == "hello") {
    message.allow_only({"kind"});
    return LiveGreeting{};
  }
  if (kind == "lens") {
    message.allow_only({"kind", "id", "name"});
    return LensWish{id_of(message), one_of(message.at("name"), names.lenses)};
  }
  if (kind == "glasses") {
    message.allow_only({"kind", "id", "text"});
    return GlassWish{id_of(message), short_text(message.at("text"))};
  }
  if (kind == "focus") {
    message.allow_only({"kind", "id", "place_mm"});
    return FocusWish{id_of(message), place_of(message.at("place_mm"))};
  }
  if (kind == "save") {
    message.allow_only({"kind", "id", "extension"});
    return SaveWish{id_of(message), one_of(message.at("extension"),
                                           {".json", ".zmx", ".seq", ".png", ".tif", ".dng", ".exr"})};
  }
  message.at("kind").fail("must be hello, state, lens, glasses, focus or save");
}

namespace {

void check_extension(const std::string& name, const std::string& extension) {
  for (const auto* known :
       {&upload_lens_extensions(), &upload_photograph_extensions(), &upload_spectral_extensions()})
    if (std::ranges::find(*known, extension) != known->end()) return;
  throw InputError(name, fmt::format("the bench reads {} (lenses), {} (photographs) and {} (spectra; .hdr "
                                     "together with its numbers)",
                                     fmt::join(upload_lens_extensions(), ", "),
                                     fmt::join(upload_photograph_extensions(), ", "),
                                     fmt::join(upload_spectral_extensions(), ", ")));
}

/// The last bytes of an upload are those of its companion.
void read_companion(const JsonEntry& header, Upload& upload) {
  if (upload.extension != ".hdr" && upload.extension != ".npy")
    header.at("name").fail("must end in .hdr or .npy, which alone are read with a companion");
  upload.companion = short_text(header.at("companion"));
  if (upload.companion.empty()) header.at("companion").fail("must be a name");
  const std::size_t length = count_of(header.at("companion_bytes"), static_cast<double>(upload.bytes.size()));
  upload.companion_bytes = upload.bytes.substr(upload.bytes.size() - length);
  upload.bytes.resize(upload.bytes.size() - length);
}

}  // namespace

Upload parse_live_upload(std::string_view bytes) {
  constexpr std::size_t length_bytes = 4;
  if (bytes.size() < length_bytes) throw InputError("an upload begins with the length of its header");
  std::size_t length = 0;
  for (std::size_t i = 0; i < length_bytes; ++i)
    length |= static_cast<std::size_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
  if (length > most_upload_header_bytes || length > bytes.size() - length_bytes)
    throw InputError(fmt::format("the header of an upload has at most {} bytes", most_upload_header_bytes));
  const JsonDocument document(std::string(bytes.substr(length_bytes, length)), "upload");
  const JsonEntry header(document);
  header.allow_only({"kind", "id", "name", "companion", "companion_bytes"});
  if (header.at("kind").text("a text") != "upload") header.at("kind").fail("must be upload");
  Upload upload;
  upload.id = id_of(header);
  const std::string name = short_text(header.at("name"));
  const std::size_t dot = name.rfind('.');
  if (dot != std::string::npos) upload.extension = lower_case(name.substr(dot));
  upload.label = name.substr(0, dot);
  check_extension(name, upload.extension);
  const std::string_view files = bytes.substr(length_bytes + length);
  if (files.size() > most_upload_bytes)
    throw InputError(fmt::format("a file has at most {} MiB", most_upload_bytes >> 20));
  upload.bytes = std::string(files);
  if (header.find("companion") || header.find("companion_bytes")) read_companion(header, upload);
  return upload;
}

const std::vector<std::string>& upload_lens_extensions() {
  static const std::vector<std::string> extensions{".json", ".zmx", ".seq", ".dat"};
  return extensions;
}

const std::vector<std::string>& upload_photograph_extensions() {
  static const std::vector<std::string> extensions{".png", ".jpg", ".jpeg", ".tif", ".tiff"};
  return extensions;
}

const std::vector<std::string>& upload_spectral_extensions() {
  static const std::vector<std::string> extensions{".exr", ".mat", ".npy", ".hdr"};
  return extensions;
}

}  // namespace petzval
