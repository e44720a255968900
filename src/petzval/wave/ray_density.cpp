// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/wave/ray_density.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// Step of the differences that give ∇φ, as a share of the pupil: (1e-4)² of a wave's change.
constexpr double gradient_step = 1e-4;
/// ∮ cos over the sides of a square window of 2λN/(π² r): the Airy pattern's wings outside half-width h are
/// this λN/h.
constexpr double wings_outside_square = 0.1825;

struct Patch {
  double s, t, light;
};

/// Chebyshev series of phase and amplitude along one chord.
struct ChordSeries {
  std::vector<double> phase, amplitude;

  ChordSeries(const SmoothPupil& pupil, double beta)
      : phase(pupil.phase_waves.terms()), amplitude(pupil.amplitude.terms()) {
    pupil.phase_waves.series(beta, phase);
    pupil.amplitude.series(beta, amplitude);
  }
};

/// One row of patches along half a chord; the light is that of the middle of each.
std::vector<Patch> patch_row(const SmoothPupil& pupil, double beta, double d_beta, std::size_t count) {
  const double lambda_mm = pupil.wavelength_nm * mm_per_nm / pupil.image_index;
  const double step = gradient_step * pupil.narrowest(), half = pupil.half_chord(beta);
  const ChordSeries here(pupil, beta), above(pupil, beta + step), below(pupil, beta - step);
  const auto u = [&](double alpha) { return 2 * std::pow(alpha / pupil.phase_waves.x_scale(), 2) - 1; };
  std::vector<Patch> row(count);
  for (std::size_t j = 0; j < count; ++j) {
    const double alpha = half * (static_cast<double>(j) + 0.5) / static_cast<double>(count),
                 middle = u(alpha);
    const double slope_s =
        (chebyshev_sum(here.phase, u(alpha + step)) - chebyshev_sum(here.phase, u(alpha - step))) /
        (2 * step);
    const double slope_t =
        (chebyshev_sum(above.phase, middle) - chebyshev_sum(below.phase, middle)) / (2 * step);
    const double a = chebyshev_sum(here.amplitude, middle);
    row[j] = {-lambda_mm * slope_s, -lambda_mm * slope_t, a * a * d_beta * half / static_cast<double>(count)};
  }
  return row;
}

/// The cells of a grid, filled by boxes of light.
class Cells {
 public:
  explicit Cells(const PsfGrid& grid) : size_(grid.size), spacing_mm_(grid.spacing_um * mm_per_um) {
    light_.resize(static_cast<std::size_t>(size_) * static_cast<std::size_t>(size_), 0.0);
  }

  /// Spreads light over the box of these half-widths.
  void add(double s, double t, double half_s, double half_t, double light) {
    const Run columns = run(s, half_s), rows = run(t, half_t);
    for (int i = rows.first; i <= rows.last; ++i) {
      const double of_row = light * rows.share(i);
      double* cells = light_.data() + static_cast<std::ptrdiff_t>(i) * size_;
      for (int j = columns.first; j <= columns.last; ++j) cells[j] += of_row * columns.share(j);
    }
  }
  const std::vector<double>& light() const { return light_; }

 private:
  struct Run {
    double low, high;  ///< in cells
    int first, last;
    double per_width = 1 / (high - low);
    double share(int cell) const {
      return (std::min(high, cell + 1.0) - std::max(low, static_cast<double>(cell))) * per_width;
    }
  };
  Run run(double middle_mm, double half_mm) const {
    const double at = middle_mm / spacing_mm_ + size_ / 2 + 0.5, half = std::max(half_mm / spacing_mm_, 1e-6);
    const auto clamped = [&](double cell) { return static_cast<int>(std::clamp(cell, -1.0, size_ + 0.0)); };
    Run run{at - half, at + half, clamped(std::floor(at - half)), clamped(std::floor(at + half))};
    run.first = std::max(run.first, 0);
    run.last = std::min(run.last, size_ - 1);
    return run;
  }

  int size_;
  double spacing_mm_;
  std::vector<double> light_;
};

}  // namespace

Psf sum_rays(const SmoothPupil& pupil, const PsfGrid& grid, int patches_per_cell) {
  if (grid.size < 1 || !(grid.spacing_um > 0))
    throw InputError("a PSF needs at least one sample and a positive spacing");
  const auto rows = static_cast<std::size_t>(patches_per_cell * grid.size), columns = rows / 2 + 1;
  const double d_beta = (pupil.beta_high() - pupil.beta_low()) / static_cast<double>(rows);
  std::vector<std::vector<Patch>> patches;
  for (std::size_t i = 0; i < rows; ++i)
    patches.push_back(
        patch_row(pupil, pupil.beta_low() + (static_cast<double>(i) + 0.5) * d_beta, d_beta, columns));

  Cells cells(grid);
  double all = 0;
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j) {
      // Half the parallelogram between the neighbours on all sides.
      const Patch& up = patches[std::min(i + 1, rows - 1)][j];
      const Patch& down = patches[i > 0 ? i - 1 : 0][j];
      const Patch& out = patches[i][std::min(j + 1, columns - 1)];
      const Patch& in = patches[i][j > 0 ? j - 1 : 0];
      const double half_s = 0.25 * (std::abs(up.s - down.s) + std::abs(out.s - in.s));
      const double half_t = 0.25 * (std::abs(up.t - down.t) + std::abs(out.t - in.t));
      const Patch& patch = patches[i][j];
      cells.add(patch.s, patch.t, half_s, half_t, patch.light);
      cells.add(-patch.s, patch.t, half_s, half_t, patch.light);
      all += 2 * patch.light;
    }

  Psf psf;
  psf.size = grid.size;
  psf.spacing_um = grid.spacing_um;
  double inside = 0;
  for (const double light : cells.light()) inside += light;
  for (const double light : cells.light()) psf.values.push_back(static_cast<float>(light / inside));
  psf.captured = inside / all - wings_outside_square * pupil.lambda_n_mm() * um_per_mm / psf.half_width_um();
  return psf;
}

}  // namespace petzval
