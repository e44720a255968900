// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/best_focus.h>
#include <petzval/analysis/field_rows.h>
#include <petzval/analysis/mtf.h>
#include <petzval/analysis/spot_moments.h>
#include <petzval/base/units.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

std::optional<SpotMoments> stop_moments(const FieldTracer& tracer, const ChiefRay& chief) {
  const std::vector<PupilRay> rays = pupil_rays(tracer, chief);
  if (rays.empty()) return {};
  return spot_moments(rays, chief, RayWeight::stop_area);
}

std::vector<double> shares(const std::vector<double>& weights, std::size_t wavelengths) {
  if (weights.empty()) return std::vector<double>(wavelengths, 1.0 / static_cast<double>(wavelengths));
  if (weights.size() != wavelengths)
    throw InputError(
        fmt::format("{} weights for {} wavelengths; give one a wavelength", weights.size(), wavelengths));
  double sum = 0;
  for (const double weight : weights) {
    if (!(weight >= 0) || !std::isfinite(weight))
      throw InputError(fmt::format("a weight of {:g}; weights must be 0 or more", weight));
    sum += weight;
  }
  if (!(sum > 0)) throw InputError("all weights are zero; at least one wavelength must count");
  std::vector<double> result;
  for (const double weight : weights) result.push_back(weight / sum);
  return result;
}

/// Mean of the MTF over fields and directions for each shift.
std::vector<double> mean_mtf(const Lens& lens, const FieldTableRequest& request, double frequency_cpmm,
                             const std::vector<double>& weights, const std::vector<double>& shifts_mm) {
  MtfOptions options;
  options.frequencies_cpmm = {frequency_cpmm};
  options.weights = weights;
  options.sensor_shifts_mm = shifts_mm;
  std::vector<double> sums(shifts_mm.size(), 0.0);
  const std::vector<MtfRow> rows = mtf_table(lens, request, options);
  const std::size_t per_shift = rows.size() / shifts_mm.size();
  for (std::size_t i = 0; i < rows.size(); ++i)
    sums[i / per_shift] += 0.5 * (rows[i].tangential + rows[i].sagittal) / static_cast<double>(per_shift);
  return sums;
}

}  // namespace

BestFocus best_spot_focus(const Lens& lens, const FieldTableRequest& request,
                          const std::vector<double>& weights) {
  const std::size_t wavelengths = request.wavelengths_nm.size();
  const std::vector<double> share = shares(weights, wavelengths);
  const std::vector<SpotMoments> rows = field_rows<SpotMoments>(
      lens, request,
      [](const FieldTracer& tracer, const ChiefRay& chief) { return stop_moments(tracer, chief); });
  std::vector<SpotMoments> fields;
  for (std::size_t first = 0; first < rows.size(); first += wavelengths)
    fields.push_back(mixed(std::span(rows).subspan(first, wavelengths), share));
  BestFocus best;
  best.shift_mm = best_shift_mm(fields);
  const auto radius_um = [&](double shift_mm) {
    double sum = 0;
    for (const SpotMoments& field : fields) sum += field.variance(shift_mm);
    return std::sqrt(sum / static_cast<double>(fields.size())) * um_per_mm;
  };
  best.before = radius_um(0);
  best.after = radius_um(best.shift_mm);
  return best;
}

BestFocus best_mtf_focus(const Lens& lens, const FieldTableRequest& request, double frequency_cpmm,
                         const std::vector<double>& weights) {
  if (!(frequency_cpmm > 0) || !std::isfinite(frequency_cpmm))
    throw InputError(
        fmt::format("best focus at {:g} cycles/mm; a positive frequency would be right", frequency_cpmm));
  const std::vector<double> share = shares(weights, request.wavelengths_nm.size());
  const BestFocus spot = best_spot_focus(lens, request, weights);
  // A disc of defocus as wide as one period has lost the pattern: with the slopes' spread about the f-number
  // that is a sensor shift of a period over the full cone, and the spot itself adds its own depth.
  FieldTracer tracer(lens, lens.reference_wavelength_nm, request.clip, request.azimuth_deg);
  const std::optional<ChiefRay> axis = tracer.chief_ray(0);
  const double solid_angle = axis ? exit_solid_angle_sr(tracer, pupil_rays(tracer, *axis)) : 0;
  if (!(solid_angle > 0)) throw no_ray_passes(lens, 0, lens.reference_wavelength_nm);
  const double cone = 2 * std::sqrt(solid_angle / pi);
  const double depth_mm = (1 / frequency_cpmm + 4 * spot.after * mm_per_um) / cone;

  constexpr int scan = 12;
  std::vector<double> shifts{0};
  for (int i = -scan; i <= scan; ++i) shifts.push_back(spot.shift_mm + depth_mm * i / scan);
  std::vector<double> merit = mean_mtf(lens, request, frequency_cpmm, share, shifts);
  BestFocus best;
  best.before = merit[0];
  std::size_t top = 1;
  for (std::size_t i = 1; i < merit.size(); ++i)
    if (merit[i] > merit[top]) top = i;
  double at = shifts[top], value = merit[top], step = depth_mm / scan;
  // Parabolas through three points: near a smooth top each shrinks the step tenfold.
  constexpr double fine = 1e-4;
  while (step > fine * depth_mm) {
    const std::vector<double> sides =
        mean_mtf(lens, request, frequency_cpmm, share, {at - step, at, at + step});
    const double bend = sides[0] - 2 * sides[1] + sides[2];
    const double move = bend < 0 ? 0.5 * step * (sides[0] - sides[2]) / bend : 0;
    at += std::clamp(move, -step, step);
    value = sides[1];
    step *= std::abs(move) < step ? 0.1 : 1;
    if (!(bend < 0)) break;
  }
  best.shift_mm = at;
  best.after = std::max(value, mean_mtf(lens, request, frequency_cpmm, share, {at})[0]);
  return best;
}

}  // namespace petzval
