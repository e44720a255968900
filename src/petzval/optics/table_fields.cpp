// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/optics/frame_build.h>
#include <petzval/optics/table_fields.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace petzval {

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
  static constexpr double slope_step = 1e-4;  ///< of a field

  double last_unfolded(double low, double high) {
    constexpr int halvings = 40;
    for (int i = 0; i < halvings; ++i) {
      const double middle = 0.5 * (low + high);
      (is_unfolded(middle) ? low : high) = middle;
    }
    constexpr double clear_of_fold =
        1 - 10 * slope_step;  // where slopes do not depend on the step that finds them
    return clear_of_fold * low;
  }

  bool is_unfolded(double field) {
    const std::optional<ChiefRay> inner = tracer_.chief_ray(sign_ * (1 - slope_step) * field),
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

}  // namespace

std::vector<double> fields_of_table(const Lens& lens, const TableOptions& options) {
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

}  // namespace petzval
