// SPDX-License-Identifier: BSD-3-Clause
#include "scene_focus.h"

#include <fmt/format.h>
#include <petzval/analysis/best_focus.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/camera/mounted_lens.h>
#include <petzval/colour/display.h>
#include <petzval/colour/observer.h>
#include <petzval/focus/focus_scan.h>
#include <petzval/focus/golden_search_2006.h>
#include <petzval/lens/first_order.h>
#include <petzval/render/renderer.h>

#include <algorithm>
#include <cmath>

namespace petzval::app {

namespace {

/// How far from the focus of infinity the film may go, in focal lengths: as far as for an object eight focal
/// lengths away.
constexpr double extension = 0.15;
/// Where golden section ends, in depths of focus.
constexpr double share_of_depth = 0.05;
/// How far the film may go beyond the focus of infinity, in depths of focus: a peak there has two flanks.
constexpr double depths_beyond = 4;

/// Where the film stands for an object at infinity: at the paraxial focus, or where the spot on the axis is
/// smallest, whichever is nearer to the lens (spherical aberration parts them).
double infinity_focus_mm(const Lens& lens) {
  MountedLens camera(lens);
  camera.focus_at_m({});
  FieldTableRequest axis = FieldTableRequest::of(camera.lens());
  axis.field_kind = Fields::Kind::angle_deg, axis.fields = {0};
  const double film_mm = camera.lens().surfaces.back().thickness_mm;
  return std::min(paraxial_image_distance_mm(lens, {}, lens.reference_wavelength_nm),
                  film_mm + best_spot_focus(camera.lens(), axis).shift_mm);
}

render::PixelWindow window_of(const FocusZone& zone, const SensorGeometry& film) {
  const auto at = [](double share, int pixels) {
    return std::clamp(static_cast<int>(std::lround(share * pixels)), 0, pixels);
  };
  const render::PixelWindow window{at(zone.left, film.columns), at(zone.top, film.rows),
                                   at(zone.right, film.columns), at(zone.bottom, film.rows)};
  if (window.columns() < 4 || window.rows() < 4)
    throw InputError(
        fmt::format("the zone {:g} {:g} {:g} {:g} has {} x {} pixels; at least 4 x 4 would be right",
                    zone.left, zone.right, zone.top, zone.bottom, window.columns(), window.rows()));
  return window;
}

/// max(R, G, B) of every pixel.
GreyPicture brightest_component(const SpectralImage& image) {
  const std::vector<Xyz> weights = Observer::cie_1931().weights(image.wavelengths_nm());
  GreyPicture grey{image.columns(), image.rows(), std::vector<double>(image.band_size())};
  for (std::size_t i = 0; i < image.band_size(); ++i) {
    Xyz sum;
    for (int band = 0; band < image.bands(); ++band)
      sum = sum + static_cast<double>(image.band(band)[i]) * weights[static_cast<std::size_t>(band)];
    const LinearRgb rgb = linear_srgb(sum);
    grey.values[i] = std::max({rgb.r, rgb.g, rgb.b});
  }
  return grey;
}

/// One zone as the camera sees it; adds to the account of camera rays.
GreyPicture zone_picture(const PreparedScene& scene, const render::SceneCamera& set_up,
                         const render::FilmCamera& camera, const render::RenderOptions& options,
                         std::uint64_t& camera_rays) {
  const render::Rendering picture =
      render_picture(*scene.world, camera, set_up.world_from_camera, set_up.film, options);
  camera_rays += picture.rays;
  return brightest_component(picture.irradiance);
}

/// Pictures of the zones of a scene.
PicturesAt zone_pictures(const PreparedScene& scene, const std::vector<FocusZone>& zones,
                         const FocusChoice& choice, const Shared& shared, std::uint64_t& camera_rays) {
  return [&scene, &zones, &choice, &shared, &camera_rays](double film_distance_mm) {
    const render::SceneCamera moved = scene.camera.with_film_distance_mm(film_distance_mm);
    const auto camera = moved.make(scene.world->groups);
    std::vector<ZonePicture> pictures;
    for (const FocusZone& zone : zones) {
      render::RenderOptions options;
      options.samples_per_pixel = std::max(1, choice.samples / 2);
      options.path = scene.path;
      options.photosite = moved.photosite;
      options.clipping = moved.clipping;
      options.window = window_of(zone, moved.film);
      options.seed = 2 * shared.seed;
      ZonePicture picture{zone_picture(scene, moved, *camera, options, camera_rays), {}};
      options.seed = 2 * shared.seed + 1;
      picture.second = zone_picture(scene, moved, *camera, options, camera_rays);
      pictures.push_back(std::move(picture));
    }
    return pictures;
  };
}

}  // namespace

void FocusChoice::add_to(CLI::App& command) {
  command
      .add_option("--focus-measure", measure, "Sum-modified-Laplacian (sml), gradient or laplacian energy")
      ->check(CLI::IsMember({"sml", "gradient", "laplacian"}))
      ->capture_default_str();
  command.add_option("--focus-step", step, "Pixels between the points of its differences")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command.add_option("--focus-threshold", threshold, "Modified Laplacians below this do not count")
      ->capture_default_str();
  command
      .add_option(
          "--focus-search", search,
          "Coarse places then Brent's method, the golden sections of 2006, or all places evenly over the "
          "range (scan)")
      ->check(CLI::IsMember({"brent", "golden-2006", "scan"}))
      ->capture_default_str();
  command.add_option("--focus-spp", samples, "Camera paths a pixel of the zones")
      ->check(CLI::Range(2, 1 << 20))
      ->capture_default_str();
  command.add_option("--focus-from", from_mm,
                     "Film distances searched, from [mm]; default: a little before infinity is sharp");
  command.add_option("--focus-to", to_mm,
                     "Film distances searched, to [mm]; default: 0.15 focal lengths beyond that of infinity");
  command
      .add_option("--focus-depth", depth_mm,
                  "Depth of focus [mm], the scale of the search; default: f-number times pixel")
      ->check(positive_number());
  command.add_option("--focus-evaluations", most_evaluations, "At most so many")->capture_default_str();
}

std::vector<FocusZone> focus_zones(const FocusChoice& choice) {
  std::vector<FocusZone> zones;
  if (!choice.zones_file.empty()) zones = read_focus_zones(choice.zones_file);
  for (const std::string& zone : choice.zones) {
    const std::vector<FocusZone> one = parse_focus_zones(zone, "--zone " + zone);
    zones.insert(zones.end(), one.begin(), one.end());
  }
  if (zones.empty()) zones.push_back({1.0 / 3, 2.0 / 3, 1.0 / 3, 2.0 / 3});
  return zones;
}

FocusRun autofocus(const PreparedScene& scene, const FocusChoice& choice, const Shared& shared) {
  if (!scene.camera.lens) throw InputError("an ideal camera has nothing to focus; --lens names a lens");
  const Lens& lens = *scene.camera.lens;
  const FirstOrder first = first_order(lens);
  const std::vector<FocusZone> zones = focus_zones(choice);
  FocusRun run;
  const PicturesAt pictures = zone_pictures(scene, zones, choice, shared, run.camera_rays);
  run.depth_mm = choice.depth_mm.value_or(first.f_number * scene.camera.film.pitch_um * mm_per_um);
  const double infinity_mm = infinity_focus_mm(lens);
  const double from =
      choice.from_mm.value_or(std::max(infinity_mm - depths_beyond * run.depth_mm, infinity_mm / 2));
  const double to = choice.to_mm.value_or(infinity_mm + extension * first.efl_mm);
  const FocusMeasureOptions measure{focus_measure_of(choice.measure), choice.step, choice.threshold};
  if (choice.search == "golden-2006") {
    GoldenSearchOptions options;
    options.measure = measure;
    options.nearest_mm = from, options.farthest_mm = to;
    options.tolerance_mm = share_of_depth * run.depth_mm;
    run.result = find_focus_2006(pictures, zones, options);
  } else if (choice.search == "scan") {
    run.result = scan_focus(pictures, zones, measure, from, to, choice.most_evaluations);
  } else {
    FocusSearchOptions options;
    options.measure = measure;
    options.nearest_mm = from, options.farthest_mm = to;
    options.depth_mm = run.depth_mm;
    options.most_evaluations = choice.most_evaluations;
    run.result = find_focus(pictures, zones, options);
  }
  return run;
}

std::vector<double> focus_wavelengths_nm() {
  return {430, 465, 500, 535, 570, 605, 640, 675};
}

}  // namespace petzval::app
