// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/mtf.h>
#include <petzval/analysis/tv_distortion.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>
#include <petzval/lens/scaled_lens.h>
#include <petzval/simulate/depth_of_field.h>
#include <petzval/simulate/lens_on_sensor.h>
#include <petzval/simulate/mounting.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace petzval {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Middle, half way and corner, at the wavelengths in use.
FieldTableRequest places_of(const Lens& lens, const SensorGeometry& frame,
                            const std::vector<double>& wavelengths_nm) {
  FieldTableRequest at = FieldTableRequest::of(lens);
  at.field_kind = Fields::Kind::real_image_height_mm;
  at.fields = {0, frame.half_diagonal_mm() / 2, frame.half_diagonal_mm()};
  if (!wavelengths_nm.empty()) at.wavelengths_nm = wavelengths_nm;
  return at;
}

/// Of all wavelengths together at one field, both directions alike.
std::vector<double> mtf_through_focus(const Lens& lens, FieldTableRequest at, double frequency_cpmm,
                                      const std::vector<double>& shifts_mm) {
  at.fields = {0};
  MtfOptions options;
  options.frequencies_cpmm = {frequency_cpmm};
  options.weights.assign(at.wavelengths_nm.size(), 1);
  options.sensor_shifts_mm = shifts_mm;
  std::vector<double> values;
  for (const MtfRow& row : mtf_table(lens, at, options))
    values.push_back((row.tangential + row.sagittal) / 2);
  return values;
}

std::optional<DepthOfField> mtf_depth(const Lens& lens, const FirstOrder& first, const FieldTableRequest& at,
                                      double frequency_cpmm) {
  constexpr int steps = 24;
  constexpr double kept = 0.8;
  // An MTF at ν is gone at a defocus of about N/ν.
  const double reach_mm = first.working_f_number / frequency_cpmm;
  std::vector<double> shifts_mm;
  for (int i = -steps; i <= steps; ++i) shifts_mm.push_back(reach_mm * i / steps);
  const std::vector<double> mtf = mtf_through_focus(lens, at, frequency_cpmm, shifts_mm);
  const double least = kept * mtf[steps];
  if (!(least > 0.01)) return {};
  const auto end = [&](int step) {
    for (int i = steps; i + step >= 0 && i + step <= 2 * steps; i += step) {
      const auto here = static_cast<std::size_t>(i), next = static_cast<std::size_t>(i + step);
      if (mtf[next] >= least) continue;
      return std::abs(shifts_mm[here]) + reach_mm / steps * (mtf[here] - least) / (mtf[here] - mtf[next]);
    }
    return reach_mm;
  };
  // A nearer object has its image behind the sensor: it is as if the sensor stood before its own focus.
  return depth_of_field(lens, end(-1), end(1));
}

PlaceOnSensor place_of(const Lens& lens, FieldTableRequest at, double height_mm, double nyquist_cpmm) {
  PlaceOnSensor place;
  place.real_image_height_mm = height_mm;
  at.fields = {height_mm};
  MtfOptions options;
  options.frequencies_cpmm = {nyquist_cpmm / 2, nyquist_cpmm};
  options.weights.assign(at.wavelengths_nm.size(), 1);
  try {
    const std::vector<MtfRow> rows = mtf_table(lens, at, options);
    place.half_nyquist_tangential = rows[0].tangential, place.half_nyquist_sagittal = rows[0].sagittal;
    place.nyquist_tangential = rows[1].tangential, place.nyquist_sagittal = rows[1].sagittal;
    at.wavelengths_nm = {lens.reference_wavelength_nm};
    place.relative_illumination = illumination_table(lens, at).front().relative_illumination;
  } catch (const InputError&) {
    // No ray reaches it: the lens ends before.
  }
  return place;
}

const SensorGeometry& frame_of(const Camera& camera) {
  if (!camera.sensor) throw InputError("`sensor` names the sensor that the lens is to serve");
  return camera.sensor->geometry;
}

Lens focused(const Camera& camera, std::optional<double> distance_m, const FieldTableRequest& places,
             double nyquist_cpmm, const Context& context) {
  Focus wanted = camera.focus;
  if (wanted.kind != Focus::Kind::distance && !wanted.sought())
    wanted = {Focus::Kind::best_mtf, 0, nyquist_cpmm / 2};
  wanted.distance_m = distance_m.value_or(infinite);
  Context silent = context;
  silent.note = {};
  return focus(mounted_lens(camera, context), wanted, places, silent, camera.defocus_mm);
}

/// The places that the lens reaches at all, of which focus is sought.
FieldTableRequest reached(const Camera& camera, std::optional<double> distance_m,
                          const std::vector<double>& wavelengths_nm) {
  const Lens start = focus(mounted_lens(camera, {}), Focus::at_m(distance_m.value_or(infinite)), {}, {});
  FieldTableRequest at = places_of(start, frame_of(camera), wavelengths_nm);
  std::erase_if(at.fields, [&](double height_mm) {
    return std::isnan(place_of(start, at, height_mm, 1).nyquist_tangential);
  });
  return at;
}

/// Of what an afocal lens does not have.
void forget_power(LensOnSensor& lens) {
  lens.efl_mm = lens.f_number = lens.hyperfocal_m = std::numeric_limits<double>::infinity();
}

LensOnSensor judged(const Camera& camera, std::optional<double> distance_m,
                    const std::vector<double>& wavelengths_nm, const Context& context) {
  const SensorGeometry& frame = frame_of(camera);
  LensOnSensor result;
  const double pixel_mm = frame.pitch_um * mm_per_um;
  result.nyquist_cpmm = 1 / (2 * pixel_mm);
  const Lens lens =
      focused(camera, distance_m, reached(camera, distance_m, wavelengths_nm), result.nyquist_cpmm, context);
  const FieldTableRequest at = places_of(lens, frame, wavelengths_nm);
  const FirstOrder first = first_order(lens);
  result.lens = lens.name;
  result.efl_mm = first.efl_mm;
  result.f_number = first.f_number, result.working_f_number = first.working_f_number;
  result.magnification = first.magnification;
  result.view = frame_view(lens, frame);
  result.per_pixel = lens.object_distance_mm ? pixel_mm / std::abs(first.magnification)
                                             : degrees(pixel_mm / std::abs(first.efl_mm));
  const std::optional<FrameSize> fields = frame_of_fields(lens);
  result.image_circle_mm = fields ? 2 * fields->half_diagonal_mm() : 0;
  result.sensor_diagonal_mm = 2 * frame.half_diagonal_mm();
  result.geometric = geometric_depth_of_field(lens, pixel_mm);
  result.by_mtf = mtf_depth(lens, first, at, result.nyquist_cpmm / 2);
  result.hyperfocal_m =
      (first.efl_mm * first.efl_mm / (first.f_number * pixel_mm) + std::abs(first.efl_mm)) / mm_per_m;
  if (is_afocal(first)) forget_power(result);
  for (const double height_mm : at.fields)
    result.places.push_back(place_of(lens, at, height_mm, result.nyquist_cpmm));
  return result;
}

// ---- match

double width_seen_mm(const Lens& lens, const LensMatchRequest& request) {
  MountedLens mounted(lens);
  mounted.focus_at_m(request.distance_m);
  return frame_view(mounted.lens(), request.sensor.geometry).width;
}

/// What makes a lens see the width that was asked for, or nothing.
std::optional<double> fitting_scale(const Lens& lens, const LensMatchRequest& request) {
  constexpr double close = 1e-3, unscaled = 0.05;
  double scale = 1;
  constexpr int rounds = 40;
  for (int round = 0; round < rounds; ++round) {
    const double ratio = width_seen_mm(scaled_lens(lens, scale), request) / request.width_mm;
    if (!request.scaled) return std::abs(ratio - 1) <= unscaled ? std::optional(1.0) : std::nullopt;
    if (!std::isfinite(ratio)) return {};
    if (std::abs(ratio - 1) <= close) return scale;
    scale *= ratio;  // a longer lens sees less
  }
  return {};
}

std::optional<LensOnSensor> matched(const std::string& name, const LensMatchRequest& request,
                                    const Context& context) {
  Camera camera;
  camera.lens = read_lens(name).lens;
  const std::optional<double> scale = fitting_scale(camera.lens, request);
  if (!scale) return {};
  camera.lens = scaled_lens(camera.lens, *scale);
  camera.f_number = request.f_number;
  camera.sensor = request.sensor;
  camera.apertures = Camera::Apertures::from_fields;
  LensOnSensor result = judged(camera, request.distance_m, request.wavelengths_nm, context);
  constexpr double rounding = 0.99;
  if (result.image_circle_mm < rounding * result.sensor_diagonal_mm) return {};
  result.lens = name;
  result.scale = *scale;
  return result;
}

double corner_mtf(const LensOnSensor& lens) {
  const PlaceOnSensor& corner = lens.places.back();
  const double least = std::min(corner.half_nyquist_tangential, corner.half_nyquist_sagittal);
  return std::isfinite(least) ? least : 0;
}

}  // namespace

bool is_afocal(const FirstOrder& data) {
  constexpr double tracks = 1000;
  return !(std::abs(data.efl_mm) < tracks * data.total_track_mm);
}

LensOnSensor lens_on_sensor(const Camera& camera, std::optional<double> distance_m,
                            const std::vector<double>& wavelengths_nm, const Context& context) {
  return result_within(
      context, [&](const ProgressCallback&) { return judged(camera, distance_m, wavelengths_nm, context); });
}

std::vector<LensOnSensor> match_lenses(const LensMatchRequest& request, const Context& context) {
  if (!(request.width_mm > 0 && std::isfinite(request.width_mm)))
    throw InputError(fmt::format("`width_mm` {}: a width above 0 would be right", request.width_mm));
  return result_within(context, [&](const ProgressCallback& progress) {
    std::vector<LensOnSensor> found;
    const std::vector<std::string> names = bundled_names("lenses", ".json");
    for (std::size_t i = 0; i < names.size(); ++i) {
      progress(static_cast<double>(i) / static_cast<double>(names.size()), names[i]);
      try {
        if (std::optional<LensOnSensor> one = matched(names[i], request, context))
          found.push_back(*std::move(one));
      } catch (const InputError&) {
        // This lens cannot do it: it opens less, cannot be focused so near, or its glasses end before the
        // light.
      }
    }
    std::ranges::stable_sort(found, std::greater<>(), corner_mtf);
    return found;
  });
}

}  // namespace petzval
