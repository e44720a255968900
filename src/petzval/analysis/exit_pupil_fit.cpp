// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/exit_pupil_fit.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr int degrees_tried[] = {10, 16, 24, 32, 40};

}  // namespace

std::optional<ExitPupilFit> ExitPupilFit::of(const ExitPupil& pupil, const PupilModel& model,
                                             double sensor_shift_mm) {
  return of(pupil, model, std::vector{sensor_shift_mm}).front();
}

std::vector<std::optional<ExitPupilFit>> ExitPupilFit::of(const ExitPupil& pupil, const PupilModel& model,
                                                          const std::vector<double>& sensor_shifts_mm) {
  std::vector<std::optional<ExitPupilFit>> fits(sensor_shifts_mm.size());
  const std::vector<ExitPupil::Sample> samples = pupil.samples(model, sensor_shifts_mm);
  if (samples.empty()) return fits;
  const double tolerance = pupil.detail().fit_tolerance;
  const bool uniform = model.amplitude == PupilModel::Amplitude::uniform;
  std::vector<double> alpha, beta, amplitude;
  for (const ExitPupil::Sample& sample : samples) {
    alpha.push_back(sample.alpha);
    beta.push_back(sample.beta);
    amplitude.push_back(sample.amplitude);
  }
  std::vector<std::vector<double>> phases(sensor_shifts_mm.size());
  std::vector<double> transverse_mm(sensor_shifts_mm.size());
  for (const ExitPupil::Sample& sample : samples)
    for (std::size_t s = 0; s < sensor_shifts_mm.size(); ++s) {
      const ExitPupil::OnSensor& at = sample.sensors[s];
      phases[s].push_back(at.phase_waves);
      transverse_mm[s] = std::max(transverse_mm[s], std::hypot(at.x_mm, at.y_mm));
    }
  const double brightest = *std::max_element(amplitude.begin(), amplitude.end());
  const auto symmetry =
      pupil.mirrored() ? ChebyshevSurface::Symmetry::even_in_x : ChebyshevSurface::Symmetry::none;
  for (const int degree : degrees_tried) {
    if (samples.size() < 2 * ChebyshevSurface::unknowns(degree, symmetry)) break;
    std::vector<std::span<const double>> values;
    std::vector<std::size_t> open;
    for (std::size_t s = 0; s < fits.size(); ++s)
      if (!fits[s]) values.push_back(phases[s]), open.push_back(s);
    if (open.empty()) break;
    if (!uniform) values.push_back(amplitude);
    std::vector<ChebyshevSurface> surfaces = ChebyshevSurface::fit(alpha, beta, values, degree, symmetry);
    if (surfaces.empty()) break;
    if (!uniform && !(surfaces.back().max_residual() < tolerance * brightest)) continue;
    for (std::size_t i = 0; i < open.size(); ++i) {
      if (!(surfaces[i].max_residual() < tolerance)) continue;
      ExitPupilFit& fit = fits[open[i]].emplace();
      fit.transverse_mm_ = transverse_mm[open[i]];
      fit.phase_ = std::move(surfaces[i]);
      if (!uniform) fit.amplitude_ = surfaces.back();
    }
  }
  return fits;
}

WaveLine ExitPupilFit::at_alpha(double alpha) const {
  WaveLine line{phase_.at_x(alpha)};
  if (amplitude_) line.amplitude = amplitude_->at_x(alpha);
  return line;
}

WaveLine ExitPupilFit::at_beta(double beta) const {
  WaveLine line{phase_.at_y(beta)};
  if (amplitude_) line.amplitude = amplitude_->at_y(beta);
  return line;
}

}  // namespace petzval
