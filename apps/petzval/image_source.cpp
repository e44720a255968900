// SPDX-License-Identifier: BSD-3-Clause
#include "image_source.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/camera/mounted_lens.h>
#include <petzval/imaging/field_of_view.h>
#include <petzval/optics/build.h>
#include <petzval/optics/table_file.h>

#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "image_depth.h"
#include "sensor_option.h"

namespace petzval::app {

namespace {

/// The distance in --focus, if it is one; infinite for "infinity".
std::optional<double> focus_distance_mm(const std::string& focus) {
  if (focus == "auto" || focus == "design") return {};
  if (focus == "infinity" || focus == "inf") return INFINITY;
  double distance_mm = 0;
  const auto [end, error] = std::from_chars(focus.data(), focus.data() + focus.size(), distance_mm);
  if (error != std::errc() || end != focus.data() + focus.size() || !(distance_mm > 0))
    throw InputError(fmt::format(
        "--focus {}: auto (the scene), design, infinity or a distance from the sensor in mm would be right",
        focus));
  return distance_mm;
}

/// Where a chart or a photograph stands if nobody says: where the lens or its table expects the object.
Scene read_scene(const ImageChoice& choice, std::optional<double> expected_m, bool expected) {
  SceneOptions defaults;
  if (expected && choice.scene.is_open() && !choice.scene.is_deep())
    defaults.distance_m = expected_m.value_or(INFINITY);
  Scene scene = choice.scene.read(defaults);
  scene.validate();
  return scene;
}

/// The lens as it is used: focused as asked, the object where the scene is.
Lens focused(MountedLens camera, const std::string& focus, std::optional<double> scene_distance_m) {
  if (focus == "auto") {
    camera.focus_at_m(scene_distance_m);
    return camera.lens();
  }
  if (const std::optional<double> distance_mm = focus_distance_mm(focus))
    camera.focus_at_m(*distance_mm / mm_per_m);
  // The sensor stays; only the object moves.
  MountedLens here(camera.lens());
  if (here.object_distance_from_sensor_m() != scene_distance_m) here.place_object_at_m(scene_distance_m);
  return here.lens();
}

/// How far from the axis light will be wanted: to the sensor's corner, or to that of the scene's image.
double image_height_mm(const Scene& scene, const Lens& lens, const std::optional<SensorGeometry>& sensor) {
  if (sensor) return sensor->half_diagonal_mm();
  return natural_pitch_um(scene, first_order(lens)) * mm_per_um * std::hypot(scene.columns(), scene.rows()) /
         2;
}

SceneAndTable from_stored_table(const ImageChoice& choice) {
  LensDataTable table = read_table(choice.optics);
  std::optional<double> distance_m = object_to_sensor_mm(table);
  if (distance_m) *distance_m /= mm_per_m;
  return {read_scene(choice, distance_m, true), std::move(table), {}};
}

/// What a scene with depth is focused on: the object of the lens, though each layer will have its own.
std::optional<double> object_in_focus_m(const ImageChoice& choice, const Scene& scene,
                                        const MountedLens& camera) {
  if (choice.focus == "auto") return depth_focus_m(scene, camera);
  const std::optional<double> asked_mm = focus_distance_mm(choice.focus);
  if (!asked_mm) return camera.object_distance_from_sensor_m();
  return std::isinf(*asked_mm) ? std::nullopt : std::optional(*asked_mm / mm_per_m);
}

/// Every `step`th of the wavelengths, and the last.
std::vector<double> thinned(const std::vector<double>& wavelengths_nm, std::size_t step) {
  std::vector<double> few;
  for (std::size_t i = 0; i < wavelengths_nm.size(); i += step) few.push_back(wavelengths_nm[i]);
  if (few.back() != wavelengths_nm.back()) few.push_back(wavelengths_nm.back());
  return few;
}

TableOptions table_options(const ImageChoice& choice, const Scene& scene, TableDetail detail) {
  TableOptions options;
  options.wavelengths_nm = scene.wavelengths_nm();
  if (detail == TableDetail::outline) {
    constexpr std::size_t step = 5;
    options.wavelengths_nm = thinned(options.wavelengths_nm, step);
    options.field_count = 11;
  }
  if (choice.apertures.ignore_apertures) options.clip = Tracer::Clip::stop_only;
  return options;
}

SceneAndTable from_lens(const ImageChoice& choice, const std::optional<SensorGeometry>& sensor,
                        const ProgressCallback& progress, const Shared& shared, TableDetail detail) {
  focus_distance_mm(choice.focus);  // refuses nonsense before anything is read
  MountedLens camera(choice.apertures.prepare(choice.lens.read(shared), shared));
  if (choice.f_number) camera.set_f_number(*choice.f_number);
  Scene scene = read_scene(choice, camera.object_distance_from_sensor_m(), choice.focus == "design");
  const bool deep = !scene.depth_m.empty();
  if (scene.distance_m() && !deep) {
    MountedLens placed = camera;
    placed.place_object_at_m(scene.distance_m());
    if (!placed.lens().object_distance_mm) scene.set_distance_m({});  // so far away that this is infinity
  }
  const Lens lens =
      focused(camera, choice.focus, deep ? object_in_focus_m(choice, scene, camera) : scene.distance_m());
  TableOptions options = table_options(choice, scene, detail);
  if (deep) {
    options.max_image_height_mm = depth_image_height_mm(scene, lens, sensor);
    return {std::move(scene), facts_alone(lens),
            DepthCamera{lens, options, std::make_shared<std::map<std::string, LensDataTable>>()}};
  }
  options.max_image_height_mm = image_height_mm(scene, lens, sensor);
  return {std::move(scene), build_lens_data_table(lens, options, progress), {}};
}

}  // namespace

SceneAndTable read_source(const ImageChoice& choice, const std::optional<SensorGeometry>& sensor,
                          const ProgressCallback& progress, const Shared& shared, TableDetail detail) {
  return choice.optics.empty() ? from_lens(choice, sensor, progress, shared, detail)
                               : from_stored_table(choice);
}

namespace {

double filling_angle_deg(const ImageChoice& choice, const ImagingOptions& options, const Scene& scene,
                         const LensDataTable& table, const std::optional<DepthCamera>& depth,
                         const SensorGeometry& sensor) {
  return depth ? covering_depth_angle_deg(scene, *depth, sensor, options, choice.depth)
               : covering_angle_deg(scene, table, sensor, options);
}

}  // namespace

bool fills_frame(const ImageChoice& choice) {
  return !choice.sensor.empty() && choice.scene.is_open() && choice.scene.angle.empty() &&
         choice.imaging_options().surround == Surround::error;
}

std::optional<double> filling_angle_deg(const ImageChoice& choice, const Shared& shared) {
  choice.check();
  if (!fills_frame(choice)) return {};
  const Sensor sensor = read_sensor(choice.sensor, choice.sensor_settings);
  ImagingOptions options = choice.imaging_options();
  options.photosite = sensor.photosite;
  const auto [scene, table, depth] = read_source(choice, sensor.geometry, {}, shared, TableDetail::outline);
  return filling_angle_deg(choice, options, scene, table, depth, sensor.geometry);
}

SensorGeometry fit_to_each_other(const ImageChoice& choice, const ImagingOptions& options, Scene& scene,
                                 const LensDataTable& table, const std::optional<DepthCamera>& depth,
                                 const std::optional<SensorGeometry>& sensor, const Shared& shared) {
  if (!sensor) {
    const SensorGeometry frame = depth ? natural_depth_sensor(scene, *depth, options, choice.depth)
                                       : natural_sensor(scene, table, options);
    note(shared,
         fmt::format("no --sensor: {} x {} pixels of {:.5g} um, the scene's samples as the lens images them "
                     "on the axis, as many as the scene covers",
                     frame.columns, frame.rows, frame.pitch_um));
    return frame;
  }
  if (fills_frame(choice)) {
    const double fills_deg = filling_angle_deg(choice, options, scene, table, depth, *sensor);
    scene.set_horizontal_angle_deg(std::max(fills_deg, choice.scene_angle_least.value_or(0)));
    note(shared,
         fmt::format("the {} is made {:.2f} degrees wide, to fill the frame and the margin of the PSF "
                     "(--scene-angle sets another)",
                     choice.scene.is_chart() ? "chart" : "photograph", scene.horizontal_angle_deg()));
  }
  return *sensor;
}

}  // namespace petzval::app
