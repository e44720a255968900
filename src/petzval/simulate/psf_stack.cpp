// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/fft_point_spread.h>
#include <petzval/analysis/field_rows.h>
#include <petzval/analysis/field_values.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/simulate/psf_stack.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace petzval {

namespace {

using AtPoint = std::function<void(std::size_t at, const FieldTracer& tracer, const ChiefRay& chief)>;

/// \param point  counted over fields, then wavelengths.
[[noreturn]] void refuse(const Lens& lens, const FieldTableRequest& at, std::size_t point) {
  throw InputError(
      fmt::format("{}: no ray passes at field {:g} ({}) and {:g} nm; a smaller field would be right",
                  lens.name, at.fields[point / at.wavelengths_nm.size()], to_string(at.field_kind),
                  at.wavelengths_nm[point % at.wavelengths_nm.size()]));
}

/// Every field and wavelength, by threads.
void for_each_point(const Lens& lens, const FieldTableRequest& at, const AtPoint& work) {
  std::vector<double> object_fields;
  for (const double field : at.fields) object_fields.push_back(object_field(lens, at.field_kind, field));
  const std::size_t wavelengths = at.wavelengths_nm.size();
  parallel_tasks(at.fields.size() * wavelengths, [&](std::size_t i) {
    const double nm = at.wavelengths_nm[i % wavelengths];
    FieldTracer tracer(lens, nm, at.clip, at.azimuth_deg);
    tracer.set_losses(at.losses);
    const std::optional<ChiefRay> chief = tracer.chief_ray(object_fields[i / wavelengths]);
    if (!chief) refuse(lens, at, i);
    work(i, tracer, *chief);
  });
}

/// A grid for all.
PsfOptions common_options(const Lens& lens, const FieldTableRequest& at, const PsfOptions& options) {
  PsfOptions result = options;
  if (options.size > 0 && options.spacing_um > 0) return result;
  std::vector<PsfPlan> plans(at.fields.size() * at.wavelengths_nm.size());
  for_each_point(lens, at, [&](std::size_t i, const FieldTracer& tracer, const ChiefRay& chief) {
    const std::optional<PsfPlan> plan = plan_psf(tracer, chief, options);
    if (!plan) refuse(lens, at, i);
    plans[i] = *plan;
  });
  double finest_um = HUGE_VAL, widest_um = 0;
  for (const PsfPlan& plan : plans) {
    finest_um = std::min(finest_um, plan.spacing_um);
    widest_um = std::max(widest_um, plan.size * plan.spacing_um);
  }
  const int most = options.size > 0 ? options.size : options.largest_size;
  if (!(result.spacing_um > 0)) result.spacing_um = std::max(finest_um, widest_um / most);
  if (result.size <= 0)
    result.size = std::min(most, 2 * static_cast<int>(std::ceil(0.5 * widest_um / result.spacing_um - 1e-9)));
  return result;
}

/// By the plain FFT's model. \throws InputError if the samples of the FFT do not span it.
std::optional<Psf> psf_by_fft(const FieldTracer& tracer, const ChiefRay& chief, const PsfOptions& grid,
                              int pupil_samples) {
  if (const auto plan = plan_psf(tracer, chief, grid); plan && plan->samples_per_cell > 1)
    throw InputError(fmt::format(
        "`method` fft: a PSF is {:.0f} um wide, more than {} samples of the FFT span; a smaller f-number, "
        "`size` or `spacing_um` would be right",
        plan->size * plan->spacing_um, plan->size));
  return fft_point_spread(tracer, chief, {grid.size, grid.spacing_um}, pupil_samples);
}

}  // namespace

PsfStack psf_stack(const Lens& lens, const FieldTableRequest& at, const PsfOptions& options,
                   const Context& context, int fft_pupil_samples) {
  lens.validate();
  const FieldTableRequest asked = with_own_lists(at, lens);
  return result_within(context, [&](const ProgressCallback&) {
    const PsfOptions common = common_options(lens, asked, options);
    const std::size_t count = asked.fields.size() * asked.wavelengths_nm.size();
    PsfStack stack{
        asked.field_kind, asked.fields, asked.wavelengths_nm, common.size, common.spacing_um, {}, {}, {}};
    stack.values.resize(count * stack.psf_cells());
    stack.captured.resize(count), stack.image_height_mm.resize(count);
    for_each_point(lens, asked, [&](std::size_t i, const FieldTracer& tracer, const ChiefRay& chief) {
      const std::optional<Psf> psf = fft_pupil_samples > 0
                                         ? psf_by_fft(tracer, chief, common, fft_pupil_samples)
                                         : point_spread(tracer, chief, common);
      if (!psf) refuse(lens, asked, i);
      std::ranges::copy(psf->values,
                        stack.values.begin() + static_cast<std::ptrdiff_t>(i * stack.psf_cells()));
      stack.captured[i] = psf->captured, stack.image_height_mm[i] = chief.image_height_mm;
    });
    return stack;
  });
}

}  // namespace petzval
