// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/imaging/band_blur.h>
#include <petzval/imaging/coverage.h>
#include <petzval/imaging/image_frame.h>
#include <petzval/sensor/lens_facts.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace petzval {

namespace {

void check_distances(const Scene& scene, const LensDataTable& table) {
  const std::optional<double> table_mm = object_to_sensor_mm(table);
  const auto say = [](std::optional<double> mm) {
    return mm ? fmt::format("{:.6g} m", *mm / mm_per_m) : "infinity";
  };
  std::optional<double> scene_mm = scene.distance_m();
  if (scene_mm) *scene_mm *= mm_per_m;
  constexpr double relative_tolerance = 1e-3;
  const bool agree = scene_mm && table_mm ? std::abs(*scene_mm - *table_mm) <= relative_tolerance * *table_mm
                                          : !scene_mm && !table_mm;
  if (!agree)
    throw InputError(
        fmt::format("the scene is at {}, but the lens data table was made for an object at {} from the "
                    "sensor; give the scene that distance, or build the table for the scene's",
                    say(scene_mm), say(table_mm)));
}

}  // namespace

SectionOptions ImagingOptions::section_options() const {
  return {sections.section, sections.transform, method == BlurMethod::blended};
}

int ImagingOptions::cells_per_pixel() const {
  return cells_for(photosite, method == BlurMethod::none ? 1 : 2, supersample);
}

SensorGeometry ImagingOptions::cells_of(const SensorGeometry& sensor) const {
  const int cells = cells_per_pixel();
  const int reach = photosite.is_plain() ? 0 : pixel_taps(photosite, cells, 0).reach;
  return grown(subdivided(sensor, cells), reach);
}

void ImagingOptions::validate() const {
  constexpr int most = 16;
  if (supersample < 1 || supersample > most)
    throw InputError(fmt::format("supersampling of {}: 1 to {} is right", supersample, most));
  pixel_taps(photosite, supersample, 0);
  product.validate();
  if (by_sections()) transform_size({sections.section, 0, method == BlurMethod::blended}, 0);
}

std::optional<double> object_to_sensor_mm(const LensDataTable& table) {
  if (!table.object_distance_mm) return std::nullopt;
  return *table.object_distance_mm + table.vertex_to_sensor_mm;
}

SpectralImage form_image(const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
                         const ImagingOptions& options, const ProgressCallback& progress,
                         ImagingReport* report) {
  ImagingReport own;
  ImagingReport& says = report != nullptr ? *report : own;
  says = {};

  // Everything that can be refused is refused before the work starts.
  options.validate();
  scene.validate();
  table.validate();
  check_distances(scene, table);
  SpectralImage image = blank_image(scene, sensor, options);
  const SensorGeometry frame = options.cells_of(sensor);
  const std::vector<BandPlan> plans = plan_bands(scene, table, frame, options);
  check_coverage(scene, plans, frame, options.surround, says.notes);
  note_dark_corners(plans, frame, says.notes);
  says.scene_points_per_cell = points_per_cell(plans, frame);

  const PixelTaps taps = image_taps(options, says);

  BandBlur blur(table, options, says);
  for (int band = 0; band < scene.bands(); ++band) {
    const BandPlan& plan = plans[static_cast<std::size_t>(band)];
    const auto start = std::chrono::steady_clock::now();
    CellPlane ideal = ideal_irradiance(scene, band, plan.map, grown(frame, plan.margin),
                                       says.scene_points_per_cell, options.surround);
    says.distortion_seconds += seconds_since(start);

    const auto start_of_blur = std::chrono::steady_clock::now();
    const double wavelength_nm = scene.wavelengths_nm()[static_cast<std::size_t>(band)];
    const auto within_band = [&](double fraction, const std::string& what) {
      if (progress) progress((band + fraction) / scene.bands(), what);
    };
    blur.prepare(wavelength_nm, ideal.grid, plan.margin);
    const CellPlane blurred = blur(std::move(ideal), within_band);
    says.blur_seconds += seconds_since(start_of_blur);

    put_band(gathered(blurred, taps), band, image, says);
    scene.release_memory();
    says.margin_cells = std::max(says.margin_cells, plan.margin);
    says.least_captured = std::min(says.least_captured, plan.least_captured);
    if (progress) progress((band + 1.0) / scene.bands(), "image");
  }
  image.lens = lens_facts(table.lens_name, table.first_order);
  note_result(options, says);
  return image;
}

}  // namespace petzval
