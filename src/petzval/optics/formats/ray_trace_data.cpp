// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/numeric/interpolation.h>
#include <petzval/optics/formats/kept_beside.h>
#include <petzval/optics/formats/ray_trace_checks.h>
#include <petzval/optics/formats/ray_trace_data.h>
#include <petzval/optics/formats/ray_trace_numbers.h>
#include <petzval/optics/formats/relative_illumination.h>
#include <petzval/optics/table_layout.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// Two numbers of which one went through a file and a division or two.
constexpr double rounding = 1e-12;

bool agree(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) || a == b ||
         std::abs(a - b) <= rounding * std::max(std::abs(a), std::abs(b));
}

bool agree(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) { return agree(x, y); });
}

/// Paraxial image height of an object field; `scale_mm` is |efl| for fields in degrees, |m| for mm.
double height_of_field(bool finite_object, double scale, double field) {
  return finite_object ? scale * field : scale * std::tan(radians(field));
}

/// A PSF cut down to the size that it had before it was laid into a grid; as it is if there is light outside.
Psf cropped(const Psf& psf, int size) {
  Psf inner{size, psf.spacing_um, {}, psf.captured};
  std::size_t kept = 0;
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j) {
      const int row = i - size / 2 + psf.size / 2, column = j - size / 2 + psf.size / 2;
      const bool inside = row >= 0 && row < psf.size && column >= 0 && column < psf.size;
      inner.values.push_back(inside ? psf.at(row, column) : 0);
      kept += inner.values.back() != 0 ? 1U : 0U;
    }
  const auto all = static_cast<std::size_t>(
      std::count_if(psf.values.begin(), psf.values.end(), [](float value) { return value != 0; }));
  return kept == all ? inner : psf;
}

bool same(const RayTraceData& a, const RayTraceData& b) {
  return agree(a.reference_wavelength_nm, b.reference_wavelength_nm) &&
         agree(a.magnification, b.magnification) && agree(a.f_number, b.f_number) &&
         agree(a.effective_f_number, b.effective_f_number) &&
         agree(a.effective_focal_length_mm, b.effective_focal_length_mm) &&
         agree(a.field_height_mm, b.field_height_mm) && a.wavelengths_nm == b.wavelengths_nm &&
         agree(a.relative_illumination, b.relative_illumination) && a.transmittance == b.transmittance;
}

/// The table that the structure was made from; nothing if somebody has changed the structure since.
std::optional<LensDataTable> table_as_kept(const RayTraceData& data) {
  LensDataTable table = table_of_kept(data.kept);
  if (table.psf.size() != data.psf.size()) return {};
  table.real_image_height_mm = data.distorted_height_mm;
  for (std::size_t i = 0; i < table.psf.size(); ++i) {
    Psf& psf = table.psf[i];
    if (psf.size < 1 || psf.size > data.psf[i].size || !agree(psf.spacing_um, data.psf[i].spacing_um))
      return {};
    const double spacing_um = psf.spacing_um, captured = psf.captured;
    psf = cropped(data.psf[i], psf.size);
    psf.spacing_um = spacing_um;
    psf.captured = captured;
  }
  table.validate();
  if (!same(ray_trace_data(table), data)) return {};
  return table;
}

double tangential_centre_mm(const Psf& psf) {
  double moment = 0;
  for (int i = 0; i < psf.size; ++i)
    for (int j = 0; j < psf.size; ++j) moment += double(psf.at(i, j)) * (i - psf.size / 2);
  return moment * psf.spacing_um * mm_per_um;
}

/// Height of the centre of light over that of the chief ray. From field to field it moves at least half and
/// at most twice as far as the chief ray does; PSFs that say otherwise are no lens's.
MonotoneCubic centres_of_light(const LensDataTable& table, std::size_t wavelength) {
  constexpr double least_stretch = 0.5, most_stretch = 2;
  std::vector<double> chief, centre;
  for (std::size_t f = 0; f < table.fields.size(); ++f) {
    const std::size_t i = table.index(f, wavelength);
    if (f == 0) {
      chief.push_back(0);
      centre.push_back(0);
      continue;
    }
    const double height = table.real_image_height_mm[i], step = height - chief.back();
    const double wanted = height + tangential_centre_mm(table.psf[i]) - centre.back();
    centre.push_back(centre.back() + std::clamp(wanted, least_stretch * step, most_stretch * step));
    chief.push_back(height);
  }
  return {std::move(chief), std::move(centre), MonotoneCubic::Start::odd, MonotoneCubic::Beyond::linear};
}

}  // namespace

std::vector<double> source_from_sensor(const LensDataTable& table) {
  std::vector<double> source(table.g_sensor_sr.size());
  for (std::size_t w = 0; w < table.wavelengths_nm.size(); ++w) {
    std::vector<double> heights, g;
    for (std::size_t f = 0; f < table.fields.size(); ++f) {
      heights.push_back(f == 0 ? 0 : table.real_image_height_mm[table.index(f, w)]);
      g.push_back(table.g_sensor_sr[table.index(f, w)]);
    }
    const MonotoneCubic sensor(heights, g, MonotoneCubic::Start::even);
    const MonotoneCubic centre = centres_of_light(table, w);
    for (std::size_t f = 0; f < table.fields.size(); ++f) {
      const double radial = centre.derivative(heights[f]);
      const double around = heights[f] > 0 ? centre(heights[f]) / heights[f] : radial;
      source[table.index(f, w)] = sensor(centre(heights[f])) * radial * around;
    }
  }
  return source;
}

ImportedTable table_of(const RayTraceData& data, const RayTraceReading& reading) {
  require_whole(data);
  ImportedTable imported;
  if (!data.kept.empty()) {
    if (std::optional<LensDataTable> table = table_as_kept(data)) {
      if (reading.says_something())
        imported.notes.push_back(
            "the file holds the table that Petzval made it of, which is taken as it was: the level of the "
            "light, the kind of the illumination and the length of the lens are in it, and `g_axis_sr`, "
            "`relative_illumination` and `vertex_to_sensor_mm` have no effect");
      return {*std::move(table), std::move(imported.notes)};
    }
    imported.notes.push_back(
        "the file was altered since Petzval wrote it: what Petzval had kept beside it is left aside");
  }
  LensDataTable& table = imported.table;
  const bool finite = has_finite_object(data, imported.notes);
  const double scale = height_scale(finite, data.effective_focal_length_mm, data.magnification);
  table.lens_name = data.lens_file;
  table.provenance =
      fmt::format("imported from data of {}", data.program.empty() ? "an unknown program" : data.program);
  if (finite) table.object_distance_mm = data.object_distance_mm;
  if (!finite && data.effective_focal_length_mm < 0)
    throw InputError(fmt::format(
        "the focal length is {:g} mm: light from infinity comes to a real image where it is positive",
        data.effective_focal_length_mm));
  table.vertex_to_sensor_mm = reading.vertex_to_sensor_mm;
  table.first_order = first_order_of(data, finite);
  for (const double height : data.field_height_mm)
    table.fields.push_back(field_of_height(finite, scale, height));
  table.wavelengths_nm = data.wavelengths_nm;
  table.real_image_height_mm = data.distorted_height_mm;
  table.psf = data.psf;
  const double axis = g_axis_sr(data, reading, finite, imported.notes);
  std::vector<double> relative = data.relative_illumination;
  take_per_cent(relative, data.wavelengths_nm.size(), imported.notes);
  if (reading.illumination == RayTraceReading::Illumination::sensor)
    make_relative_to_axis(relative, data.wavelengths_nm.size(), imported.notes);
  for (std::size_t i = 0; i < relative.size(); ++i) {
    const double passes = data.transmittance.empty() ? 1 : data.transmittance[i % data.wavelengths_nm.size()];
    table.g_sensor_sr.push_back(axis * passes * relative[i]);
  }
  table.g_source_sr = table.g_sensor_sr;
  table.validate();
  if (reading.illumination == RayTraceReading::Illumination::sensor)
    table.g_source_sr = source_from_sensor(table);
  if (finite && reading.vertex_to_sensor_mm == 0)
    imported.notes.push_back(
        fmt::format("the length of the lens is not known: the scene stands {:g} mm from the sensor, as the "
                    "object from the first vertex (`vertex_to_sensor_mm` sets what lies between)",
                    data.object_distance_mm));
  table.validate();
  return imported;
}

RayTraceData ray_trace_data(const LensDataTable& table) {
  table.validate();
  require_by_height(table, "ISET's files hold centred lenses");
  const FirstOrder& first = table.first_order;
  const bool finite = table.finite_object();
  const double scale = height_scale(finite, first.efl_mm, first.magnification);
  for (const Psf& psf : table.psf)
    if (psf.spacing_um != table.psf.front().spacing_um)
      throw InputError(
          fmt::format("the PSFs are sampled at {:g} µm and at {:g} µm, and ISET has one spacing for all; "
                      "`resample` brings them to one",
                      table.psf.front().spacing_um, psf.spacing_um));
  if (!finite && table.fields.back() >= 90)
    throw InputError(fmt::format(
        "the fields go to {:g} degrees; ISET counts them by the paraxial image height, which ends "
        "before 90",
        table.fields.back()));
  RayTraceData data;
  data.program = "Petzval";
  data.lens_file = table.lens_name;
  data.reference_wavelength_nm = first.wavelength_nm;
  data.object_distance_mm = table.object_distance_mm.value_or(std::numeric_limits<double>::infinity());
  data.magnification = finite ? first.magnification : 0;
  data.f_number = first.f_number;
  data.effective_f_number = first.working_f_number;
  data.effective_focal_length_mm = first.efl_mm;
  data.field_of_view_deg =
      finite ? degrees(2 * std::atan(table.field_tangent(table.fields.back()))) : 2 * table.fields.back();
  for (const double field : table.fields)
    data.field_height_mm.push_back(height_of_field(finite, scale, field));
  data.wavelengths_nm = table.wavelengths_nm;
  data.distorted_height_mm = table.real_image_height_mm;
  for (std::size_t f = 0; f < table.fields.size(); ++f)
    for (std::size_t w = 0; w < table.wavelengths_nm.size(); ++w)
      data.relative_illumination.push_back(table.g_sensor_sr[table.index(f, w)] / table.g_sensor_sr[w]);
  data.psf = table.psf;
  data.kept = kept_beside(table);
  return data;
}

}  // namespace petzval
