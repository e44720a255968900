// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/fft_point_spread.h>
#include <petzval/analysis/field_rows.h>
#include <petzval/analysis/field_values.h>
#include <petzval/analysis/pupil_spectrum.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/simulate/psf_stack.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace petzval {

namespace {

/// \param point  counted over fields, then wavelengths.
[[noreturn]] void refuse(const Lens& lens, const FieldTableRequest& at, std::size_t point) {
  throw InputError(
      fmt::format("{}: no ray passes at field {:g} ({}) and {:g} nm; a smaller field would be right",
                  lens.name, at.fields[point / at.wavelengths_nm.size()], to_string(at.field_kind),
                  at.wavelengths_nm[point % at.wavelengths_nm.size()]));
}

/// The tracers of the wavelengths and all chief rays.
class Points {
 public:
  Points(const Lens& lens, const FieldTableRequest& at)
      : tracers_(at.wavelengths_nm.size()), chiefs_(at.fields.size() * at.wavelengths_nm.size()) {
    std::vector<double> fields;
    for (const double field : at.fields) fields.push_back(object_field(lens, at.field_kind, field));
    parallel_tasks(tracers_.size(), [&](std::size_t w) {
      tracers_[w] = std::make_unique<FieldTracer>(lens, at.wavelengths_nm[w], at.clip, at.azimuth_deg);
      tracers_[w]->set_losses(at.losses);
      for (std::size_t f = 0; f < fields.size(); ++f)
        chiefs_[f * tracers_.size() + w] = tracers_[w]->chief_ray(fields[f]);
    });
    for (std::size_t i = 0; i < chiefs_.size(); ++i)
      if (!chiefs_[i]) refuse(lens, at, i);
  }

  std::size_t size() const { return chiefs_.size(); }
  const FieldTracer& tracer(std::size_t i) const { return *tracers_[i % tracers_.size()]; }
  const ChiefRay& chief(std::size_t i) const { return *chiefs_[i]; }

  /// The pupils that are smooth, field by field.
  std::vector<std::optional<SmoothPupil>> pupils() const {
    std::vector<std::optional<SmoothPupil>> all(size());
    const std::size_t wavelengths = tracers_.size();
    parallel_tasks(size() / wavelengths, [&](std::size_t f) {
      std::vector<PupilAt> at;
      for (std::size_t i = f * wavelengths; i < (f + 1) * wavelengths; ++i)
        at.push_back({&tracer(i), &chief(i)});
      std::ranges::move(fit_pupils(at), all.begin() + static_cast<std::ptrdiff_t>(f * wavelengths));
    });
    return all;
  }

 private:
  std::vector<std::unique_ptr<FieldTracer>> tracers_;
  std::vector<std::optional<ChiefRay>> chiefs_;
};

/// A grid for all.
PsfOptions common_options(const Lens& lens, const FieldTableRequest& at, const Points& points,
                          const PsfOptions& options) {
  PsfOptions result = options;
  if (options.size > 0 && options.spacing_um > 0) return result;
  std::vector<PsfPlan> plans(points.size());
  parallel_tasks(points.size(), [&](std::size_t i) {
    const std::optional<PsfPlan> plan = plan_psf(points.tracer(i), points.chief(i), options);
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
    const Points points(lens, asked);
    const PsfOptions common = common_options(lens, asked, points, options);
    PsfStack stack{
        asked.field_kind, asked.fields, asked.wavelengths_nm, common.size, common.spacing_um, {}, {}, {}};
    stack.values.resize(points.size() * stack.psf_cells());
    stack.captured.resize(points.size()), stack.image_height_mm.resize(points.size());
    std::vector<std::optional<SmoothPupil>> pupils(points.size());
    if (fft_pupil_samples == 0 && common.radial_nodes == 0 && common.azimuths == 0) pupils = points.pupils();
    parallel_tasks(points.size(), [&](std::size_t i) {
      const FieldTracer& tracer = points.tracer(i);
      const ChiefRay& chief = points.chief(i);
      const std::optional<Psf> psf = fft_pupil_samples > 0
                                         ? psf_by_fft(tracer, chief, common, fft_pupil_samples)
                                     : pupils[i] ? point_spread(*pupils[i], common)
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
