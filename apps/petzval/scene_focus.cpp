// SPDX-License-Identifier: BSD-3-Clause
#include "scene_focus.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/colour/display.h>
#include <petzval/colour/observer.h>
#include <petzval/lens/first_order.h>
#include <petzval/render/renderer.h>

#include <algorithm>
#include <cmath>

namespace petzval::app {

namespace {

/// How far from the focus of infinity the film may go, in focal lengths: as far as for an object eight focal
/// lengths away.
constexpr double extension = 0.15;
/// Share of the depth of focus to which the distance is wanted.
constexpr double share_of_depth = 0.05;

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

/// Pictures of the zones of a scene.
PicturesAt zone_pictures(const PreparedScene& scene, const std::vector<FocusZone>& zones,
                         const FocusChoice& choice, const Shared& shared) {
  return [&scene, &zones, &choice, &shared](double film_distance_mm) {
    const render::SceneCamera moved = scene.camera.with_film_distance_mm(film_distance_mm);
    const auto camera = moved.make(scene.world->groups);
    std::vector<ZonePicture> pictures;
    for (const FocusZone& zone : zones) {
      render::RenderOptions options;
      options.samples_per_pixel = std::max(1, choice.samples / 2);
      options.path = scene.path;
      options.photosite = moved.photosite;
      options.window = window_of(zone, moved.film);
      ZonePicture picture;
      options.seed = 2 * shared.seed;
      picture.first = brightest_component(
          render_picture(*scene.world, *camera, moved.world_from_camera, moved.film, options).irradiance);
      options.seed = 2 * shared.seed + 1;
      picture.second = brightest_component(
          render_picture(*scene.world, *camera, moved.world_from_camera, moved.film, options).irradiance);
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
      .add_option("--focus-search", search,
                  "Coarse places then Brent's method, or the golden sections of 2006")
      ->check(CLI::IsMember({"brent", "golden-2006"}))
      ->capture_default_str();
  command.add_option("--focus-spp", samples, "Camera paths a pixel of the zones")
      ->check(CLI::Range(2, 1 << 20))
      ->capture_default_str();
  command.add_option("--focus-from", from_mm,
                     "Film distances searched, from [mm]; default: sharp at infinity");
  command.add_option("--focus-to", to_mm,
                     "Film distances searched, to [mm]; default: 0.15 focal lengths farther");
  command.add_option("--focus-tolerance", tolerance_mm, "[mm]; default: a twentieth of f-number times pixel");
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

FocusResult autofocus(const PreparedScene& scene, const FocusChoice& choice, const Shared& shared) {
  if (!scene.camera.lens) throw InputError("an ideal camera has nothing to focus; --lens names a lens");
  const Lens& lens = *scene.camera.lens;
  const FirstOrder first = first_order(lens);
  const std::vector<FocusZone> zones = focus_zones(choice);
  const PicturesAt pictures = zone_pictures(scene, zones, choice, shared);
  const double infinity_mm = paraxial_image_distance_mm(lens, {}, lens.reference_wavelength_nm);
  const double from = choice.from_mm.value_or(infinity_mm),
               to = choice.to_mm.value_or(from + extension * first.efl_mm);
  const double tolerance =
      choice.tolerance_mm.value_or(share_of_depth * first.f_number * scene.camera.film.pitch_um * mm_per_um);
  const FocusMeasureOptions measure{focus_measure_of(choice.measure), choice.step, choice.threshold};
  if (choice.search == "golden-2006") {
    GoldenSearchOptions options;
    options.measure = measure;
    options.nearest_mm = from, options.farthest_mm = to;
    options.tolerance_mm = tolerance;
    return find_focus_2006(pictures, zones, options);
  }
  FocusSearchOptions options;
  options.measure = measure;
  options.nearest_mm = from, options.farthest_mm = to;
  options.tolerance_mm = tolerance;
  options.most_evaluations = choice.most_evaluations;
  return find_focus(pictures, zones, options);
}

std::vector<double> focus_wavelengths_nm() {
  return {430, 465, 500, 535, 570, 605, 640, 675};
}

}  // namespace petzval::app
