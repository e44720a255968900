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

/// How far from the chief ray the PSF window of a field reaches [mm], to its corner; nothing where no ray
/// passes.
std::optional<double> psf_reach_mm(FieldTracer& tracer, double object_field, const PsfOptions& options) {
  const std::optional<ChiefRay> chief = tracer.chief_ray(object_field);
  const std::optional<PsfPlan> plan = chief ? plan_psf(tracer, *chief, options) : std::nullopt;
  if (!plan) return {};
  return std::numbers::sqrt2 * 0.5 * plan->size * plan->spacing_um * mm_per_um;
}

constexpr int limit_azimuths = 32;

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

/// Objects at a finite distance are looked for no farther out than this (87°).
constexpr double widest_tangent = 20;

/// One field outwards: the height it lands at, or nothing when no ray passes or the image turned back
/// inwards.
class FieldLimit {
 public:
  FieldLimit(const Lens& lens, double wavelength_nm, Tracer::Clip clip)
      : tracer_(lens, wavelength_nm, clip), sign_(towards_positive_image(lens)) {
    if (const std::optional<ChiefRay> axis = tracer_.chief_ray(0))
      if (const auto pupil = tracer_.object_pupil(*axis, limit_azimuths))
        least_area_ = dark_pupil_share * pupil->area();
  }

  std::optional<double> height(double field) {
    const double end =
        tracer_.lens().object_distance_mm ? widest_tangent * *tracer_.lens().object_distance_mm : 179.0;
    if (field > end) return {};
    const std::optional<ChiefRay> chief = tracer_.chief_ray(sign_ * field);
    const auto pupil = chief ? tracer_.object_pupil(*chief, limit_azimuths) : std::nullopt;
    if (!pupil || !(pupil->area() > least_area_)) return {};
    return chief->image_height_mm;
  }

  /// The last field, up to one that passes, before the image folds back: before it moves inwards, or outwards
  /// so little that the chief rays of a wall would bring more light than all directions can give.
  double unfolded(double field) {
    constexpr int steps = 30;
    constexpr double suspicious_share = 0.25;  // of a mean step
    double low = 0, before_mm = 0;             // before the last step, which may have been beyond the fold
    for (int i = 1; i <= steps; ++i) {
      const double here = field * i / steps;
      const std::optional<ChiefRay> chief = tracer_.chief_ray(sign_ * here);
      const double height_mm = chief ? chief->image_height_mm : 0, step_mm = height_mm - before_mm;
      const bool fast = step_mm > suspicious_share * height_mm / i;
      if (!fast && !(step_mm > 0 && is_unfolded(here))) return last_unfolded(low, here);
      low = field * (i - 1) / steps;
      before_mm = height_mm;
    }
    return is_unfolded(field) ? field : last_unfolded(low, field);
  }

  /// The field at which the image height reaches `wanted_mm`, or the last one that passes.
  double last_field(double wanted_mm, double stride) {
    double low = 0, low_height = 0;
    while (true) {
      const double next = low + stride;
      const std::optional<double> reached = height(next);
      if (reached && *reached > low_height && *reached < wanted_mm) {
        low = next;
        low_height = *reached;
        continue;
      }
      return refine(low, low_height, next, wanted_mm);
    }
  }

 private:
  double last_unfolded(double low, double high) {
    constexpr int halvings = 40;
    for (int i = 0; i < halvings; ++i) {
      const double middle = 0.5 * (low + high);
      (is_unfolded(middle) ? low : high) = middle;
    }
    constexpr double clear_of_fold = 1 - 1e-3;  // where slopes do not depend on the step that finds them
    return clear_of_fold * low;
  }

  bool is_unfolded(double field) {
    constexpr double nearer = 1 - 1e-4;
    const std::optional<ChiefRay> inner = tracer_.chief_ray(sign_ * nearer * field),
                                  chief = tracer_.chief_ray(sign_ * field);
    if (!inner || !chief || !(chief->image_height_mm > inner->image_height_mm)) return false;
    const double n = tracer_.tracer().image_index();
    return tracer_.g_source_sr(*chief) <= pi * n * n;
  }

  /// Where the chief ray alone reaches the height, between two fields on either side of it (false position,
  /// Illinois).
  std::optional<double> crossing(double low, double low_height, double high, double high_height,
                                 double wanted_mm) {
    constexpr double tolerance = 1e-13;
    constexpr int most_rounds = 60;
    double below = low_height - wanted_mm, above = high_height - wanted_mm;
    int last_side = 0;
    for (int round = 0; round < most_rounds && high - low > tolerance * high; ++round) {
      double middle = (low * above - high * below) / (above - below);
      if (!(middle > low && middle < high)) middle = 0.5 * (low + high);
      if (middle == low || middle == high) break;
      const std::optional<ChiefRay> chief = tracer_.chief_ray(sign_ * middle);
      if (!chief) return {};
      const double beyond = chief->image_height_mm - wanted_mm;
      const int side = beyond < 0 ? -1 : 1;
      (side < 0 ? low : high) = middle;
      (side < 0 ? below : above) = beyond;
      if (side == last_side) (side < 0 ? above : below) *= 0.5;
      last_side = side;
    }
    return high;
  }

  double refine(double low, double low_height, double high, double wanted_mm) {
    if (const std::optional<double> reached = height(high); reached && *reached >= wanted_mm) {
      const std::optional<double> field = crossing(low, low_height, high, *reached, wanted_mm);
      if (field && height(*field)) return *field;
    }
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (low + high);
      const std::optional<double> reached = height(middle);
      const bool passes = reached && *reached > low_height;
      if (passes && *reached < wanted_mm) {
        low = middle;
        low_height = *reached;
      } else {
        high = middle;
      }
    }
    // Reached: the outer end, which passes; else the last field that did.
    const std::optional<double> outer = height(high);
    return outer && *outer >= wanted_mm ? high : low;
  }

  FieldTracer tracer_;
  double sign_;
  double least_area_ = 0;
};

/// The field whose image lies a PSF's reach beyond the asked height, or the last one that passes.
double outermost_field(const Lens& lens, const TableOptions& options, double wavelength_nm, double stride) {
  FieldTracer tracer(lens, wavelength_nm, options.clip);
  const PsfOptions psf = psf_options_of(options);
  const std::optional<double> on_axis = psf_reach_mm(tracer, 0, psf);
  if (!on_axis)
    throw InputError(
        fmt::format("{}: no ray passes the stop on the axis at {:g} nm; check stop and clear apertures",
                    lens.name, wavelength_nm));
  FieldLimit limit(lens, wavelength_nm, options.clip);
  const double field = limit.last_field(options.max_image_height_mm + *on_axis, stride);
  const std::optional<double> outside = psf_reach_mm(tracer, towards_positive_image(lens) * field, psf);
  if (!outside || *outside <= *on_axis) return field;
  return limit.last_field(options.max_image_height_mm + *outside, stride);
}

std::vector<double> choose_fields(const Lens& lens, const TableOptions& options) {
  const double stride = lens.object_distance_mm ? *lens.object_distance_mm / 50 : 1.0;
  // The fields belong to all wavelengths: far enough for each (the ends of the spectrum decide), but no
  // farther than each can pass.
  const std::vector<double>& nm = options.wavelengths_nm;
  std::array<double, 2> ends{};
  parallel_for(ends.size(), [&](std::size_t end) {
    ends[end] = outermost_field(lens, options, end == 0 ? nm.front() : nm.back(), stride);
  });
  const double wanted = std::max(ends[0], ends[1]);
  std::vector<double> last_of(nm.size(), wanted);
  parallel_for(nm.size(), [&](std::size_t w) {
    FieldLimit limit(lens, nm[w], options.clip);
    if (!limit.height(wanted))
      last_of[w] = std::min(wanted, limit.last_field(std::numeric_limits<double>::infinity(), stride));
    last_of[w] = limit.unfolded(last_of[w]);
  });
  const double last = *std::ranges::min_element(last_of);
  if (!(last > 0)) throw InputError(fmt::format("{}: no ray passes beside the axis", lens.name));
  std::vector<double> fields;
  for (int i = 0; i < options.field_count; ++i) fields.push_back(last * i / (options.field_count - 1));
  return fields;
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
  table_.fields = choose_fields(lens, options_);
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

bool HeightTable::hardly_rises() const {
  constexpr double least_of_mean = 0.1;
  return std::ranges::any_of(rays_, [](const std::vector<Ray>& rays) {
    const auto height = [](const Ray& ray) { return ray.chief ? std::abs(ray.chief->image_height_mm) : NAN; };
    const double least = least_of_mean * height(rays.back()) / double(rays.size() - 1);
    for (std::size_t f = 1; f < rays.size(); ++f)
      if (!(height(rays[f]) - height(rays[f - 1]) > least)) return true;
    return false;
  });
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
