// SPDX-License-Identifier: BSD-3-Clause
#include "demo.h"

#include <petzval/base/units.h>
#include <petzval/base/whole_file.h>
#include <petzval/image/picture.h>
#include <petzval/optics/table_interpolation.h>

#include <chrono>
#include <cmath>

namespace petzval::app {

std::string Demo::write(const std::string& name, const std::string& bytes) const {
  write_whole_file(files.stage(folder + "/" + name), bytes);
  return name;
}

html::Image Demo::picture(const std::string& name, const SpectralImage& image, const std::string& description,
                          const Scene* scene) const {
  PictureOptions options;
  if (scene && scene->illuminant && image.bands() > 1) options.scene_white = scene->illuminant;
  write_picture(files.stage(folder + "/" + name), image, options);
  html::Image linked = html::linked_image(name, description);
  linked.columns = image.columns();
  linked.rows = image.rows();
  return linked;
}

Formed form(const Demo& demo, const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
            const ImagingOptions& options) {
  Formed formed;
  const auto start = std::chrono::steady_clock::now();
  formed.image = form_image(scene, table, sensor, options, demo.progress, &formed.report);
  formed.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return formed;
}

std::string with_minus(std::string text) {
  for (std::size_t at = text.find('-'); at != std::string::npos; at = text.find('-', at))
    text.replace(at, 1, "−");
  return text;
}

std::optional<double> scene_distance_m(const LensDataTable& table) {
  if (const std::optional<double> distance = object_to_sensor_mm(table)) return *distance / mm_per_m;
  return {};
}

double covering_angle_deg(const LensDataTable& table, const SensorGeometry& sensor, double spare) {
  const RadialProfiles profiles(table);
  double farthest = 0;  // tangent of the object angle in the corner
  for (const double wavelength : table.wavelengths_nm) {
    const double field = profiles.at_wavelength(wavelength).object_field(sensor.half_diagonal_mm());
    const std::optional<double> distance = object_to_sensor_mm(table);
    farthest = std::max(farthest, distance ? field / *distance : std::tan(radians(field)));
  }
  const double across = 0.5 * sensor.width_mm() / sensor.half_diagonal_mm();
  return 2 * degrees(std::atan(spare * farthest * across));
}

}  // namespace petzval::app
