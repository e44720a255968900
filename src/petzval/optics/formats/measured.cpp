// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/numeric/interpolation.h>
#include <petzval/optics/formats/measured.h>
#include <petzval/optics/formats/measured_mtf.h>
#include <petzval/optics/formats/measured_psf.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// More fields or wavelengths than anybody measures.
constexpr std::size_t longest_measured_axis = 10'000;

std::vector<double> distinct(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

/// The rows of each field and wavelength, in the order of the file.
struct Entries {
  std::vector<double> fields_mm, wavelengths_nm;
  std::vector<std::vector<std::size_t>> rows;  ///< [field][wavelength]

  std::string name(std::size_t entry) const {
    return fmt::format("the measurement at {} mm and {} nm", fields_mm[entry / wavelengths_nm.size()],
                       wavelengths_nm[entry % wavelengths_nm.size()]);
  }
};

Entries entries_of(const NumberColumns& file) {
  const std::vector<double>&fields = file.column("field_mm"), &waves = file.column("wavelength_nm");
  Entries entries{distinct(fields), distinct(waves), {}};
  const std::size_t count = entries.fields_mm.size(), wave_count = entries.wavelengths_nm.size();
  if (count > longest_measured_axis || wave_count > longest_measured_axis ||
      count * wave_count > fields.size())
    file.fail(fmt::format("has {} fields and {} wavelengths in {} rows: every field needs every wavelength",
                          count, wave_count, fields.size()));
  if (entries.fields_mm.front() != 0 || count < 2)
    file.fail("has no field beside field_mm 0, or none there: the axis and at least one more are needed");
  entries.rows.resize(count * wave_count);
  for (std::size_t row = 0; row < fields.size(); ++row) {
    const auto place = [](const std::vector<double>& axis, double value) {
      return static_cast<std::size_t>(std::lower_bound(axis.begin(), axis.end(), value) - axis.begin());
    };
    entries
        .rows[place(entries.fields_mm, fields[row]) * wave_count + place(entries.wavelengths_nm, waves[row])]
        .push_back(row);
  }
  for (std::size_t i = 0; i < entries.rows.size(); ++i)
    if (entries.rows[i].empty())
      file.fail(entries.name(i) + " is missing: every field needs every wavelength");
  return entries;
}

Psf measured_psf(const NumberColumns& file, const std::vector<std::size_t>& rows, bool clip_negative) {
  const std::vector<double>&x = file.column("x_mm"), &y = file.column("y_mm"), &value = file.column("value");
  std::vector<MeasuredSample> samples;
  for (const std::size_t row : rows) samples.push_back({x[row], y[row], value[row]});
  return psf_of_samples(samples, clip_negative);
}

MeasuredMtf measured_mtf(const NumberColumns& file, std::vector<std::size_t> rows) {
  const std::vector<double>& frequency = file.column("frequency_cpmm");
  std::sort(rows.begin(), rows.end(),
            [&](std::size_t a, std::size_t b) { return frequency[a] < frequency[b]; });
  MeasuredMtf mtf;
  for (const std::size_t row : rows) {
    mtf.frequency_cpmm.push_back(frequency[row]);
    mtf.tangential.push_back(file.column("tangential")[row]);
    mtf.sagittal.push_back(file.column("sagittal")[row]);
  }
  return mtf;
}

void take_psfs(const NumberColumns& file, const Entries& entries, const MeasuredOptions& options,
               MeasuredFile& measured) {
  const bool mtfs = file.has("frequency_cpmm");
  // What is missing altogether is missing from no measurement in particular.
  for (const char* column :
       mtfs ? std::vector{"tangential", "sagittal"} : std::vector{"x_mm", "y_mm", "value"})
    file.column(column);
  MtfPsf worst;
  std::string worst_name;
  for (std::size_t i = 0; i < entries.rows.size(); ++i) try {
      if (!mtfs) {
        measured.data.psf.push_back(measured_psf(file, entries.rows[i], options.clip_negative));
        continue;
      }
      MtfPsf made = psf_of_mtf(measured_mtf(file, entries.rows[i]));
      if (made.worst_misfit >= worst.worst_misfit) {
        worst.worst_misfit = made.worst_misfit;
        worst.worst_frequency_cpmm = made.worst_frequency_cpmm;
        worst_name = entries.name(i);
      }
      measured.data.psf.push_back(std::move(made.psf));
    } catch (const InputError& error) {
      file.fail(entries.rows[i].front(), fmt::format("{} {}", entries.name(i), error.what()));
    }
  if (mtfs)
    measured.notes.push_back(
        fmt::format("PSFs are made symmetric from the MTFs and meet them to {:.2g} ({}, at {:g} cycles/mm)",
                    worst.worst_misfit, worst_name, worst.worst_frequency_cpmm));
}

/// A curve over field_mm; the PSFs must not reach beyond it.
MonotoneCubic curve(const NumberColumns& file, const char* column, MonotoneCubic::Start start,
                    double reach_mm) {
  const std::vector<double>& fields = file.column("field_mm");
  if (fields.front() != 0 || fields.back() < reach_mm)
    file.fail(
        fmt::format("covers field_mm {} to {}; 0 to {} is wanted", fields.front(), fields.back(), reach_mm));
  try {
    return {fields, file.column(column), start};
  } catch (const InputError& error) {
    file.fail(fmt::format("column {}: {}", column, error.what()));
  }
}

void take_curves(const Entries& entries, std::string_view text, const std::string& name,
                 MeasuredFile& measured) {
  RayTraceData& data = measured.data;
  const std::size_t waves = entries.wavelengths_nm.size();
  data.field_height_mm = entries.fields_mm;
  std::vector<double> relative(entries.fields_mm.size(), 1.0);
  if (!text.empty()) {
    const NumberColumns file(text, name);
    const double reach = entries.fields_mm.back();
    const bool distortion = file.has("paraxial_height_mm"), illumination = file.has("relative_illumination");
    if (!distortion && !illumination)
      file.fail("has neither a column paraxial_height_mm nor relative_illumination");
    if (distortion) {
      const MonotoneCubic paraxial = curve(file, "paraxial_height_mm", MonotoneCubic::Start::odd, reach);
      for (double& height : data.field_height_mm) height = paraxial(height);
    }
    if (illumination) {
      const MonotoneCubic light = curve(file, "relative_illumination", MonotoneCubic::Start::even, reach);
      for (std::size_t f = 0; f < relative.size(); ++f) relative[f] = light(entries.fields_mm[f]);
    }
  } else {
    measured.notes.push_back(
        "no distortion and even illumination are assumed (`curves` gives a file of them)");
  }
  for (std::size_t f = 0; f < relative.size(); ++f) {
    data.distorted_height_mm.insert(data.distorted_height_mm.end(), waves, entries.fields_mm[f]);
    data.relative_illumination.insert(data.relative_illumination.end(), waves, relative[f]);
  }
}

}  // namespace

MeasuredFile read_measured(std::string_view text, const std::string& file, std::string_view curves,
                           const std::string& curves_file, const MeasuredOptions& options) {
  const NumberColumns columns(text, file);
  const Entries entries = entries_of(columns);
  MeasuredFile measured;
  RayTraceData& data = measured.data;
  data.program = "a measurement";
  data.lens_file = columns.text("name");
  if (data.lens_file.empty()) data.lens_file = "measured lens";
  data.effective_focal_length_mm = columns.number("focal_length_mm").value_or(RayTraceData::unknown);
  if (std::isnan(data.effective_focal_length_mm))
    columns.fail("does not say the focal length: a line \"# focal_length_mm: …\" would be right");
  data.f_number = columns.number("f_number").value_or(RayTraceData::unknown);
  data.object_distance_mm =
      columns.number("object_distance_mm").value_or(std::numeric_limits<double>::infinity());
  data.magnification = columns.number("magnification").value_or(0);
  data.effective_f_number = data.f_number * (1 + std::abs(data.magnification));
  data.wavelengths_nm = entries.wavelengths_nm;
  data.reference_wavelength_nm = columns.number("reference_wavelength_nm")
                                     .value_or(entries.wavelengths_nm[entries.wavelengths_nm.size() / 2]);
  take_curves(entries, curves, curves_file, measured);
  data.field_of_view_deg = RayTraceData::unknown;
  take_psfs(columns, entries, options, measured);
  return measured;
}

}  // namespace petzval
