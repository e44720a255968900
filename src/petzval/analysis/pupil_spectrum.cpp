// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/pupil_blend.h>
#include <petzval/analysis/pupil_spectrum.h>
#include <petzval/analysis/wave_rays.h>
#include <petzval/base/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace petzval {

namespace {

constexpr std::size_t anchors = 8;
/// Shorter lists are fitted one by one.
constexpr std::size_t fewest_wavelengths = 12;
/// Lagrange's polynomial makes an error of its anchors no larger than this.
constexpr double largest_lebesgue = 4;
/// Of phase [waves] and amplitude (relative to the largest), at rays; or so many times the fits' residuals.
constexpr double phase_tolerance_waves = 5e-5, amplitude_tolerance = 5e-4, residuals_tolerated = 5;

/// The rays that are asked at an interpolated wavelength: shares of the rim's radius, and how many azimuths.
constexpr std::array check_radii{0.4, 0.75, 0.97};
constexpr std::size_t check_azimuths = 4;

/// All pupils of a field, by rising wavenumber.
class PupilSpectrum {
 public:
  PupilSpectrum(std::span<const PupilAt> at, const PupilFitLimits& limits)
      : limits_(limits), by_number_(at.size()), fits_(at.size()), tried_(at.size()), result_(at.size()) {
    std::iota(by_number_.begin(), by_number_.end(), std::size_t{0});
    const auto number = [&](std::size_t i) { return 1 / at[i].tracer->tracer().wavelength_nm(); };
    std::stable_sort(by_number_.begin(), by_number_.end(),
                     [&](std::size_t a, std::size_t b) { return number(a) < number(b); });
    for (const std::size_t i : by_number_) at_.push_back(at[i]), x_.push_back(number(i));
    part(0, at_.size());
  }

  std::vector<std::optional<SmoothPupil>> pupils() && {
    std::vector<std::optional<SmoothPupil>> sorted(at_.size());
    for (std::size_t i = 0; i < at_.size(); ++i) {
      std::optional<SmoothPupil>& pupil = sorted[by_number_[i]];
      if (result_[i])
        pupil = std::move(result_[i]);
      else if (fits_[i])
        pupil = std::move(fits_[i]->pupil);
    }
    return sorted;
  }
  std::vector<bool> fitted() const {
    std::vector<bool> fitted(at_.size());
    for (std::size_t i = 0; i < at_.size(); ++i) fitted[by_number_[i]] = tried_[i] != 0;
    return fitted;
  }

 private:
  /// Fits these, where that has not been done.
  void fit(const std::vector<std::size_t>& which) {
    parallel_for(which.size(), [&](std::size_t k) {
      const std::size_t i = which[k];
      if (tried_[i]) return;
      tried_[i] = 1;
      fits_[i] = fit_pupil_and_boundary(*at_[i].tracer, *at_[i].chief, limits_);
    });
  }

  /// Members next to Chebyshev's points; empty where the list is too uneven for them.
  std::vector<std::size_t> choose_anchors(std::size_t first, std::size_t last) const {
    std::vector<std::size_t> chosen;
    for (std::size_t k = 0; k < anchors; ++k) {
      const double place = x_[first] + chebyshev_place(k, anchors) * (x_[last - 1] - x_[first]);
      std::size_t best = first;
      for (std::size_t i = first; i < last; ++i)
        if (std::abs(x_[i] - place) < std::abs(x_[best] - place)) best = i;
      if (!chosen.empty() && !(x_[best] > x_[chosen.back()])) return {};
      chosen.push_back(best);
    }
    return chosen;
  }

  /// The pupils [first, last).
  void part(std::size_t first, std::size_t last) {
    std::vector<std::size_t> all(last - first);
    std::iota(all.begin(), all.end(), first);
    if (all.size() < fewest_wavelengths) return fit(all);
    if (interpolate(all)) return;
    const std::size_t middle = first + all.size() / 2;
    part(first, middle);
    part(middle, last);
  }

  bool interpolate(const std::vector<std::size_t>& all) {
    const std::vector<std::size_t> chosen = choose_anchors(all.front(), all.back() + 1);
    if (chosen.empty()) return false;
    fit(chosen);
    std::vector<double> x;
    std::vector<const FittedPupil*> fitted;
    for (const std::size_t i : chosen) {
      if (!fits_[i]) return false;
      x.push_back(x_[i]);
      fitted.push_back(&*fits_[i]);
    }
    const PupilBlend blend(x, fitted);
    if (!blend.alike() || !outline_follows(blend, all)) return false;
    std::vector<std::size_t> open;
    for (const std::size_t i : all)
      if (!tried_[i]) open.push_back(i);
    std::vector<char> odd(open.size());
    parallel_for(open.size(), [&](std::size_t k) {
      const std::size_t i = open[k];
      SmoothPupil pupil = between(blend, i);
      if (rays_agree(blend, i, pupil))
        result_[i] = std::move(pupil);
      else
        odd[k] = 1;
    });
    std::vector<std::size_t> own;
    for (std::size_t k = 0; k < open.size(); ++k)
      if (odd[k]) own.push_back(open[k]);
    fit(own);
    return true;
  }

  SmoothPupil between(const PupilBlend& blend, std::size_t i) const {
    const Tracer& tracer = at_[i].tracer->tracer();
    return blend.pupil(x_[i], tracer.wavelength_nm(), tracer.image_index());
  }

  /// Whether the outline is the fitted one where the anchors are farthest off, in either half of the list.
  bool outline_follows(const PupilBlend& blend, const std::vector<std::size_t>& all) {
    const double middle = 0.5 * (x_[all.front()] + x_[all.back()]);
    std::array<std::size_t, 2> farthest{all.front(), all.back()};
    std::array<double, 2> most{};
    for (const std::size_t i : all) {
      double lebesgue = 0;
      for (const double weight : blend.weights(x_[i])) lebesgue += std::abs(weight);
      if (lebesgue > largest_lebesgue) return false;
      const std::size_t half = x_[i] < middle ? 0 : 1;
      if (lebesgue > most[half]) most[half] = lebesgue, farthest[half] = i;
    }
    fit({farthest[0], farthest[1]});
    return std::all_of(farthest.begin(), farthest.end(), [&](std::size_t i) {
      return fits_[i] && same_outline(between(blend, i), fits_[i]->pupil);
    });
  }

  bool rays_agree(const PupilBlend& blend, std::size_t i, const SmoothPupil& pupil) const {
    const PupilBoundary& boundary = blend.nearest(x_[i]).boundary;
    std::vector<PupilNode> nodes;
    for (std::size_t k = 0; k < check_azimuths; ++k) {
      const std::size_t own = (2 * k + 1) * boundary.own() / (2 * check_azimuths);
      const auto [u, v] = boundary.rim(own);
      for (const double share : check_radii)
        nodes.push_back({boundary.centre_u + share * (u - boundary.centre_u),
                         boundary.centre_v + share * (v - boundary.centre_v), 0});
    }
    const double phase_off = std::max(phase_tolerance_waves, residuals_tolerated * blend.phase_rms());
    for (const WaveRay& ray : trace_wave_rays(*at_[i].tracer, *at_[i].chief, boundary, nodes)) {
      const double amplitude_off =
          std::max(amplitude_tolerance * ray.amplitude, residuals_tolerated * blend.amplitude_rms());
      if (!(std::abs(pupil.phase_waves(ray.alpha, ray.beta) - ray.phase_waves) < phase_off) ||
          !(std::abs(pupil.amplitude(ray.alpha, ray.beta) - ray.amplitude) < amplitude_off))
        return false;
    }
    return true;
  }

  PupilFitLimits limits_;
  std::vector<std::size_t> by_number_;
  std::vector<PupilAt> at_;
  std::vector<double> x_;  ///< wavenumbers
  std::vector<std::optional<FittedPupil>> fits_;
  std::vector<char> tried_;
  std::vector<std::optional<SmoothPupil>> result_;  ///< of those that were interpolated
};

}  // namespace

std::vector<std::optional<SmoothPupil>> fit_pupils(std::span<const PupilAt> at, const PupilFitLimits& limits,
                                                   std::vector<bool>* fitted) {
  PupilSpectrum spectrum(at, limits);
  if (fitted) *fitted = spectrum.fitted();
  return std::move(spectrum).pupils();
}

}  // namespace petzval
