// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/field_values.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/analysis/pupil_fit.h>
#include <petzval/analysis/round_stop.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/base/version.h>
#include <petzval/lens/lens_file.h>
#include <petzval/numeric/interpolation.h>
#include <petzval/optics/build.h>
#include <petzval/optics/frame_build.h>
#include <petzval/optics/table_fields.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <type_traits>
#include <utility>

namespace petzval {

double towards_positive_image(const Lens& lens) {
  return ideal_image_height_mm(lens, 1.0, lens.reference_wavelength_nm) < 0 ? -1.0 : 1.0;
}

PsfOptions psf_options_of(const TableOptions& options) {
  PsfOptions psf;
  psf.size = options.psf_size;
  psf.largest_size = options.largest_psf_size;
  psf.coarse = options.coarse;
  // A table has hundreds of PSFs, and kernels add up many of their samples.
  psf.spot_radial_nodes = 128;
  psf.widest_node_window_lambda_n = 64;
  return psf;
}

namespace {

/// About a pupil, whose area errs by a ten-thousandth with the fewer where apertures meet in corners.
int azimuths_of(const TableOptions& options) {
  constexpr int few = 64;
  return options.coarse.loose() ? few : FieldTracer::default_azimuths;
}

/// FieldTracer::object_flux().
double object_flux(const FieldTracer& tracer, const ChiefRay& chief, int azimuths) {
  const auto pupil = tracer.object_pupil(chief, azimuths);
  return pupil ? tracer.lit_area(Pencil::from_object(tracer.lens(), chief.object_field), *pupil) : 0;
}

/// FieldTracer::g_sensor_sr().
double g_sensor_sr(const FieldTracer& tracer, const ChiefRay& chief, int azimuths) {
  const auto pupil = tracer.image_pupil(chief, azimuths);
  if (!pupil) return 0;
  const double n = tracer.tracer().image_index() / tracer.tracer().object_index();
  return n * n * tracer.lit_area(Pencil::from_image(tracer.tracer(), chief.image_height_mm), *pupil);
}

}  // namespace

TableOptions completed(const Lens& lens, TableOptions options) {
  options.validate();
  if (options.wavelengths_nm.empty()) options.wavelengths_nm = lens.wavelengths_nm;
  std::sort(options.wavelengths_nm.begin(), options.wavelengths_nm.end());
  if (options.max_image_height_mm == 0) {
    FieldTracer tracer(lens, lens.reference_wavelength_nm, options.clip);
    for (const double value : lens.fields.values)
      if (const auto chief = tracer.chief_ray(object_field(lens, lens.fields.kind, value)))
        options.max_image_height_mm = std::max(options.max_image_height_mm, std::abs(chief->image_height_mm));
  }
  return options;
}

void TableOptions::validate() const {
  for (const double wavelength : wavelengths_nm)
    if (!(wavelength > 0) || !std::isfinite(wavelength))
      throw InputError(fmt::format("a wavelength of {:g} nm; it must be positive", wavelength));
  if (!(max_image_height_mm >= 0) || !std::isfinite(max_image_height_mm))
    throw InputError(fmt::format("an image height of {:g} mm; it must be zero or more", max_image_height_mm));
  if (field_count < 2 || field_count > 1000)
    throw InputError(fmt::format("{} fields; a lens data table has 2 to 1000", field_count));
  if (frame_places < 4 || frame_places > 200)
    throw InputError(fmt::format("{} places along the frame; 4 to 200 are right", frame_places));
  if (half_frame_mm && !((*half_frame_mm)[0] > 0 && (*half_frame_mm)[1] > 0 &&
                         std::isfinite((*half_frame_mm)[0] + (*half_frame_mm)[1])))
    throw InputError(fmt::format("half a frame of {:g} × {:g} mm; positive sides are right",
                                 (*half_frame_mm)[0], (*half_frame_mm)[1]));
  if (psf_size != 0 && (psf_size < 8 || psf_size > 4096))
    throw InputError(fmt::format("a PSF of {0} × {0} samples; 8 to 4096 a side, or 0 to choose", psf_size));
}

LensDataTable blank_table(const Lens& lens, const TableOptions& options) {
  LensDataTable table;
  table.lens_name = lens.name;
  table.lens_json = lens_to_json(lens);
  table.provenance =
      fmt::format("petzval {} lens data table from the prescription{}", version(),
                  options.losses.of(lens).any() ? ", losses in the glass and at its surfaces counted" : "");
  table.object_distance_mm = lens.object_distance_mm;
  table.vertex_to_sensor_mm = lens.total_track_mm();
  table.first_order = first_order(lens);
  if (const double radius = stop_radius_mm(lens); std::isfinite(radius)) table.stop_semi_diameter_mm = radius;
  table.wavelengths_nm = options.wavelengths_nm;
  return table;
}

bool needs_places_over_frame(const Lens& lens) {
  return !is_round(lens) || lens.stop_blades().count > 0;
}

HeightTable::HeightTable(const Lens& lens, const TableOptions& options)
    : lens_(lens), options_(completed(lens, options)), sign_(towards_positive_image(lens)) {
  require_centred(lens, "a table by field height holds centred lenses; one over the frame has poses");
  require_round_stop(
      lens,
      "a table by field height turns with the field, which polygons do not; one over the frame "
      "has blades");
  table_ = blank_table(lens, options_);
  table_.fields = fields_of_table(lens, options_);
  rays_.resize(table_.wavelengths_nm.size());
  parallel_for(rays_.size(), [&](std::size_t w) {
    FieldTracer tracer(lens_, table_.wavelengths_nm[w], options_.clip);
    for (const double field : table_.fields) {  // each found from the last
      Ray ray{tracer.chief_ray(sign_ * field)};
      if (ray.chief) ray.object_area = tracer.object_area_per_image_area(*ray.chief);
      rays_[w].push_back(ray);
    }
  });
  const std::size_t entries = table_.fields.size() * table_.wavelengths_nm.size();
  table_.real_image_height_mm.resize(entries);
  table_.g_source_sr.resize(entries);
  table_.g_sensor_sr.resize(entries);
  table_.psf.resize(entries);
}

std::size_t HeightTable::last_rising_field() const {
  // A cell sees at most 2.5 times as much of the scene there as on average, as many parts as that takes.
  constexpr double least_of_mean = 0.4;
  std::size_t last = table_.fields.size() - 1;
  for (const std::vector<Ray>& rays : rays_) {
    const auto height = [](const Ray& ray) { return ray.chief ? std::abs(ray.chief->image_height_mm) : NAN; };
    const double least = least_of_mean * height(rays.back()) / double(rays.size() - 1);
    for (std::size_t f = 1; f <= last; ++f)
      if (!(height(rays[f]) - height(rays[f - 1]) > least)) last = f - 1;
  }
  return last;
}

void HeightTable::add_entry(std::size_t field, std::size_t wavelength) {
  FieldTracer tracer(lens_, table_.wavelengths_nm[wavelength], options_.clip);
  tracer.set_losses(options_.losses);
  const Ray& ray = rays_[wavelength][field];
  const std::optional<ChiefRay>& chief = ray.chief;
  const PsfOptions psf_options = psf_options_of(options_);
  const PupilFitLimits limits = options_.coarse.loose() ? PupilFitLimits::coarse() : PupilFitLimits{};
  const std::optional<SmoothPupil> pupil = chief ? fit_pupil(tracer, *chief, limits) : std::nullopt;
  std::optional<Psf> psf;
  if (pupil) psf = point_spread(*pupil, psf_options);
  if (chief && !psf) psf = point_spread(tracer, *chief, psf_options);
  if (!psf)
    throw InputError(fmt::format("{}: no ray passes at field {:g} and {:g} nm", lens_.name,
                                 sign_ * table_.fields[field], table_.wavelengths_nm[wavelength]));
  const std::size_t entry = table_.index(field, wavelength);
  table_.real_image_height_mm[entry] = std::abs(chief->image_height_mm);
  // The fitted pupil knows its corners and so its flux better than a boundary of azimuths does.
  table_.g_source_sr[entry] = ray.object_area * (pupil ? pupil->flux : tracer.object_flux(*chief));
  table_.g_sensor_sr[entry] = g_sensor_sr(tracer, *chief, azimuths_of(options_));
  table_.psf[entry] = *std::move(psf);
}

void HeightTable::add_entries(std::span<const std::array<std::size_t, 2>> field_and_wavelength,
                              const ProgressCallback& progress) {
  const std::size_t count = field_and_wavelength.size();
  std::atomic<std::size_t> done{0};
  parallel_for(count, [&](std::size_t i) {
    const auto& [field, wavelength] = field_and_wavelength[i];
    add_entry(field, wavelength);
    if (progress) progress(static_cast<double>(++done) / static_cast<double>(count), "lens data table");
  });
}

void HeightTable::add_psfs(std::span<const std::size_t> fields, std::span<const std::size_t> wavelengths,
                           const ProgressCallback& progress) {
  std::vector<std::array<std::size_t, 2>> entries;
  for (const std::size_t wavelength : wavelengths)
    for (const std::size_t field : fields) entries.push_back({field, wavelength});
  add_entries(entries, progress);
}

void HeightTable::add_missing_psfs(std::span<const std::size_t> fields, const ProgressCallback& progress) {
  std::vector<std::array<std::size_t, 2>> entries;
  for (std::size_t wavelength = 0; wavelength < table_.wavelengths_nm.size(); ++wavelength)
    for (const std::size_t field : fields)
      if (!table_.has_psf(table_.index(field, wavelength))) entries.push_back({field, wavelength});
  add_entries(entries, progress);
}

void HeightTable::remove_psf(std::size_t field, std::size_t wavelength) {
  table_.psf[table_.index(field, wavelength)] = {};
}

LensDataTable HeightTable::finished() && {
  const std::size_t fields = table_.fields.size();
  parallel_for(table_.wavelengths_nm.size(), [&](std::size_t w) {
    std::size_t made = 0;
    for (std::size_t f = 0; f < fields; ++f) made += table_.has_psf(table_.index(f, w)) ? 1 : 0;
    if (made == fields) return;
    FieldTracer tracer(lens_, table_.wavelengths_nm[w], options_.clip);
    tracer.set_losses(options_.losses);
    // By the boundary of the pupil, times what a fitted pupil's flux is to that about there; g_sensor in the
    // same way.
    std::vector<double> of_boundary(fields), with_psf, ratio, sensor_ratio;
    for (std::size_t f = 0; f < fields; ++f) {
      const std::size_t entry = table_.index(f, w);
      const Ray& ray = rays_[w][f];
      if (!ray.chief) continue;
      of_boundary[f] = ray.object_area * object_flux(tracer, *ray.chief, azimuths_of(options_));
      if (!table_.has_psf(entry)) {
        table_.real_image_height_mm[entry] = std::abs(ray.chief->image_height_mm);
        continue;
      }
      with_psf.push_back(table_.fields[f]);
      const bool lit = of_boundary[f] > 0;
      ratio.push_back(lit ? table_.g_source_sr[entry] / of_boundary[f] : 1);
      sensor_ratio.push_back(lit ? table_.g_sensor_sr[entry] / of_boundary[f] : 1);
    }
    for (std::size_t f = 0; f < fields; ++f) {
      const std::size_t entry = table_.index(f, w);
      if (table_.has_psf(entry)) continue;
      const std::size_t i = bracket(with_psf, table_.fields[f]);
      const double t = (table_.fields[f] - with_psf[i]) / (with_psf[i + 1] - with_psf[i]);
      table_.g_source_sr[entry] = of_boundary[f] * ((1 - t) * ratio[i] + t * ratio[i + 1]);
      table_.g_sensor_sr[entry] = of_boundary[f] * ((1 - t) * sensor_ratio[i] + t * sensor_ratio[i + 1]);
    }
  });
  table_.validate();
  return std::move(table_);
}

LensDataTable HeightTable::finished(std::span<const std::size_t> fields) && {
  const auto keep = [&](auto& values, std::size_t of_a_field) {
    std::remove_reference_t<decltype(values)> kept;
    for (const std::size_t field : fields)
      for (std::size_t i = 0; i < of_a_field; ++i) kept.push_back(std::move(values[field * of_a_field + i]));
    values = std::move(kept);
  };
  const std::size_t wavelengths = table_.wavelengths_nm.size();
  keep(table_.fields, 1);
  keep(table_.real_image_height_mm, wavelengths);
  keep(table_.g_source_sr, wavelengths);
  keep(table_.g_sensor_sr, wavelengths);
  keep(table_.psf, wavelengths);
  for (std::vector<Ray>& rays : rays_) keep(rays, 1);
  return std::move(*this).finished();
}

LensDataTable build_lens_data_table(const Lens& lens, const TableOptions& asked,
                                    const ProgressCallback& progress) {
  using Places = TableOptions::Places;
  const auto all = [](std::size_t count) {
    std::vector<std::size_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), std::size_t{0});
    return numbers;
  };
  if (asked.places == Places::over_frame ||
      (asked.places == Places::automatic && needs_places_over_frame(lens))) {
    FrameTable parts(lens, asked);
    parts.add_psfs(all(parts.table().places()), all(parts.table().wavelengths_nm.size()), progress);
    return std::move(parts).finished();
  }
  HeightTable parts(lens, asked);
  parts.add_psfs(all(parts.table().fields.size()), all(parts.table().wavelengths_nm.size()), progress);
  return std::move(parts).finished();
}

}  // namespace petzval
