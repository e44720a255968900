// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/optics/common_grid.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// ∫ of the hat 1 − |u| up to u.
double hat_integral(double u) {
  const double inside = std::clamp(u, -1.0, 1.0);
  return 0.5 + inside - 0.5 * inside * std::abs(inside);
}

/// Shares of the old samples (columns) in the new ones (rows) along one axis. Each point of an old sample
/// goes to the two new ones about it, to each by its nearness: sum and centre of gravity stay.
std::vector<double> shares_of(const Psf& psf, const PsfGridSize& grid) {
  const auto old_size = static_cast<std::size_t>(psf.size), new_size = static_cast<std::size_t>(grid.size);
  const double width = psf.spacing_um / grid.spacing_um;
  std::vector<double> shares(old_size * new_size, 0.0);
  for (int k = 0; k < grid.size; ++k)
    for (int i = 0; i < psf.size; ++i) {
      const double from = (i - psf.size / 2 - 0.5) * width - (k - grid.size / 2);
      shares[static_cast<std::size_t>(k) * old_size + static_cast<std::size_t>(i)] =
          (hat_integral(from + width) - hat_integral(from)) / width;
    }
  return shares;
}

/// Half the width of the square about the chief ray that holds a share of a PSF's light [um].
double half_width_of_light_um(const Psf& psf, double share) {
  std::vector<double> rings(static_cast<std::size_t>(psf.size) + 1, 0.0);
  double all = 0;
  for (int i = 0; i < psf.size; ++i)
    for (int j = 0; j < psf.size; ++j) {
      const int ring = std::max(std::abs(i - psf.size / 2), std::abs(j - psf.size / 2));
      rings[static_cast<std::size_t>(ring)] += double{psf.at(i, j)};
      all += double{psf.at(i, j)};
    }
  std::size_t ring = 0;
  for (double inside = rings[0]; inside < share * all && ring + 1 < rings.size(); inside += rings[ring])
    ++ring;
  return (static_cast<double>(ring) + 0.5) * psf.spacing_um;
}

/// At least `value`, with three digits: ISET reads no more than nine characters of a spacing.
double rounded_up(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2);
  return std::stod(fmt::format("{:.3g}", std::ceil(value / unit * (1 - 1e-12)) * unit));
}

}  // namespace

PsfGridSize common_grid(const LensDataTable& table, int most_samples) {
  double finest = INFINITY, widest = 0;
  for (const Psf& psf : table.psf) {
    finest = std::min(finest, psf.spacing_um);
    widest = std::max(widest, psf.half_width_um());
  }
  const double spacing = rounded_up(std::max(finest, 2 * widest / (most_samples - 6)));
  // Light goes up to one sample farther, and an even window reaches half a sample farther on one side.
  const int size = 2 * static_cast<int>(std::ceil(widest / spacing - 1e-9)) + 4;
  return {std::min(size, most_samples), spacing};
}

int size_for_light(const LensDataTable& table, double spacing_um, double share) {
  double widest = 0;
  for (const Psf& psf : table.psf) widest = std::max(widest, half_width_of_light_um(psf, share));
  // Light goes up to one sample farther, and an even window ends one sample earlier on one side.
  return 2 * static_cast<int>(std::ceil(widest / spacing_um + 1)) + 2;
}

Psf resampled(const Psf& psf, const PsfGridSize& grid) {
  if (psf.size == grid.size && psf.spacing_um == grid.spacing_um) return psf;
  const auto old_size = static_cast<std::size_t>(psf.size), new_size = static_cast<std::size_t>(grid.size);
  const std::vector<double> shares = shares_of(psf, grid);
  std::vector<double> half(new_size * old_size, 0.0), values(new_size * new_size, 0.0);
  for (std::size_t k = 0; k < new_size; ++k)
    for (std::size_t i = 0; i < old_size; ++i)
      if (const double share = shares[k * old_size + i]; share > 0)
        for (std::size_t j = 0; j < old_size; ++j)
          half[k * old_size + j] += share * double(psf.values[i * old_size + j]);
  double sum = 0;
  for (std::size_t k = 0; k < new_size; ++k)
    for (std::size_t l = 0; l < new_size; ++l) {
      double value = 0;
      for (std::size_t j = 0; j < old_size; ++j) value += shares[l * old_size + j] * half[k * old_size + j];
      values[k * new_size + l] = value;
      sum += value;
    }
  if (!(sum > 0)) throw InputError("a PSF has no light within the new grid; give it more samples");
  Psf result{grid.size, grid.spacing_um, {}, psf.captured * std::min(sum, 1.0)};
  for (const double value : values) result.values.push_back(static_cast<float>(value / sum));
  return result;
}

LensDataTable on_common_grid(const LensDataTable& table, const PsfGridSize& grid) {
  if (grid.size < 1 || !(std::isfinite(grid.spacing_um) && grid.spacing_um > 0))
    throw InputError(fmt::format("PSFs of {0} x {0} samples of {1} µm cannot be: both must be positive",
                                 grid.size, grid.spacing_um));
  LensDataTable result = table;
  parallel_for(table.psf.size(), [&](std::size_t i) { result.psf[i] = resampled(table.psf[i], grid); });
  return result;
}

}  // namespace petzval
