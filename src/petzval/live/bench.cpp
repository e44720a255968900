// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/best_focus.h>
#include <petzval/analysis/field_values.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/scratch_folder.h>
#include <petzval/base/whole_file.h>
#include <petzval/camera/mounted_lens.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>
#include <petzval/live/bench.h>
#include <petzval/live/bench_json.h>
#include <petzval/live/bench_picture.h>
#include <petzval/live/bench_plots.h>
#include <petzval/live/bench_psf.h>
#include <petzval/live/bench_render.h>
#include <petzval/live/bench_sensor.h>
#include <petzval/live/stage_time.h>
#include <petzval/simulate/analysis.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

namespace petzval {

using nlohmann::json;

namespace {

using Clock = std::chrono::steady_clock;

/// Scenes that one page may drop: their files are kept as long as it is there.
constexpr int most_dropped_scenes = 16;

/// For so long the server leaves the processors to the browser, which draws the rays: it takes three times as
/// long beside the server's work.
constexpr std::chrono::milliseconds rays_are_painted{4};
/// How long nothing must come before the full picture is begun.
constexpr std::chrono::milliseconds hand_rests{180};

bool is_among(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

/// Text with `there` in place of each `here`.
std::string replaced(std::string text, const std::string& here, const std::string& there) {
  for (std::size_t at = text.find(here); at != text.npos; at = text.find(here, at + there.size()))
    text.replace(at, here.size(), there);
  return text;
}

/// Text that ends before what a reader's own library says, if that names a file of this folder (which may be
/// cut short).
std::string without_paths(const std::string& text, const std::string& folder) {
  const std::size_t at = text.find(std::filesystem::path(folder).parent_path().string() + '/');
  return at == text.npos ? text : text.substr(0, text.rfind(": ", at));
}

/// A note of the library without the parameter that it advises, which the page does not have.
std::string without_advice(const std::string& note) {
  const std::size_t from = note.find(" (`"), to = note.find(')', from == note.npos ? 0 : from);
  return from == note.npos || to == note.npos ? note : note.substr(0, from) + note.substr(to + 1);
}

/// The lens of a state in use, and the state of which it is.
struct LensInUse {
  std::string key = {};
  Camera camera = {};
  Lens lens = Lens();
};

/// As the picture uses it: focused, and the object where the scene stands.
Lens used_for_scene(Camera camera, const std::optional<double>& distance_m, const Context& context) {
  const double scene_m = distance_m.value_or(INFINITY);
  if (camera.focus.kind == Focus::Kind::automatic) camera.focus = Focus::at_m(scene_m);
  const Lens focused = lens_in_use(camera, context);
  // A lens that stays as it was designed, before a scene that stands where nobody said: its own object.
  if (camera.focus.kind == Focus::Kind::design && !distance_m) return focused;
  MountedLens mounted(focused);
  if (mounted.object_distance_from_sensor_m() != distance_m) mounted.place_object_at_m(distance_m);
  return mounted.lens();
}

json list_of_lenses() {
  static const json all = [] {
    json list = json::array();
    for (const std::string& name : all_bundled_names("lenses", ".json"))
      list.push_back({{"name", name}, {"title", read_lens(name).lens.name}});
    return list;
  }();
  return all;
}

json list_of_coatings() {
  json list = json::array();
  for (const std::string& name : bundled_names("coatings", ".json"))
    list.push_back({{"name", name}, {"title", read_coating(name).name}});
  return list;
}

double image_height_of(const Lens& lens) {
  double height = 0;
  for (const double field : lens.fields.values)
    height =
        std::max(height, std::abs(paraxial_image_height_mm(lens, object_field(lens, lens.fields.kind, field),
                                                           lens.reference_wavelength_nm)));
  return height;
}

std::string sensor_for(const Lens& lens) {
  try {
    const double height = image_height_of(lens);
    return usual_sensor(std::isfinite(height) && height > 0 ? height : 1);
  } catch (const InputError&) {
    return usual_sensor(1);
  }
}

}  // namespace

struct Bench::Impl {
  LiveStart start;
  SendReply send;
  LiveNames names;
  std::map<std::string, BenchScene> scenes = {};  ///< from files
  std::map<std::string, std::string> sensor_paths = {};
  ScratchFolder files = {};
  LensInUse use = {};
  std::map<std::string, std::string> shown = {};  ///< stage → key of what was sent
  std::map<std::string, Clock::time_point> shown_at = {};
  const BenchQuestions* ask = nullptr;  ///< while show() is under way
  int threads = 0;
  BenchPicture pictures = {};
  BenchRender renderings = {};
  bool solid = false;  ///< whether the scene that was shown last has three dimensions
  std::optional<BenchPlots> plots = {};
  int dropped = 0;  ///< scenes

  void tell(const json& message) const {
    send({message.dump(-1, ' ', false, json::error_handler_t::replace), {}});
  }

  void problem(std::int64_t id, const std::string& stage, const std::string& text) const {
    tell({{"kind", "problem"}, {"id", id}, {"stage", stage}, {"text", text}});
  }

  /// Whether a stage was shown so short a time ago that it may wait for the next state; the longer it takes,
  /// the longer it may.
  bool is_fresh(const std::string& name) const {
    using std::chrono::milliseconds;
    const milliseconds moment(name == "preview" ? 300 : 150);
    const auto found = shown_at.find(name);
    return found != shown_at.end() && Clock::now() - found->second < moment;
  }

  /// Full and finest pictures give way at once, other stages as is_fresh() says.
  bool gives_way(const std::string& name) const {
    return ask->ended() || (ask->newer() && (name == "picture" || name == "finest" || is_fresh(name)));
  }

  /// Does a stage unless it has been shown as it is. \returns whether it stands.
  template <typename Work>
  bool stage(std::int64_t id, const std::string& name, const std::string& key, const Work& work) {
    if (const auto found = shown.find(name); found != shown.end() && found->second == key) return true;
    if (gives_way(name)) throw Cancelled();
    shown.erase(name);
    const StageTime time;
    Context context;
    context.threads = threads;
    context.progress = [&](double, const std::string&) { return !gives_way(name); };
    try {
      work(context);
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& error) {
      problem(id, name, error.what());
      return false;
    } catch (const std::bad_alloc&) {
      problem(id, name, "out of memory; a smaller picture would fit");
      return false;
    }
    shown[name] = key;
    shown_at[name] = Clock::now();
    tell({{"kind", "stage"}, {"id", id}, {"stage", name}, {"ms", time.ms()}, {"cpu_ms", time.cpu_ms()}});
    return true;
  }

  void show(const BenchState& state);
  void take_scene(const Upload& upload);
  void take_lens(const Upload& upload);
  void show_layout(const BenchState& state) const;
  void show_psf(const BenchState& state, const Context& context) const;
  void show_stray(const BenchState& state) const;
  std::string sensor_path(const BenchState& state) const {
    const auto found = sensor_paths.find(state.sensor);
    return found == sensor_paths.end() ? state.sensor : found->second;
  }
};

void Bench::Impl::show_layout(const BenchState& state) const {
  json message = layout_json(use.lens);
  message["kind"] = "layout";
  message["id"] = state.id;
  tell(message);
}

void Bench::Impl::show_psf(const BenchState& state, const Context& context) const {
  Context alone = context;
  alone.threads = 1;  // another processor is left to the browser, which paints the rays meanwhile
  const BenchPsf psf = bench_psf({use.lens, use.camera.losses}, state.cursor_mm, alone);
  send({json{{"kind", "psf"},
             {"id", state.id},
             {"size", psf.size},
             {"spacing_um", psf.spacing_um},
             {"height_mm", psf.height_mm},
             {"azimuth_deg", psf.azimuth_deg},
             {"captured", psf.captured}}
            .dump(),
        float_bytes(psf.rgb), true});
}

void Bench::Impl::show_stray(const BenchState& state) const {
  const double sensor_reflectance = read_sensor(sensor_path(state)).reflectance.value_or(0.0);
  const std::optional<Sun> sun =
      state.chosen_sun < state.suns.size() ? std::optional(state.suns[state.chosen_sun]) : std::nullopt;
  json message = stray_json({use.lens, use.camera.losses}, sun, state.ghost, sensor_reflectance);
  message["kind"] = "stray";
  message["id"] = state.id;
  tell(message);
}

void Bench::Impl::show(const BenchState& state) {
  solid = is_solid_scene(state.scene);
  // What is seen of a scene in three dimensions is as far away as the lens is focused.
  const std::optional<double> object_m = !solid ? state.distance_m
                                         : state.focus.kind == Focus::Kind::distance
                                             ? std::optional(state.focus.distance_m)
                                             : std::nullopt;
  const std::string key = fmt::format("{}|{}", state.camera_key(), object_m.value_or(0));
  if (use.key != key) {
    use.key.clear();
    std::string failed_at = "lens";
    try {
      use.camera = {};
      use.camera.lens = lens_from_json(state.lens_json, "lens");
      use.camera.f_number = state.f_number;
      use.camera.blades = state.blades;
      use.camera.focus = state.focus;
      use.camera.defocus_mm = state.defocus_mm;
      for (const auto& [surface, name] : state.coatings) {
        std::vector<Surface>& surfaces = use.camera.lens.surfaces;
        if (surface >= surfaces.size()) throw InputError("there are more coatings than surfaces");
        surfaces[surface].coating = read_coating(name);
        surfaces[surface].coating->bundled = name;
      }
      use.camera.lens.validate();
      failed_at = "camera";
      use.lens = used_for_scene(use.camera, object_m, {});
    } catch (const Error& error) {
      return problem(state.id, failed_at, error.what());
    }
    use.key = key;
  }
  const bool new_rays = shown["layout"] != key;
  if (!stage(state.id, "layout", key, [&](const Context&) { show_layout(state); })) return;
  if (new_rays) ask->rests(rays_are_painted);
  const auto picture = [&](const char* name, PictureQuality quality) {
    const auto scene = scenes.find(state.scene);
    // The picture knows itself whether it is new.
    const auto work = [&](const Context& context) {
      if (solid) return renderings.show(state, use.camera, sensor_path(state), quality, context, send);
      pictures.show(state, {use.lens, use.camera.losses},
                    scene == scenes.end() ? BenchScene{.path = state.scene} : scene->second,
                    sensor_path(state), quality, context, send);
    };
    return stage(state.id, name,
                 fmt::format("{}|{}|{}|{}|{}|{}", key, state.stray_key(), state.scene, state.illuminant,
                             state.sensor, state.shot_key()),
                 work);
  };
  stage(state.id, "psf", fmt::format("{}|{}|{}", key, state.cursor_mm[0], state.cursor_mm[1]),
        [&](const Context& context) { show_psf(state, context); });
  // Behind the point spread, for the same reason.
  plots->wish({state.id, key, {use.lens, use.camera.losses}, state.plots, threads});
  const GhostPair ghost = state.ghost.value_or(GhostPair{0, 0});
  if (!state.suns.empty() || state.ghost || std::ranges::find(state.plots, "ghosts") != state.plots.end())
    stage(state.id, "stray",
          fmt::format("{}|{}|{}|{},{}|{}", key, state.stray_key(), state.chosen_sun, ghost.first,
                      ghost.second, state.sensor),
          [&](const Context&) { show_stray(state); });
  const auto stop = [this] { return ask->newer() || ask->ended(); };
  plots->let_quick_ones_pass(stop);
  if (state.picture && picture("preview", PictureQuality::preview)) {
    if (!ask->rests(hand_rests)) throw Cancelled();
    plots->wish({state.id, key, {use.lens, use.camera.losses}, state.plots, threads, true});
    if (picture("picture", PictureQuality::full)) picture("finest", PictureQuality::finest);
  }
  if (!plots->wait(stop)) throw Cancelled();
}

Bench::Bench(const LiveStart& start, SendReply send) : impl_(std::make_unique<Impl>()) {
  impl_->start = start;
  impl_->send = std::move(send);
  impl_->plots.emplace(impl_->send);
  impl_->names = bundled_live_names();
  impl_->scenes = start.scene_files;
  impl_->sensor_paths = start.sensor_files;
  for (const auto& [label, scene] : start.scene_files) impl_->names.scenes.push_back(label);
  for (const auto& [label, path] : start.sensor_files) impl_->names.sensors.push_back(label);
}

Bench::~Bench() = default;

const LiveNames& Bench::names() const {
  return impl_->names;
}

void Bench::greet() {
  const LiveStart& start = impl_->start;
  const Lens lens = lens_from_json(start.lens_json, "lens");
  json analyses_list = json::array();
  for (const Analysis& analysis : analyses())
    analyses_list.push_back({{"name", analysis.name}, {"title", analysis.description}});
  impl_->tell({{"kind", "welcome"},
               {"lens_name", start.lens_name},
               {"lens", json::parse(start.lens_json)},
               {"scene", start.scene},
               {"sensor", start.sensor.empty() ? sensor_for(lens) : start.sensor},
               {"lenses", list_of_lenses()},
               {"scenes", impl_->names.scenes},
               {"solid_scenes", solid_scenes()},
               {"sensors", impl_->names.sensors},
               {"illuminants", impl_->names.illuminants},
               {"tones", impl_->names.tones},
               {"coatings", list_of_coatings()},
               {"analyses", std::move(analyses_list)}});
}

void Bench::show(const BenchState& state, int threads, const BenchQuestions& ask) {
  impl_->ask = &ask;
  impl_->threads = threads;
  impl_->show(state);
  impl_->tell({{"kind", "idle"}, {"id", state.id}});
}

void Bench::send_lens(const LensWish& wish) {
  const Lens lens = read_lens(wish.name).lens;
  impl_->tell({{"kind", "lens"},
               {"id", wish.id},
               {"name", wish.name},
               {"lens", json::parse(lens_to_json(lens))},
               {"sensor", sensor_for(lens)}});
}

void Bench::send_glasses(const GlassWish& wish) {
  impl_->tell({{"kind", "glasses"}, {"id", wish.id}, {"glasses", glasses_json(wish.text)}});
}

void Bench::focus(const FocusWish& wish) {
  try {
    if (impl_->use.key.empty()) throw InputError("there is no lens that could be focused");
    const CoatedLens lens{impl_->use.lens, impl_->use.camera.losses};
    if (impl_->solid)
      return impl_->tell({{"kind", "focused"},
                          {"id", wish.id},
                          {"distance_m", impl_->renderings.distance_m(wish.place_mm)}});
    impl_->tell({{"kind", "focused"},
                 {"id", wish.id},
                 {"shift_mm", best_spot_focus(lens.lens, field_at(lens, wish.place_mm)).shift_mm}});
  } catch (const Error& error) {
    impl_->problem(wish.id, "focus", error.what());
  }
}

void Bench::save(const SaveWish& wish, const Context& context) {
  const bool of_lens = wish.extension == ".json" || wish.extension == ".zmx" || wish.extension == ".seq";
  const std::string path = impl_->files.path() + "/saved" + wish.extension;
  try {
    if (of_lens && impl_->use.key.empty()) throw InputError("there is no lens that could be saved");
    if (of_lens)
      write_lens(impl_->use.camera.lens, path);
    else if (impl_->solid)
      impl_->renderings.write(path, context);
    else
      impl_->pictures.write(path, context);
    const std::string bytes = read_whole_file(path);
    impl_->send({json{{"kind", "file"}, {"id", wish.id}, {"extension", wish.extension}}.dump(),
                 {bytes.begin(), bytes.end()},
                 true});
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    impl_->problem(wish.id, "save", error.what());
  }
}

/// Reads and keeps a scene that was dropped, and its companion.
void Bench::Impl::take_scene(const Upload& upload) {
  if (dropped == most_dropped_scenes)
    throw InputError(
        fmt::format("this page has {} dropped scenes, the most that are kept; a page that is "
                    "loaded anew takes more",
                    most_dropped_scenes));
  const std::string stem = fmt::format("{}/upload{}", files.path(), dropped);
  const std::string path = stem + upload.extension, beside = stem + upload.companion_extension();
  try {
    write_whole_file(path, upload.bytes);
    if (!upload.companion.empty()) write_whole_file(beside, upload.companion_bytes);
    BenchScene scene = bench_scene(path);
    std::string label = scene.is_spectral() ? "dropped spectra" : "dropped photograph";
    if (is_among(names.scenes, label)) label += fmt::format(" {}", dropped + 1);
    json notes = json::array();
    for (const std::string& note : scene.notes) notes.push_back(without_advice(note));
    scenes[label] = std::move(scene);
    names.scenes.push_back(label);
    ++dropped;
    tell({{"kind", "scenes"},
          {"id", upload.id},
          {"scene", label},
          {"scenes", names.scenes},
          {"notes", std::move(notes)}});
  } catch (const Error& error) {
    std::filesystem::remove(path);
    std::filesystem::remove(beside);
    // The reader names its files; people know them by the names they had.
    std::string text = replaced(error.what(), path, upload.label + upload.extension);
    if (!upload.companion.empty()) text = replaced(text, beside, upload.companion);
    problem(upload.id, "upload", without_paths(replaced(text, stem, upload.label), files.path()));
  }
}

void Bench::Impl::take_lens(const Upload& upload) {
  const std::string path = files.path() + "/upload" + upload.extension;
  try {
    write_whole_file(path, upload.bytes);
    const LensFile read = read_lens(path);
    tell({{"kind", "lens"},
          {"id", upload.id},
          {"name", upload.label},
          {"lens", json::parse(lens_to_json(read.lens))},
          {"sensor", sensor_for(read.lens)},
          {"notes", read.notes}});
  } catch (const Error& error) {
    problem(upload.id, "upload", replaced(error.what(), path, upload.label + upload.extension));
  }
}

void Bench::take(const Upload& upload) {
  try {
    if (is_among(upload_lens_extensions(), upload.extension)) return impl_->take_lens(upload);
    impl_->take_scene(upload);
  } catch (const Error& error) {
    impl_->problem(upload.id, "upload", error.what());
  } catch (const std::bad_alloc&) {
    impl_->problem(upload.id, "upload",
                   upload.label + upload.extension + ": takes more memory than there is");
  }
}

}  // namespace petzval
