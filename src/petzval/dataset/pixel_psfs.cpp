// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/dataset/flat_truth.h>
#include <petzval/dataset/pixel_psfs.h>
#include <petzval/lens/lens_file.h>
#include <petzval/numeric/lattice_spline.h>
#include <petzval/optics/frame_build.h>
#include <petzval/simulate/chief_rays.h>
#include <petzval/simulate/psf_stack.h>
#include <petzval/trace/tracer.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace petzval {

namespace {

/// A PSF of a stack in image space.
struct TurnedPsf {
  const float* values;
  int cells;
  double spacing_um;
  double e_x, e_y;  ///< where its t points
  double weight;
};

/// Adds it to size × size pixels about its centre of light.
void add_to_pixels(const TurnedPsf& psf, double pitch_um, int size, float* pixels) {
  const auto offset = [&](int cell) { return (cell - psf.cells / 2) * psf.spacing_um; };
  double sum = 0, middle_t = 0, middle_s = 0;
  for (int i = 0; i < psf.cells; ++i)
    for (int j = 0; j < psf.cells; ++j) {
      const double light = static_cast<double>(psf.values[i * psf.cells + j]);
      sum += light, middle_t += light * offset(i), middle_s += light * offset(j);
    }
  if (!(sum > 0)) return;
  middle_t /= sum, middle_s /= sum;
  // A sample is a square of its spacing: in parts no wider than a sixteenth of a pixel, which fall into the
  // pixels that hold their middles.
  const int parts = std::max(1, static_cast<int>(std::ceil(16 * psf.spacing_um / pitch_um)));
  for (int i = 0; i < psf.cells; ++i)
    for (int j = 0; j < psf.cells; ++j) {
      const double light = psf.weight * static_cast<double>(psf.values[i * psf.cells + j]) / (parts * parts);
      if (light == 0) continue;
      for (int a = 0; a < parts; ++a)
        for (int b = 0; b < parts; ++b) {
          const double t = offset(i) - middle_t + ((a + 0.5) / parts - 0.5) * psf.spacing_um;
          const double s = offset(j) - middle_s + ((b + 0.5) / parts - 0.5) * psf.spacing_um;
          const double x = s * psf.e_y + t * psf.e_x, y = -s * psf.e_x + t * psf.e_y;
          const auto column = static_cast<int>(std::floor(-x / pitch_um + size / 2.0));
          const auto row = static_cast<int>(std::floor(y / pitch_um + size / 2.0));
          if (column < 0 || row < 0 || column >= size || row >= size) continue;
          pixels[row * size + column] += static_cast<float>(light);
        }
    }
}

/// The PSFs of a place, and where their t points in image space.
struct PlacePsfs {
  PsfStack stack;
  double e_x = 0, e_y = 1;
};

/// \param seen_x, seen_y  what a place sees, as FramePlaces has it. \throws InputError where no light
/// arrives.
PlacePsfs psfs_towards(const Lens& lens, double seen_x, double seen_y,
                       const std::vector<double>& wavelengths_nm, const Context& context) {
  // What is seen lies along the image; a field tracer counts from the object.
  const double sign = towards_positive_image(lens), field = std::hypot(seen_x, seen_y);
  FieldTableRequest at{.wavelengths_nm = wavelengths_nm};
  at.field_kind = lens.object_distance_mm ? Fields::Kind::object_height_mm : Fields::Kind::angle_deg;
  at.fields = {field};
  at.azimuth_deg = degrees(std::atan2(-sign * seen_x, sign * seen_y));
  PlacePsfs psfs{psf_stack(lens, at, {}, context)};
  const double turned = psfs.stack.image_height_mm.front() < 0 ? -sign : sign;
  psfs.e_x = field > 0 ? turned * seen_x / field : 0, psfs.e_y = field > 0 ? turned * seen_y / field : turned;
  return psfs;
}

/// Asks for the PSFs of a place in pixels.
using PsfsOfPlace = std::function<PlacePsfs(double column, double row)>;

PixelPsfs psfs_at_grid(const SensorGeometry& frame, std::size_t bands, int grid_rows, int grid_columns,
                       int size, const PsfsOfPlace& psfs_of) {
  PixelPsfs grid;
  for (int i = 0; i < grid_rows; ++i) grid.rows.push_back((i + 0.5) * frame.rows / grid_rows);
  for (int i = 0; i < grid_columns; ++i) grid.columns.push_back((i + 0.5) * frame.columns / grid_columns);
  const std::size_t pixels = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  grid.values.assign(grid.rows.size() * grid.columns.size() * bands * pixels, 0.0f);
  float* values = grid.values.data();
  for (const double row : grid.rows)
    for (const double column : grid.columns) {
      std::optional<PlacePsfs> psfs;
      try {
        psfs = psfs_of(column, row);
      } catch (const InputError&) {
        values += bands * pixels;  // no light there
        continue;
      }
      const PsfStack& stack = psfs->stack;
      for (std::size_t band = 0; band < bands; ++band, values += pixels)
        add_to_pixels({stack.values.data() + band * stack.psf_cells(), stack.size, stack.spacing_um,
                       psfs->e_x, psfs->e_y, stack.captured[band]},
                      frame.pitch_um, size, values);
    }
  return grid;
}

}  // namespace

PixelPsfs pixel_psfs(const LensDataTable& table, const SensorGeometry& frame,
                     const std::vector<double>& wavelengths_nm, int grid_rows, int grid_columns, int size,
                     const Context& context) {
  const Lens lens = lens_from_json(table.lens_json, "the table's lens");
  LatticeSpline object_x, object_y;  // as FramePlaces has them
  if (table.frame) {
    const FramePlaces& places = *table.frame;
    const std::size_t band = reference_band(table);
    std::vector<double> x, y;
    for (std::size_t place = 0; place < places.count(); ++place) {
      x.push_back(places.object_x[table.index(place, band)]);
      y.push_back(places.object_y[table.index(place, band)]);
    }
    object_x = LatticeSpline(places.x_mm, places.y_mm, std::move(x));
    object_y = LatticeSpline(places.x_mm, places.y_mm, std::move(y));
  }
  const double pitch_mm = frame.pitch_um / 1000;
  const auto psfs_of = [&](double column, double row) {
    const double x_mm = -(column - frame.columns / 2.0) * pitch_mm,
                 y_mm = (row - frame.rows / 2.0) * pitch_mm;
    if (table.frame)
      return psfs_towards(lens, object_x(x_mm, y_mm), object_y(x_mm, y_mm), wavelengths_nm, context);
    const double r = std::hypot(x_mm, y_mm);
    FieldTableRequest at{.wavelengths_nm = wavelengths_nm};
    at.field_kind = Fields::Kind::real_image_height_mm;
    at.fields = {r};
    return PlacePsfs{psf_stack(lens, at, {}, context), r > 0 ? x_mm / r : 0, r > 0 ? y_mm / r : 1};
  };
  return psfs_at_grid(frame, wavelengths_nm.size(), grid_rows, grid_columns, size, psfs_of);
}

PixelPsfs pixel_psfs(const PreparedScene& scene, int grid_rows, int grid_columns, int size,
                     const Context& context) {
  if (!scene.lens) throw InputError("PSFs are those of a lens; a camera with `lens` would be right");
  const std::vector<double>& wavelengths_nm = scene.world->world->groups.wavelengths_nm();
  const ChiefRays camera(scene);
  Lens lens = *scene.lens;
  // The stop stays as wide, wherever the object is.
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, stop_radius_mm(lens)};
  const double unit_mm = scene.request.scene_unit_mm, vertex_to_film_mm = lens.total_track_mm();
  const auto psfs_of = [&](double column, double row) {
    const render::CameraRay ray = camera.trace({{column, row}}).front();
    if (!ray.passes || !(ray.direction.z > 0)) throw InputError("no light");
    const render::Transform from = camera.world_from_camera(row);
    if (const auto point = camera.seen(ray, from)) {
      const render::Vector3 at = from.inverse_point(point->at);
      lens.object_distance_mm = at.z * unit_mm - vertex_to_film_mm;
      return psfs_towards(lens, -at.x * unit_mm, -at.y * unit_mm, wavelengths_nm, context);
    }
    lens.object_distance_mm.reset();
    const double right = ray.direction.x / ray.direction.z, up = ray.direction.y / ray.direction.z,
                 tangent = std::hypot(right, up),
                 scale = tangent > 0 ? degrees(std::atan(tangent)) / tangent : 0;
    return psfs_towards(lens, -right * scale, -up * scale, wavelengths_nm, context);
  };
  return psfs_at_grid(scene.film, wavelengths_nm.size(), grid_rows, grid_columns, size, psfs_of);
}

}  // namespace petzval
