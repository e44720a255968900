// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/field_values.h>
#include <petzval/analysis/tv_distortion.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace petzval {

namespace {

/// Heights of the object plane: object heights, or tangents of angles at infinity.
double height_of(const Lens& lens, double object_field) {
  return lens.object_distance_mm ? object_field : std::tan(radians(object_field));
}
double field_of(const Lens& lens, double height) {
  return lens.object_distance_mm ? height : degrees(std::atan(height));
}

/// Where a point of the object plane lands, of a lens with poses.
std::array<double, 2> landing_mm(FieldTracer& tracer, double x, double y) {
  const double away = std::hypot(x, y), per = away > 0 ? field_of(tracer.lens(), away) / away : 0;
  const auto at = tracer.landing_mm(per * x, per * y);
  if (!at)
    throw InputError(fmt::format("{}: no chief ray at {:g} nm reaches the corners of the frame",
                                 tracer.lens().name, tracer.tracer().wavelength_nm()));
  return *at;
}

/// Mean height of the rectangle's sides and its height in the middle, as the picture has them.
std::array<double, 2> heights_of_rectangle_mm(FieldTracer& tracer, double half_width, double half_height) {
  const auto height_at = [&](double x) {
    const auto top = landing_mm(tracer, x, half_height), bottom = landing_mm(tracer, x, -half_height);
    return std::hypot(top[0] - bottom[0], top[1] - bottom[1]);
  };
  return {(height_at(-half_width) + height_at(half_width)) / 2, height_at(0)};
}

double image_height_mm(FieldTracer& tracer, double height) {
  const std::optional<ChiefRay> chief = tracer.chief_ray(field_of(tracer.lens(), height));
  if (!chief)
    throw InputError(fmt::format("{}: no chief ray at {:g} nm reaches the corners of the frame",
                                 tracer.lens().name, tracer.tracer().wavelength_nm()));
  return std::abs(chief->image_height_mm);
}

}  // namespace

double FrameSize::half_diagonal_mm() const {
  return std::hypot(width_mm, height_mm) / 2;
}

std::vector<TvDistortion> tv_distortion(const Lens& lens, const FrameSize& frame,
                                        std::span<const double> wavelengths_nm) {
  if (!(frame.width_mm > 0 && frame.height_mm > 0 && std::isfinite(frame.half_diagonal_mm())))
    throw InputError("a frame has a width and a height above 0");
  const Lens designed = is_round(lens) ? lens : as_designed(lens);
  const double corner =
      height_of(lens, object_field(designed, Fields::Kind::real_image_height_mm, frame.half_diagonal_mm()));
  // The edge of the rectangle lies this far from the middle, seen from the axis.
  const double sine = frame.height_mm / 2 / frame.half_diagonal_mm();
  std::vector<TvDistortion> rows;
  for (const double nm : wavelengths_nm) {
    FieldTracer tracer(lens, nm, Tracer::Clip::stop_only);
    double at_side = 0, in_middle = 0;
    if (tracer.tracer().is_centred()) {
      at_side = image_height_mm(tracer, corner) * sine;
      in_middle = image_height_mm(tracer, corner * sine);
    } else {
      const double cosine = frame.width_mm / 2 / frame.half_diagonal_mm();
      const auto heights = heights_of_rectangle_mm(tracer, corner * cosine, corner * sine);
      at_side = heights[0], in_middle = heights[1];
    }
    const double smia = 100 * (at_side / in_middle - 1);
    rows.push_back({nm, smia, smia / 2});
  }
  return rows;
}

std::optional<FrameSize> frame_of_fields(const Lens& lens) {
  if (lens.fields.values.empty()) return {};
  const double largest =
      *std::ranges::max_element(lens.fields.values, {}, [](double field) { return std::abs(field); });
  FieldTracer tracer(lens, lens.reference_wavelength_nm, Tracer::Clip::stop_only);
  const std::optional<ChiefRay> chief = tracer.chief_ray(object_field(lens, lens.fields.kind, largest));
  if (!chief || !(std::abs(chief->image_height_mm) > 0)) return {};
  constexpr double across = 0.8, down = 0.6;  // 4:3 of a diagonal of 1
  const double diagonal_mm = 2 * std::abs(chief->image_height_mm);
  return FrameSize{across * diagonal_mm, down * diagonal_mm};
}

}  // namespace petzval
