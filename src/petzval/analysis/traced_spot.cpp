// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/traced_spot.h>
#include <petzval/analysis/wave_rays.h>
#include <petzval/base/units.h>

#include <cmath>

namespace petzval {

namespace {

/// As many rays as fill 256 × 256 cells by a dozen each.
constexpr int spot_radial_nodes = 384, azimuths = 1024;

/// Spreads light over the two cells nearest to `at` (in cells from the middle of the first).
template <class Add>
void between_cells(double at, int size, const Add& add) {
  const double below = std::floor(at), share = at - below;
  if (!(below >= -1 && below < size)) return;
  const int first = static_cast<int>(below);
  if (first >= 0) add(first, 1 - share);
  if (first + 1 < size) add(first + 1, share);
}

}  // namespace

std::optional<Psf> traced_spot(const FieldTracer& tracer, const ChiefRay& chief, const PsfGrid& grid) {
  const std::optional<PupilBoundary> pupil = tracer.object_pupil(chief, azimuths);
  if (!pupil) return {};
  const std::vector<PupilNode> nodes = pupil_nodes(*pupil, spot_radial_nodes);
  const std::vector<WaveRay> rays = trace_wave_rays(tracer, chief, *pupil, nodes);
  const auto size = static_cast<std::size_t>(grid.size);
  std::vector<double> cells(size * size, 0.0);
  double all = 0, inside = 0;
  const auto drop = [&](double s_mm, double t_mm, double light) {
    const double per_mm = um_per_mm / grid.spacing_um, middle = grid.size / 2;
    between_cells(t_mm * per_mm + middle, grid.size, [&](int i, double row) {
      between_cells(s_mm * per_mm + middle, grid.size, [&](int j, double column) {
        cells[static_cast<std::size_t>(i) * size + static_cast<std::size_t>(j)] += light * row * column;
        inside += light * row * column;
      });
    });
  };
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (!rays[n].passes) continue;
    const double light = nodes[n].weight * rays[n].transmittance;
    all += light;
    if (pupil->mirrored()) drop(-rays[n].s_mm, rays[n].t_mm, 0.5 * light);
    drop(rays[n].s_mm, rays[n].t_mm, pupil->mirrored() ? 0.5 * light : light);
  }
  if (!(inside > 0)) return {};
  Psf psf;
  psf.size = grid.size;
  psf.spacing_um = grid.spacing_um;
  psf.captured = inside / all;
  for (const double cell : cells) psf.values.push_back(static_cast<float>(cell / inside));
  return psf;
}

}  // namespace petzval
