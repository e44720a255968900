// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>
#include <petzval/render/camera/scene_camera.h>

#include <cmath>
#include <limits>

namespace petzval::render {

namespace {

constexpr int most_pixels_a_side = 65536;

int checked_size(const Parameters& parameters, const char* name, int otherwise, std::optional<int> wanted) {
  const int given = parameters.integer(name, otherwise);
  const int size = wanted.value_or(given);
  if (size < 1 || size > most_pixels_a_side)
    throw scene_error(
        parameters.location_of(name),
        fmt::format("a picture of {} pixels a side; 1 to {} would be right", size, most_pixels_a_side));
  return size;
}

/// Pixels and diagonal as the scene or the user has them.
SensorGeometry scene_film(const Parameters& parameters, const CameraChoice& choice) {
  SensorGeometry geometry;
  geometry.columns = checked_size(parameters, "xresolution", 1280, choice.columns);
  geometry.rows = checked_size(parameters, "yresolution", 720, choice.rows);
  const double diagonal_mm = choice.film_diagonal_mm.value_or(parameters.number("diagonal", 35));
  if (!(diagonal_mm > 0) || !std::isfinite(diagonal_mm))
    throw scene_error(parameters.location_of("diagonal"),
                      fmt::format("a film diagonal of {} mm; above 0 would be right", diagonal_mm));
  geometry.pitch_um = diagonal_mm / std::hypot(geometry.columns, geometry.rows) * um_per_mm;
  return geometry;
}

/// A sensor, or as many pixels of its middle as are wanted.
SensorGeometry sensor_film(const Sensor& sensor, const CameraChoice& choice) {
  if (choice.film_diagonal_mm) throw InputError("a sensor has its own diagonal; give one or the other");
  SensorGeometry geometry = sensor.geometry;
  geometry.columns = choice.columns.value_or(geometry.columns);
  geometry.rows = choice.rows.value_or(geometry.rows);
  if (geometry.columns > sensor.geometry.columns || geometry.rows > sensor.geometry.rows)
    throw InputError(fmt::format("a picture of {} x {} pixels on {}, which has {} x {}; fewer would be right",
                                 geometry.columns, geometry.rows, sensor.name, sensor.geometry.columns,
                                 sensor.geometry.rows));
  return geometry;
}

/// pbrt's "cropwindow", left, right, top and bottom in shares of the film (pixel centres within), or
/// "pixelbounds" of a picture that is as large as the scene has it.
std::optional<PixelWindow> read_crop(const Parameters& parameters, const CameraChoice& choice,
                                     const SensorGeometry& film, std::vector<std::string>& notes) {
  const std::vector<double> shares = parameters.numbers("cropwindow", {"float"});
  const std::vector<int> pixels = parameters.integers("pixelbounds");
  if (shares.empty() && pixels.empty()) return {};
  const char* name = pixels.empty() ? "cropwindow" : "pixelbounds";
  if ((pixels.empty() ? shares.size() : pixels.size()) != 4)
    throw scene_error(parameters.location_of(name), fmt::format("\"{}\" takes four numbers", name));
  if (choice.sensor || (!pixels.empty() && (choice.columns || choice.rows))) {
    notes.push_back(fmt::format("the scene's \"{}\" is of its own film, and is left aside", name));
    return {};
  }
  PixelWindow window;
  if (pixels.empty()) {
    const auto share = [&](std::size_t i, int size) {
      return static_cast<int>(std::ceil(size * std::clamp(shares[i], 0.0, 1.0)));
    };
    window = {share(0, film.columns), share(2, film.rows), share(1, film.columns), share(3, film.rows)};
  } else {
    const auto within = [](int at, int size) { return std::clamp(at, 0, size); };
    window = {within(pixels[0], film.columns), within(pixels[2], film.rows), within(pixels[1], film.columns),
              within(pixels[3], film.rows)};
  }
  if (window.columns() < 1 || window.rows() < 1)
    throw scene_error(
        parameters.location_of(name),
        fmt::format("\"{}\" holds no pixel; left right top bottom within the film would be right", name));
  return window;
}

SensorGeometry read_film(const Entity& film, const Entity& camera, CameraChoice choice,
                         Unsupported& unsupported) {
  if (camera.type == "realistic" && camera.parameters.find("filmdiag") && !choice.film_diagonal_mm &&
      !choice.sensor)
    choice.film_diagonal_mm = camera.parameters.number("filmdiag", 0);

  const Parameters& parameters = film.parameters;
  if (film.type != "rgb" && film.type != "spectral" && film.type != "gbuffer" && film.type != "image" &&
      !film.type.empty())
    unsupported.report(film.location(), fmt::format("Film \"{}\"", film.type));
  SensorGeometry geometry;
  if (choice.sensor) {
    // The scene's numbers are still read, so that wrong ones are noticed.
    checked_size(parameters, "xresolution", 1280, {}), checked_size(parameters, "yresolution", 720, {});
    parameters.number("diagonal", 35);
    geometry = sensor_film(*choice.sensor, choice);
  } else {
    geometry = scene_film(parameters, choice);
  }
  // What pbrt makes of the light afterwards is the business of `sense` and `develop`.
  for (const char* ignored :
       {"filename", "iso", "sensor", "savefp16", "maxcomponentvalue", "whitebalance", "nbuckets", "lambdamin",
        "lambdamax", "coordinatesystem", "exposuretime", "shutter"})
    parameters.find(ignored);
  unsupported.report_unused(parameters, fmt::format("Film \"{}\"", film.type));
  return geometry;
}

void read_perspective(const Parameters& parameters, SceneCamera& camera) {
  PerspectiveOptions& options = camera.perspective;
  options.field_of_view_deg = parameters.number("fov", 90);
  options.lens_radius = parameters.number("lensradius", 0);
  options.focal_distance = parameters.number("focaldistance", 1e6);
  const std::vector<double> window = parameters.numbers("screenwindow", {"float"});
  if (!window.empty() && window.size() != 4)
    throw scene_error(parameters.location_of("screenwindow"), "\"screenwindow\" takes four numbers");
  for (std::size_t i = 0; i < window.size(); ++i) options.screen_window[i] = window[i];
  parameters.number("frameaspectratio", 0);
}

Lens read_scene_lens(const Parameters& parameters) {
  const char* key = parameters.find("specfile") ? "specfile" : "lensfile";
  const std::string name = parameters.string(key, "");
  if (name.empty())
    throw scene_error(parameters.location(), "a realistic camera needs a \"string lensfile\"");
  try {
    return read_lens(resolved_path(parameters.location(), name)).lens;
  } catch (const InputError& error) {
    throw scene_error(parameters.location_of(key), error.what());
  }
}

/// Closes the stop to a diameter; opening it wider than it is made does nothing.
void set_stop(Lens& lens, double diameter_mm, std::vector<std::string>& notes) {
  if (!(diameter_mm > 0) || !std::isfinite(diameter_mm))
    throw InputError(fmt::format("a stop of {} mm diameter; above 0 would be right", diameter_mm));
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, diameter_mm / 2};
  const std::optional<double> made = lens.surfaces[lens.stop_index()].semi_diameter_mm;
  if (made && diameter_mm > 2 * *made)
    notes.push_back(fmt::format("the stop of {} opens to {:g} mm only, not to {:g} mm", lens.name, 2 * *made,
                                diameter_mm));
}

/// The assignment of CS348B has the film's distance from the last surface in the scene.
SceneFocus read_focus(const Parameters& parameters, bool realistic, double scene_units_per_mm) {
  if (realistic && parameters.find("filmdistance")) return {parameters.number("filmdistance", 0), {}};
  const double m_per_unit = 1 / (scene_units_per_mm * mm_per_m);
  const double distance =
      parameters.number(realistic ? "focusdistance" : "focaldistance", realistic ? 10 : -1);
  return {{}, distance > 0 ? std::optional(distance * m_per_unit) : std::nullopt};
}

Lens scene_or_chosen_lens(const CameraChoice& choice, const Parameters& parameters, bool realistic,
                          std::vector<std::string>& notes) {
  Lens lens = choice.lens ? *choice.lens : read_scene_lens(parameters);
  if (realistic) parameters.string("lensfile", "");
  const double scene_stop =
      realistic ? parameters.number("aperture_diameter", parameters.number("aperturediameter", 1)) : -1;
  if (choice.aperture_diameter_mm)
    set_stop(lens, *choice.aperture_diameter_mm, notes);
  else if (choice.scene_stop && !choice.lens && scene_stop > 0)
    set_stop(lens, scene_stop, notes);
  return lens;
}

/// A clipping plane as pbrt's first version had them. \throws InputError unless it is no nearer than 0.
double clipping(const Parameters& parameters, const char* name, double otherwise) {
  const double distance = parameters.number(name, otherwise);
  if (!(distance >= 0))
    throw scene_error(parameters.location_of(name),
                      fmt::format("\"{}\" at {}; 0 or more would be right", name, distance));
  return distance;
}

void read_camera(const SceneDescription& scene, const CameraChoice& choice, Unsupported& unsupported,
                 SceneCamera& camera) {
  const Entity& entity = scene.camera;
  const Parameters& parameters = entity.parameters;
  const bool realistic = entity.type == "realistic";
  if (!realistic && entity.type != "perspective" && !entity.type.empty())
    unsupported.report(entity.location(), fmt::format("Camera \"{}\"", entity.type));
  camera.clipping.near = clipping(parameters, "hither", 0);
  camera.clipping.far = clipping(parameters, "yon", std::numeric_limits<double>::infinity());
  for (const char* ignored : {"shutteropen", "shutterclose", "simpleweighting"}) parameters.find(ignored);
  if (const Parameter* aperture = parameters.find("aperture"))
    if (aperture->strings.empty() || aperture->strings[0] != "circular")
      unsupported.report(aperture->at, "an aperture of another shape than a circle");
  if (!realistic) read_perspective(parameters, camera);
  if (realistic && choice.pinhole)
    throw scene_error(entity.location(),
                      "the scene's camera is a real lens; it has no perspective for a `pinhole`");
  if ((realistic || choice.lens) && !choice.pinhole) {
    camera.lens = scene_or_chosen_lens(choice, parameters, realistic, camera.notes);
    camera.focus = read_focus(parameters, realistic, choice.options.scene_units_per_mm);
  }
  if (choice.pinhole) camera.perspective.lens_radius = 0;
  if (realistic)
    for (const char* each : {"aperturediameter", "focusdistance", "lensfile", "aperture_diameter",
                             "filmdistance", "filmdiag", "specfile"})
      parameters.find(each);
  unsupported.report_unused(parameters, fmt::format("Camera \"{}\"", entity.type));
}

}  // namespace

SceneCamera set_up_camera(const SceneDescription& scene, const CameraChoice& choice,
                          Unsupported& unsupported) {
  SceneCamera camera;
  scene.film.parameters.find("cropwindow"), scene.film.parameters.find("pixelbounds");
  camera.film = read_film(scene.film, scene.camera, choice, unsupported);
  camera.crop = read_crop(scene.film.parameters, choice, camera.film, camera.notes);
  if (choice.sensor) camera.photosite = choice.sensor->photosite;
  camera.options = choice.options;
  camera.options.margin_pixels = std::max(camera.photosite.separation_x, camera.photosite.separation_y) / 2;
  camera.world_from_camera = scene.camera_from_world.inverse();
  read_camera(scene, choice, unsupported, camera);
  camera.perspective.columns = camera.film.columns;
  camera.perspective.rows = camera.film.rows;
  return camera;
}

double SceneCamera::film_distance_mm() const {
  return lens ? lens->image_distance_mm() : 0;
}

SceneCamera SceneCamera::with_film_distance_mm(double distance_mm) const {
  if (!lens) throw InputError("an ideal camera has no film distance; a lens has");
  SceneCamera moved = *this;
  moved.lens->set_image_distance_mm(distance_mm);
  return moved;
}

std::unique_ptr<const FilmCamera> SceneCamera::make(const WavelengthGroups& groups) const {
  if (lens) return std::make_unique<const LensCamera>(*lens, film, groups, options);
  return std::make_unique<const PerspectiveCamera>(perspective, groups);
}

}  // namespace petzval::render
