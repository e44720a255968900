// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/optics/lens_data_table.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace petzval {

namespace {

/// The chief ray of the axial field may miss the axis by rounding only [mm].
constexpr double on_axis_mm = 1e-6;
/// Σ of a PSF may differ from 1 by what single precision and its windowing leave.
constexpr double psf_sum_tolerance = 1e-3;

[[noreturn]] void refuse(const std::string& what) {
  throw InputError("lens data table: " + what);
}

void require_axis(const std::vector<double>& axis, const char* name) {
  if (axis.empty()) refuse(fmt::format("there are no {}; at least one is needed", name));
  for (std::size_t i = 0; i < axis.size(); ++i) {
    if (!std::isfinite(axis[i])) refuse(fmt::format("{}[{}] is {}; it must be finite", name, i, axis[i]));
    if (i > 0 && axis[i] <= axis[i - 1])
      refuse(fmt::format("{} must increase, but {} follows {}", name, axis[i], axis[i - 1]));
  }
}

std::string entry_name(const LensDataTable& table, std::size_t entry) {
  const std::size_t wavelengths = table.wavelengths_nm.size();
  return fmt::format("{} at {} nm", table.place_name(entry / wavelengths),
                     table.wavelengths_nm[entry % wavelengths]);
}

void require_count(const LensDataTable& table, const std::vector<double>& values, const char* name) {
  const std::size_t expected = table.places() * table.wavelengths_nm.size();
  if (values.size() != expected)
    refuse(fmt::format("{} has {} values; {} {} × {} wavelengths need {}", name, values.size(),
                       table.places(), table.frame ? "places" : "fields", table.wavelengths_nm.size(),
                       expected));
}

void require_values(const LensDataTable& table, const std::vector<double>& values, const char* name) {
  require_count(table, values, name);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!(std::isfinite(values[i]) && values[i] >= 0))
      refuse(fmt::format("{} of {} is {}; it must be finite and not negative", name, entry_name(table, i),
                         values[i]));
}

/// Of numbers that may have any sign.
void require_finite(const LensDataTable& table, const std::vector<double>& values, const char* name) {
  require_count(table, values, name);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      refuse(fmt::format("{} of {} is {}; it must be finite", name, entry_name(table, i), values[i]));
}

/// Illumination that a lens can give. Light from every direction makes g_sensor π n'², n' the index in front
/// of the sensor: air, unless the aperture of a prescription says that there is something denser. g_source
/// exceeds it where blur spreads the image, which it does at most twice each way (source_from_sensor()).
void require_possible_light(const LensDataTable& table) {
  constexpr double rounding = 1e-6, densest = 4 /* germanium */, widest_spread = 4;
  const double na = table.first_order.image_space_na;
  const bool immersed = !table.lens_json.empty() && na > 1 && na < densest;
  const double most = (1 + rounding) * pi * (immersed ? densest * densest : 1);
  const auto require = [&](const std::vector<double>& values, double limit, const char* name) {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (values[i] > limit)
        refuse(
            fmt::format("{} of {} is {:.4g} sr; the most that a lens in air gives is π, light from the "
                        "whole hemisphere",
                        name, entry_name(table, i), values[i]));
  };
  require(table.g_sensor_sr, most, "g_sensor_sr");
  require(table.g_source_sr, widest_spread * most, "g_source_sr");
}

/// The axis has an image, or there is nothing to be relative to.
void require_light_on_axis(const LensDataTable& table) {
  for (std::size_t w = 0; w < table.wavelengths_nm.size(); ++w)
    if (table.g_source_sr[w] == 0 || table.g_sensor_sr[w] == 0)
      refuse(fmt::format("no light of {} nm reaches the sensor on the axis", table.wavelengths_nm[w]));
}

void require_rising_heights(const LensDataTable& table) {
  for (std::size_t w = 0; w < table.wavelengths_nm.size(); ++w) {
    if (table.real_image_height_mm[w] > on_axis_mm)
      refuse(fmt::format("the image of the axis stands {} mm from the axis at {} nm",
                         table.real_image_height_mm[w], table.wavelengths_nm[w]));
    for (std::size_t f = 1; f < table.fields.size(); ++f)
      if (table.real_image_height_mm[table.index(f, w)] <= table.real_image_height_mm[table.index(f - 1, w)])
        refuse(fmt::format(
            "the image height at {} nm does not rise from field {} to {} {} ({} mm, {} mm); end the "
            "table before",
            table.wavelengths_nm[w], table.fields[f - 1], table.fields[f], table.field_unit(),
            table.real_image_height_mm[table.index(f - 1, w)],
            table.real_image_height_mm[table.index(f, w)]));
  }
}

std::string psf_fault(const Psf& psf) {
  if (psf.size < 1 ||
      psf.values.size() != static_cast<std::size_t>(psf.size) * static_cast<std::size_t>(psf.size))
    return fmt::format("has {} values for size {}", psf.values.size(), psf.size);
  if (!(std::isfinite(psf.spacing_um) && psf.spacing_um > 0))
    return fmt::format("has a sample spacing of {} µm", psf.spacing_um);
  if (!(std::isfinite(psf.captured) && psf.captured > 0))
    return fmt::format("captured a share of {} of the light", psf.captured);
  const double sum = std::accumulate(psf.values.begin(), psf.values.end(), 0.0);
  if (!(std::abs(sum - 1) <= psf_sum_tolerance)) return fmt::format("sums to {}; it must sum to 1", sum);
  for (const float value : psf.values)
    if (!(std::isfinite(value) && value >= 0))
      return fmt::format("has a value of {}; light is finite and not negative", value);
  return {};
}

void require_psfs(const LensDataTable& table) {
  const std::size_t expected = table.places() * table.wavelengths_nm.size();
  if (table.psf.size() != expected)
    refuse(fmt::format("there are {} PSFs; {} {} × {} wavelengths need {}", table.psf.size(), table.places(),
                       table.frame ? "places" : "fields", table.wavelengths_nm.size(), expected));
  // What lies between two fields, or between rows and columns of a lattice, may be left out.
  const std::size_t row = table.wavelengths_nm.size();
  std::vector<PsfLattice> lattices;
  for (std::size_t w = 0; table.frame && w < row; ++w) lattices.push_back(psf_lattice(table, w));
  const auto left_out = [&](std::size_t i) {
    if (table.psf[i].size != 0 || !table.psf[i].values.empty()) return false;
    if (!table.frame) return i >= row && i + row < expected;
    const std::size_t columns = table.frame->x_mm.size(), place = i / row;
    return !lattices[i % row].holds(place % columns, place / columns);
  };
  std::vector<std::string> faults(expected);
  parallel_for(expected, [&](std::size_t i) {
    if (!left_out(i)) faults[i] = psf_fault(table.psf[i]);
  });
  for (std::size_t i = 0; i < expected; ++i)
    if (!faults[i].empty()) refuse(fmt::format("the PSF of {} {}", entry_name(table, i), faults[i]));
}

/// Chief rays keep their order: what the corners of each mesh of the lattice see goes round the same way.
/// Meshes where no light arrives at a corner may be anything.
void require_ordered_frame(const LensDataTable& table) {
  const FramePlaces& frame = *table.frame;
  for (std::size_t w = 0; w < table.wavelengths_nm.size(); ++w)
    for (std::size_t j = 0; j + 1 < frame.y_mm.size(); ++j)
      for (std::size_t i = 0; i + 1 < frame.x_mm.size(); ++i) {
        const std::array<std::size_t, 4> corners{
            table.index(frame.place(i, j), w), table.index(frame.place(i + 1, j), w),
            table.index(frame.place(i + 1, j + 1), w), table.index(frame.place(i, j + 1), w)};
        double area = 0;
        bool lit = true;
        for (std::size_t k = 0; k < 4; ++k) {
          const std::size_t a = corners[k], b = corners[(k + 1) % 4];
          area += (frame.object_x[a] * frame.object_y[b] - frame.object_x[b] * frame.object_y[a]) / 2;
          lit = lit && table.g_source_sr[a] > 0;
        }
        if (lit && !(area > 0))
          refuse(fmt::format(
              "what is seen at {} nm turns over between {} and {}; x' and y' of object and "
              "image must increase together",
              table.wavelengths_nm[w], frame.name(frame.place(i, j)), frame.name(frame.place(i + 1, j + 1))));
      }
}

void require_frame(const LensDataTable& table) {
  const FramePlaces& frame = *table.frame;
  if (!table.fields.empty() || !table.real_image_height_mm.empty())
    refuse("places lie over the frame and at field heights too; one or the other is right");
  require_axis(frame.x_mm, "image_x");
  require_axis(frame.y_mm, "image_y");
  if (frame.x_mm.size() < 2 || frame.y_mm.size() < 2)
    refuse(fmt::format("{} × {} places over the frame; two along each axis or more are right",
                       frame.x_mm.size(), frame.y_mm.size()));
  require_finite(table, frame.object_x, "object_x");
  require_finite(table, frame.object_y, "object_y");
  require_finite(table, frame.psf_azimuth_deg, "psf_azimuth_deg");
}

void require_light_over_frame(const LensDataTable& table) {
  for (std::size_t w = 0; w < table.wavelengths_nm.size(); ++w) {
    bool lit = false;
    for (std::size_t place = 0; place < table.places(); ++place)
      lit = lit || table.g_source_sr[table.index(place, w)] > 0;
    if (!lit) refuse(fmt::format("no light of {} nm reaches the frame", table.wavelengths_nm[w]));
  }
}

}  // namespace

double LensDataTable::field_tangent(double field) const {
  if (finite_object()) return field / *object_distance_mm;
  if (!(std::abs(field) < 90))
    throw InputError(
        fmt::format("a field of {} deg has no tangent: a plane object spans less than ±90 deg", field));
  return std::tan(radians(field));
}

void LensDataTable::validate() const {
  if (object_distance_mm && !(std::isfinite(*object_distance_mm) && *object_distance_mm > 0))
    refuse(fmt::format("the object distance is {} mm; it must be positive", *object_distance_mm));
  if (!std::isfinite(vertex_to_sensor_mm))
    refuse(fmt::format("the sensor stands at {} mm from vertex 1", vertex_to_sensor_mm));
  if (!frame) require_axis(fields, "fields");
  require_axis(wavelengths_nm, "wavelengths");
  if (!frame && fields.front() != 0)
    refuse(fmt::format("the first field is {}; it must be 0, the axis", fields.front()));
  if (wavelengths_nm.front() <= 0) refuse(fmt::format("{} nm is no wavelength", wavelengths_nm.front()));
  if (frame)
    require_frame(*this);
  else
    require_values(*this, real_image_height_mm, "real_image_height_mm");
  require_values(*this, g_source_sr, "g_source_sr");
  require_values(*this, g_sensor_sr, "g_sensor_sr");
  frame ? require_light_over_frame(*this) : require_light_on_axis(*this);
  require_possible_light(*this);
  frame ? require_ordered_frame(*this) : require_rising_heights(*this);
  require_psfs(*this);
}

std::string FramePlaces::name(std::size_t place) const {
  return fmt::format("({:.4g}, {:.4g}) mm", x_mm[place % x_mm.size()], y_mm[place / x_mm.size()]);
}

std::string LensDataTable::place_name(std::size_t place) const {
  return frame ? frame->name(place) : fmt::format("field {}", fields[place]);
}

bool PsfLattice::holds(std::size_t column, std::size_t row) const {
  return std::binary_search(columns.begin(), columns.end(), column) &&
         std::binary_search(rows.begin(), rows.end(), row);
}

PsfLattice psf_lattice(const LensDataTable& table, std::size_t wavelength) {
  const FramePlaces& frame = *table.frame;
  const std::size_t last_column = frame.x_mm.size() - 1, last_row = frame.y_mm.size() - 1;
  PsfLattice lattice;
  for (std::size_t i = 0; i <= last_column; ++i)
    if (i == 0 || i == last_column || table.has_psf(table.index(frame.place(i, 0), wavelength)))
      lattice.columns.push_back(i);
  for (std::size_t j = 0; j <= last_row; ++j)
    if (j == 0 || j == last_row || table.has_psf(table.index(frame.place(0, j), wavelength)))
      lattice.rows.push_back(j);
  return lattice;
}

void require_by_height(const LensDataTable& table, const char* what) {
  if (table.frame)
    throw InputError(
        fmt::format("{}: the places of the table lie over the frame in two dimensions, and {}; "
                    "a table of the centred lens with a round stop would do",
                    table.lens_name, what));
}

}  // namespace petzval
