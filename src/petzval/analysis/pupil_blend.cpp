// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/pupil_blend.h>
#include <petzval/base/units.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace petzval {

namespace {

/// Of an outline that is made anew, and at least of each of its smooth pieces.
constexpr double outline_points = 64;
constexpr std::size_t fewest_points_of_piece = 16;
constexpr double outline_tolerance = 2e-5;  ///< of the pupil's half width

/// \param points  of each piece.
Outline outline_of(const SmoothPupil& pupil, const std::vector<std::size_t>& points) {
  std::vector<std::size_t> ends{0};
  ends.insert(ends.end(), pupil.corners.begin(), pupil.corners.end());
  ends.push_back(pupil.outline_beta.size() - 1);
  Outline outline;
  for (std::size_t p = 0; p + 1 < ends.size(); ++p) {
    const double from = pupil.outline_beta[ends[p]], to = pupil.outline_beta[ends[p + 1]];
    if (p > 0) outline.corners.push_back(outline.beta.size());
    for (std::size_t i = 0; i + 1 < points[p]; ++i) {
      const double beta = from + chebyshev_place(i, points[p]) * (to - from);
      const double half = i == 0 ? pupil.outline_alpha[ends[p]] : pupil.half_chord(beta);
      outline.beta.push_back(beta);
      outline.alpha_square.push_back(half * half);
    }
  }
  outline.beta.push_back(pupil.beta_low());
  outline.alpha_square.push_back(0);
  return outline;
}

std::vector<std::size_t> points_of_pieces(const SmoothPupil& pupil) {
  std::vector<double> ends = smooth_intervals(pupil);
  std::vector<std::size_t> points;
  for (std::size_t i = ends.size() - 1; i > 0; --i)
    points.push_back(std::max(
        fewest_points_of_piece,
        static_cast<std::size_t>(outline_points * (ends[i] - ends[i - 1]) / (ends.back() - ends.front()))));
  return points;
}

}  // namespace

double chebyshev_place(std::size_t i, std::size_t count) {
  return 0.5 * (1 - std::cos(pi * static_cast<double>(i) / static_cast<double>(count - 1)));
}

PupilBlend::PupilBlend(std::vector<double> at, std::vector<const FittedPupil*> fitted)
    : at_(std::move(at)), fitted_(std::move(fitted)) {
  for (const FittedPupil* each : fitted_)
    alike_ = alike_ && each->pupil.corners.size() == fitted_[0]->pupil.corners.size();
  if (!alike_) return;
  const std::vector<std::size_t> points = points_of_pieces(fitted_[0]->pupil);
  for (const FittedPupil* each : fitted_) {
    const SmoothPupil& pupil = each->pupil;
    outlines_.push_back(outline_of(pupil, points));
    phase_rms_ = std::max(phase_rms_, pupil.phase_waves.rms_residual());
    amplitude_rms_ = std::max(amplitude_rms_, pupil.amplitude.rms_residual());
  }
  for (const auto member : {&SmoothPupil::phase_waves, &SmoothPupil::amplitude}) {
    std::vector<ChebyshevSurface>& surfaces = member == &SmoothPupil::phase_waves ? phases_ : amplitudes_;
    const auto frame = [&](double x) { return frame_at(member, x); };
    for (std::size_t k = 0; k < at_.size(); ++k)
      surfaces.push_back((fitted_[k]->pupil.*member).in_frame(frame(at_[k])));
  }
}

std::vector<double> PupilBlend::weights(double x) const {
  std::vector<double> weights(at_.size(), 1.0);
  for (std::size_t k = 0; k < at_.size(); ++k)
    for (std::size_t j = 0; j < at_.size(); ++j)
      if (j != k) weights[k] *= (x - at_[j]) / (at_[k] - at_[j]);
  return weights;
}

const FittedPupil& PupilBlend::nearest(double x) const {
  const auto closer = [&](double a, double b) { return std::abs(a - x) < std::abs(b - x); };
  return *fitted_[static_cast<std::size_t>(std::min_element(at_.begin(), at_.end(), closer) - at_.begin())];
}

SmoothPupil PupilBlend::pupil(double x, double wavelength_nm, double image_index) const {
  const std::vector<double> weight = weights(x);
  SmoothPupil pupil;
  pupil.wavelength_nm = wavelength_nm;
  pupil.image_index = image_index;
  pupil.phase_waves = ChebyshevSurface::blend(phases_, weight);
  pupil.amplitude = ChebyshevSurface::blend(amplitudes_, weight);
  pupil.corners = outlines_[0].corners;
  for (std::size_t i = 0; i < outlines_[0].beta.size(); ++i) {
    double beta = 0, square = 0;
    for (std::size_t k = 0; k < at_.size(); ++k) {
      beta += weight[k] * outlines_[k].beta[i];
      square += weight[k] * outlines_[k].alpha_square[i];
    }
    pupil.outline_beta.push_back(beta);
    pupil.outline_alpha.push_back(std::sqrt(std::max(square, 0.0)));
  }
  // The reach of the rays is that of one or another of them, not smooth: between its neighbours.
  const std::size_t above = static_cast<std::size_t>(
      std::clamp(std::upper_bound(at_.begin(), at_.end(), x), at_.begin() + 1, at_.end() - 1) - at_.begin());
  const SmoothPupil &low = fitted_[above - 1]->pupil, &high = fitted_[above]->pupil;
  const double share = (x - at_[above - 1]) / (at_[above] - at_[above - 1]);
  pupil.reach_s_mm = std::lerp(low.reach_s_mm, high.reach_s_mm, share);
  pupil.low_t_mm = std::lerp(low.low_t_mm, high.low_t_mm, share);
  pupil.high_t_mm = std::lerp(low.high_t_mm, high.high_t_mm, share);
  pupil.flux = pupil.amplitude_square_integral();
  return pupil;
}

ChebyshevSurface::Frame PupilBlend::frame_at(ChebyshevSurface SmoothPupil::*surface, double x) const {
  const double count = static_cast<double>(at_.size());
  const double middle = std::accumulate(at_.begin(), at_.end(), 0.0) / count;
  double square = 0;
  for (const double at : at_) square += (at - middle) * (at - middle);
  ChebyshevSurface::Frame line{0, 0, 0};
  for (std::size_t k = 0; k < at_.size(); ++k) {
    const ChebyshevSurface::Frame own = (fitted_[k]->pupil.*surface).frame();
    const double weight = 1 / count + (x - middle) * (at_[k] - middle) / square;
    line.x_scale += weight * own.x_scale;
    line.y_middle += weight * own.y_middle;
    line.y_scale += weight * own.y_scale;
  }
  return line;
}

bool same_outline(const SmoothPupil& one, const SmoothPupil& other) {
  if (one.corners.size() != other.corners.size()) return false;
  const std::vector<std::size_t> points(one.corners.size() + 1, fewest_points_of_piece);
  const Outline a = outline_of(one, points), b = outline_of(other, points);
  const double half = 0.5 * other.widest();
  for (std::size_t i = 0; i < a.beta.size(); ++i)
    if (std::abs(a.beta[i] - b.beta[i]) > outline_tolerance * half ||
        std::abs(a.alpha_square[i] - b.alpha_square[i]) > 2 * outline_tolerance * half * half)
      return false;
  return true;
}

}  // namespace petzval
