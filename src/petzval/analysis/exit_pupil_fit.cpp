// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/exit_pupil_fit.h>
#include <petzval/base/units.h>

#include <algorithm>
#include <cmath>

namespace petzval {

std::optional<ExitPupilFit> ExitPupilFit::of(const ExitPupil& pupil, const PupilModel& model,
                                             double sensor_shift_mm) {
  constexpr int degrees_tried[] = {10, 16, 24};
  const bool uniform = model.amplitude == PupilModel::Amplitude::uniform;
  std::vector<double> alpha, beta, phase, amplitude;
  ExitPupilFit smooth;
  for (const ExitPupil::Sample& sample : pupil.samples(model, sensor_shift_mm)) {
    alpha.push_back(sample.alpha);
    beta.push_back(sample.beta);
    phase.push_back(sample.phase_waves);
    amplitude.push_back(sample.amplitude);
    smooth.transverse_mm_ = std::max(smooth.transverse_mm_, std::hypot(sample.x_mm, sample.y_mm));
  }
  if (alpha.empty()) return {};
  const double brightest = *std::max_element(amplitude.begin(), amplitude.end());
  std::vector<std::span<const double>> values{phase};
  if (!uniform) values.push_back(amplitude);
  const auto symmetry =
      pupil.mirrored() ? ChebyshevSurface::Symmetry::even_in_x : ChebyshevSurface::Symmetry::none;
  for (const int degree : degrees_tried) {
    if (alpha.size() < 2 * ChebyshevSurface::unknowns(degree, symmetry)) return {};
    std::vector<ChebyshevSurface> surfaces = ChebyshevSurface::fit(alpha, beta, values, degree, symmetry);
    if (surfaces.empty()) return {};
    if (!(surfaces[0].max_residual() < tolerance)) continue;
    if (!uniform && !(surfaces[1].max_residual() < tolerance * brightest)) continue;
    smooth.phase_ = std::move(surfaces[0]);
    if (!uniform) smooth.amplitude_ = std::move(surfaces[1]);
    return smooth;
  }
  return {};
}

std::complex<double> ExitPupilFit::wave(double alpha, double beta) const {
  return std::polar(amplitude_ ? std::max((*amplitude_)(alpha, beta), 0.0) : 1.0,
                    2 * pi * phase_(alpha, beta));
}

}  // namespace petzval
