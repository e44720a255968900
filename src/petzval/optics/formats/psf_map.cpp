// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/base/wavelength.h>
#include <petzval/image/formats/npz.h>
#include <petzval/optics/formats/psf_grid.h>
#include <petzval/optics/formats/psf_map.h>
#include <petzval/optics/formats/ray_trace_checks.h>
#include <petzval/optics/formats/ray_trace_numbers.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>

namespace petzval {

namespace {

/// The arrays of a map, each of the shape that it must have.
class MapArrays {
 public:
  explicit MapArrays(const std::string& path) : path_(path), arrays_(read_npz(path)) {}

  bool has(const char* name) const {
    return std::ranges::any_of(arrays_, [&](const NamedArray& array) { return array.name == name; });
  }
  const std::vector<std::size_t>& shape(const char* name) const {
    return find_array(arrays_, name, path_).shape;
  }
  std::vector<double> values(const char* name) const {
    return double_values(find_array(arrays_, name, path_));
  }
  std::vector<double> values(const char* name, const std::vector<std::size_t>& wanted) const {
    if (shape(name) != wanted)
      fail(name, fmt::format("has the shape ({}); ({}) would be right", fmt::join(shape(name), ", "),
                             fmt::join(wanted, ", ")));
    std::vector<double> numbers = values(name);
    if (!std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); }))
      fail(name, "holds a number that is not finite");
    return numbers;
  }
  double number(const char* name, double otherwise) const { return has(name) ? number(name) : otherwise; }
  double number(const char* name) const {
    const std::vector<double> numbers = values(name, shape(name));
    if (numbers.size() != 1) fail(name, fmt::format("holds {} numbers; one would be right", numbers.size()));
    return numbers.front();
  }
  /// Numbers that increase. \param fewest  of them.
  std::vector<double> axis(const char* name, std::size_t fewest) const {
    const std::vector<double> numbers = values(name, {values(name).size()});
    if (numbers.size() < fewest || !std::ranges::is_sorted(numbers, std::less_equal()))
      fail(name, fmt::format("{} or more numbers that increase would be right", fewest));
    return numbers;
  }
  [[noreturn]] void fail(const char* name, const std::string& why) const {
    throw InputError(path_, fmt::format("array {}: {}", name, why));
  }

 private:
  std::string path_;
  std::vector<NamedArray> arrays_;
};

/// The centre of gravity of a PSF [mm], along x' and y'.
std::array<double, 2> centre_mm(const Psf& psf) {
  double s = 0, t = 0;
  for (int i = 0; i < psf.size; ++i)
    for (int j = 0; j < psf.size; ++j) {
      s += double(psf.at(i, j)) * (j - psf.size / 2);
      t += double(psf.at(i, j)) * (i - psf.size / 2);
    }
  const double spacing_mm = psf.spacing_um * mm_per_um;
  return {s * spacing_mm, t * spacing_mm};
}

/// d/du of a number along one axis of a lattice: central differences, one-sided at both ends.
template <typename At>
double slope(const std::vector<double>& places, std::size_t at, const At& value) {
  const std::size_t before = at == 0 ? 0 : at - 1, after = std::min(at + 1, places.size() - 1);
  return (value(after) - value(before)) / (places[after] - places[before]);
}

/// What g_source must be for a wall to be lit as g_sensor says: the light of a place p is centred on p +
/// c(p), so that g_source(p) = g_sensor(p + c) · det(1 + ∂c/∂p), with g_sensor as its values at p tell to
/// first order.
std::vector<double> source_from_sensor_over_frame(const LensDataTable& table) {
  const FramePlaces& frame = *table.frame;
  const std::size_t columns = frame.x_mm.size(), waves = table.wavelengths_nm.size();
  std::vector<double> source(table.g_sensor_sr.size());
  for (std::size_t i = 0; i < source.size(); ++i) {
    const std::size_t place = i / waves, wave = i % waves, column = place % columns, row = place / columns;
    const auto along_x = [&](const auto& of_entry) {
      return slope(frame.x_mm, column,
                   [&](std::size_t c) { return of_entry((row * columns + c) * waves + wave); });
    };
    const auto along_y = [&](const auto& of_entry) {
      return slope(frame.y_mm, row,
                   [&](std::size_t r) { return of_entry((r * columns + column) * waves + wave); });
    };
    const auto centre_x = [&](std::size_t entry) { return centre_mm(table.psf[entry])[0]; };
    const auto centre_y = [&](std::size_t entry) { return centre_mm(table.psf[entry])[1]; };
    const auto sensor = [&](std::size_t entry) { return table.g_sensor_sr[entry]; };
    const double stretch =
        (1 + along_x(centre_x)) * (1 + along_y(centre_y)) - along_y(centre_x) * along_x(centre_y);
    const double there = sensor(i) + along_x(sensor) * centre_x(i) + along_y(sensor) * centre_y(i);
    // Chief rays of no lens are that much farther apart than its light, or nearer.
    constexpr double most_stretch = 4;
    source[i] = std::max(0.0, there) * std::clamp(stretch, 1 / most_stretch, most_stretch);
  }
  return source;
}

/// What an archive holds, in the order of its arrays: rows of the picture from its top, columns from its
/// left.
struct PsfMap {
  RayTraceData numbers;  ///< without arrays but the wavelengths
  std::vector<double> x_mm, y_mm;
  std::vector<double> paraxial_x_mm, paraxial_y_mm;  ///< [row][column]; empty: where the places are
  std::vector<double> relative_illumination;         ///< [row][column][wavelength]; empty: even
  std::vector<Psf> psf;                              ///< [row][column][wavelength]
};

std::vector<Psf> psfs_of(const MapArrays& map, std::size_t rows, std::size_t columns, std::size_t waves) {
  std::vector<std::size_t> shape = map.shape("psf");
  if (shape.size() == 4 && waves == 1) shape.insert(shape.begin() + 2, 1);
  constexpr std::size_t most_side = 4096;
  if (shape.size() != 5 || shape[0] != rows || shape[1] != columns || shape[2] != waves ||
      std::max(shape[3], shape[4]) > most_side || std::min(shape[3], shape[4]) < 1)
    map.fail("psf",
             fmt::format("has the shape ({}); ({}, {}, {}, height, width) would be right, as y_mm, x_mm "
                         "and wavelengths_nm have it, in windows of up to {} samples a side",
                         fmt::join(map.shape("psf"), ", "), rows, columns, waves, most_side));
  const double spacing_um = map.number("spacing_um");
  if (!(spacing_um > 0))
    map.fail("spacing_um", "a number above 0, from sample to sample [um], would be right");
  const std::vector<double> light = map.values("psf", map.shape("psf"));
  NumberGrid window{static_cast<int>(shape[3]), static_cast<int>(shape[4]), {}};
  // Downwards in the picture is +y', to its left +x'.
  const PsfFrame lie{PsfAway::down, window.rows / 2, window.columns / 2};
  const std::size_t samples = shape[3] * shape[4];
  std::vector<Psf> psfs;
  for (std::size_t i = 0; i < rows * columns * waves; ++i) try {
      const auto first = light.begin() + static_cast<std::ptrdiff_t>(i * samples);
      window.values.assign(first, first + static_cast<std::ptrdiff_t>(samples));
      psfs.push_back(psf_of_grid(window, lie, spacing_um));
    } catch (const InputError& error) {
      map.fail("psf", fmt::format("[{}, {}, {}]: {}", i / waves / columns, i / waves % columns, i % waves,
                                  error.what()));
    }
  return psfs;
}

PsfMap map_of(const MapArrays& arrays) {
  PsfMap map;
  map.x_mm = arrays.axis("x_mm", 2);
  map.y_mm = arrays.axis("y_mm", 2);
  RayTraceData& numbers = map.numbers;
  numbers.program = "a map of PSFs";
  numbers.wavelengths_nm = arrays.axis("wavelengths_nm", 1);
  const std::size_t rows = map.y_mm.size(), columns = map.x_mm.size(), waves = numbers.wavelengths_nm.size();
  numbers.reference_wavelength_nm = numbers.wavelengths_nm[waves / 2];
  numbers.effective_focal_length_mm = arrays.number("focal_length_mm");
  numbers.f_number = arrays.number("f_number", RayTraceData::unknown);
  numbers.object_distance_mm = arrays.number("object_distance_mm", std::numeric_limits<double>::infinity());
  numbers.magnification = arrays.number("magnification", 0);
  numbers.effective_f_number = numbers.f_number * (1 + std::abs(numbers.magnification));
  numbers.field_of_view_deg = RayTraceData::unknown;
  for (const auto& [name, places] :
       {std::pair{"paraxial_x_mm", &map.paraxial_x_mm}, {"paraxial_y_mm", &map.paraxial_y_mm}})
    if (arrays.has(name)) *places = arrays.values(name, {rows, columns});
  if (const char* name = "relative_illumination"; arrays.has(name)) {
    if (arrays.shape(name).size() == 2) {
      for (const double of_place : arrays.values(name, {rows, columns}))
        map.relative_illumination.insert(map.relative_illumination.end(), waves, of_place);
    } else {
      map.relative_illumination = arrays.values(name, {rows, columns, waves});
    }
  }
  map.psf = psfs_of(arrays, rows, columns, waves);
  return map;
}

ImportedTable table_of(const PsfMap& map, const RayTraceReading& reading) {
  ImportedTable imported;
  LensDataTable& table = imported.table;
  const RayTraceData& numbers = map.numbers;
  const bool finite = has_finite_object(numbers, imported.notes);
  const double scale = height_scale(finite, numbers.effective_focal_length_mm, numbers.magnification);
  const double axis = g_axis_sr(numbers, reading, finite, imported.notes);
  table.lens_name = "map of PSFs";
  table.provenance = fmt::format("imported from data of {}", numbers.program);
  if (finite) table.object_distance_mm = numbers.object_distance_mm;
  table.vertex_to_sensor_mm = reading.vertex_to_sensor_mm;
  table.first_order = first_order_of(numbers, finite);
  table.wavelengths_nm = numbers.wavelengths_nm;
  for (const double nm : table.wavelengths_nm) require_wavelength(nm, "the wavelengths");
  FramePlaces& frame = table.frame.emplace();
  std::ranges::transform(map.x_mm.rbegin(), map.x_mm.rend(), std::back_inserter(frame.x_mm), std::negate());
  frame.y_mm = map.y_mm;
  const std::size_t columns = map.x_mm.size(), waves = table.wavelengths_nm.size();
  for (std::size_t place = 0; place < frame.count(); ++place) {
    const std::size_t row = place / columns, column = columns - 1 - place % columns,
                      there = row * columns + column;
    const double x = map.paraxial_x_mm.empty() ? map.x_mm[column] : map.paraxial_x_mm[there],
                 y = map.paraxial_y_mm.empty() ? map.y_mm[row] : map.paraxial_y_mm[there];
    const double height = std::hypot(x, y), field = field_of_height(finite, scale, height);
    for (std::size_t wave = 0; wave < waves; ++wave) {
      frame.object_x.push_back(height > 0 ? -x / height * field : 0);
      frame.object_y.push_back(height > 0 ? y / height * field : 0);
      frame.psf_azimuth_deg.push_back(0);
      const std::size_t entry = there * waves + wave;
      table.psf.push_back(map.psf[entry]);
      table.g_sensor_sr.push_back(axis *
                                  (map.relative_illumination.empty() ? 1 : map.relative_illumination[entry]));
    }
  }
  table.g_source_sr = table.g_sensor_sr;
  table.validate();
  if (!map.relative_illumination.empty() && reading.illumination == RayTraceReading::Illumination::sensor)
    table.g_source_sr = source_from_sensor_over_frame(table);
  if (map.relative_illumination.empty())
    imported.notes.emplace_back("even illumination is assumed (array relative_illumination)");
  if (map.paraxial_x_mm.empty() && map.paraxial_y_mm.empty())
    imported.notes.emplace_back("no distortion is assumed (arrays paraxial_x_mm, paraxial_y_mm)");
  table.validate();
  return imported;
}

}  // namespace

ImportedTable read_psf_map(const std::string& path, const RayTraceReading& reading) {
  const PsfMap map = map_of(MapArrays(path));
  try {
    return table_of(map, reading);
  } catch (const InputError& error) {
    throw InputError(path, error.what());
  }
}

}  // namespace petzval
