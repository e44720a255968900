// SPDX-License-Identifier: BSD-3-Clause
// A tilted checkerboard to measure lenses by: as a scene at infinity, as lights in a plane, as a picture.
#pragma once

#include <fmt/format.h>
#include <petzval/base/units.h>
#include <petzval/imaging/image_formation.h>
#include <petzval/measure/sfr/measure_picture.h>
#include <petzval/render/camera/lens_camera.h>
#include <petzval/render/renderer.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <string>

namespace petzval {

inline constexpr double board_nm = 550, board_tilt_deg = 7, square_px = 74;
inline constexpr int scene_per_px = 5;

/// Whether a place of the board [pixels] is bright.
inline bool on_bright_square(double x, double y) {
  const double c = std::cos(radians(board_tilt_deg)), s = std::sin(radians(board_tilt_deg));
  const double u = (x * c + y * s) / square_px + 0.31, v = (y * c - x * s) / square_px + 0.17;
  return (static_cast<long>(std::floor(u)) + static_cast<long>(std::floor(v))) % 2 == 0;
}

/// The board as a scene at infinity, wider than the sensor sees it.
inline Scene board_scene(const SensorGeometry& sensor, double focal_length_mm) {
  const int columns = static_cast<int>(sensor.columns * 1.25) * scene_per_px;
  const int rows = static_cast<int>(sensor.rows * 1.25) * scene_per_px;
  const double half_tangent = columns * sensor.pitch_um * 1e-3 / (2 * scene_per_px * focal_length_mm);
  Scene scene(columns, rows, {board_nm}, 2 * degrees(std::atan(half_tangent)), {});
  const std::span<float> band = scene.band(0);
  constexpr int parts = 4;  // a side, of every sample
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      int bright = 0;
      for (int i = 0; i < parts * parts; ++i)
        bright += on_bright_square((column + (i % parts + 0.5) / parts - columns / 2.0) / scene_per_px,
                                   (row + (i / parts + 0.5) / parts - rows / 2.0) / scene_per_px);
      band[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column)] = static_cast<float>(0.1 + 0.9 * bright / (parts * parts));
    }
  return scene;
}

inline double sinc(double x) {
  return x == 0 ? 1 : std::sin(pi * x) / (pi * x);
}

inline PicturePlanes picture_of(const SensorGeometry& sensor, std::span<const float> band, double noise,
                                unsigned seed) {
  PicturePlanes picture;
  picture.columns = sensor.columns, picture.rows = sensor.rows;
  Plane plane{sensor.columns, sensor.rows, {band.begin(), band.end()}};
  const double bright = *std::max_element(plane.values.begin(), plane.values.end());
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, noise * bright);
  if (noise > 0)
    for (double& value : plane.values) value += normal(random);
  picture.planes.push_back(std::move(plane));
  return picture;
}

/// The bright squares of the board as lights in a plane, in metres.
inline std::string glowing_board(double distance_m, double square_m, int squares) {
  std::string indices, points;
  const double c = std::cos(radians(board_tilt_deg)), s = std::sin(radians(board_tilt_deg));
  int count = 0;
  for (int i = -squares; i < squares; ++i)
    for (int j = -squares; j < squares; ++j) {
      if ((i + j) % 2 != 0) continue;
      for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        const double x = (i + u - 0.31) * square_m, y = (j + v - 0.17) * square_m;
        points += fmt::format(" {:.10g} {:.10g} {:.10g}", x * c - y * s, x * s + y * c, distance_m);
      }
      for (const int corner : {0, 1, 2, 0, 2, 3}) indices += fmt::format(" {}", count + corner);
      count += 4;
    }
  return "WorldBegin\nAreaLightSource \"diffuse\" \"spectrum L\" [ 200 1 900 1 ] \"bool twosided\" true\n"
         "Shape \"trianglemesh\" \"integer indices\" [" +
         indices + " ] \"point3 P\" [" + points + " ]\n";
}

/// The glowing board through a lens of 12.59 mm that is focused there, by 256 paths a pixel: a square is
/// about `square_px` wide.
inline SpectralImage rendered_board(const Lens& lens, const SensorGeometry& film, double distance_m) {
  const double scale_m_per_px = distance_m / 12.59 * film.pitch_um * 1e-3;
  render::Unsupported unsupported;
  const auto world = render::build_world(
      render::parse_scene_description(glowing_board(distance_m, square_px * scale_m_per_px, 6), "board.pbrt",
                                      unsupported),
      render::WavelengthGroups({board_nm}), {true}, unsupported);
  const render::LensCamera lens_camera(lens, film, world->groups);
  render::RenderOptions options;
  options.samples_per_pixel = 256;
  options.path.max_depth = 0;
  return render::render_picture(*world, lens_camera, render::Transform(), film, options).irradiance;
}

}  // namespace petzval
