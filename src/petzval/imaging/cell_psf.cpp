// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/imaging/cell_psf.h>
#include <petzval/imaging/psf_refinement.h>
#include <petzval/imaging/smooth_psf.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace petzval {

PsfExtent extent_of(const Psf& psf, double origin_t_um, double origin_s_um) {
  const auto size = static_cast<std::size_t>(psf.size);
  const double middle = double(size / 2), origin = origin_t_um / psf.spacing_um,
               origin_s = origin_s_um / psf.spacing_um;
  double farthest_squared = 0, half_side = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::span<const float> row(psf.values.data() + i * size, size);
    const auto has_light = [](float value) { return value != 0.0F; };
    const auto first = std::find_if(row.begin(), row.end(), has_light);
    if (first == row.end()) continue;
    const auto last = std::find_if(row.rbegin(), row.rend(), has_light);
    const double from = double(first - row.begin()) - middle,
                 to = double(size - 1) - double(last - row.rbegin()) - middle;
    const double s = std::max(std::abs(from - origin_s), std::abs(to - origin_s)),
                 t = std::abs(double(i) - middle - origin);
    farthest_squared = std::max(farthest_squared, t * t + s * s);
    half_side = std::max({half_side, s, t});
  }
  return {std::sqrt(farthest_squared) * psf.spacing_um, half_side * psf.spacing_um};
}

bool has_light(const Psf& psf) {
  if (!(psf.size > 0 && std::isfinite(psf.spacing_um) && psf.spacing_um > 0 &&
        psf.values.size() == static_cast<std::size_t>(psf.size) * static_cast<std::size_t>(psf.size)))
    return false;
  const double sum = std::accumulate(psf.values.begin(), psf.values.end(), 0.0);
  return sum > 0 && std::isfinite(sum);
}

void add_to_reach(const Psf& psf, const PsfExtent& extent, double cell_um, PsfReach& reach) {
  constexpr double max_radius = 2000;  // beyond it a single kernel would take minutes and 128 MB
  const double radius = std::ceil((extent.reach_um + psf.spacing_um) / cell_um) + window_reach;
  if (!(radius <= max_radius))
    throw InputError(
        fmt::format("a PSF reaches {} µm, {} cells of {} µm: at most {} cells are right; a larger "
                    "pitch or less supersampling helps",
                    extent.reach_um, radius, cell_um, max_radius));
  reach.radius = std::max(reach.radius, static_cast<int>(radius));
  reach.least_captured = std::min(reach.least_captured, psf.captured);
}

MergedPsf merged_psf(const Psf& table, double origin_um, double cell_um) {
  // Of samples as fine as a sixteenth of a cell it does not matter what lies between them.
  constexpr double parts_of_cell = 4, fine_parts = 16;
  const Psf psf =
      table.spacing_um * fine_parts > cell_um ? refined_psf(table, cell_um / parts_of_cell) : table;
  const int merged = static_cast<int>(cell_um / parts_of_cell / psf.spacing_um);
  return MergedPsf(psf, origin_um, merged < 3 ? 1 : merged - (merged + 1) % 2, light_moments(psf, origin_um));
}

}  // namespace petzval
