// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/traced_spot.h>
#include <petzval/analysis/wave_rays.h>
#include <petzval/base/units.h>

#include <cmath>

namespace petzval {

namespace {

/// A node's ray on the image surface, in the axes of a PSF.
struct SpotRay {
  double s_mm, t_mm, light;
};

/// Those that reach it. Without losses to be counted a ray needs no path and no neighbours.
std::vector<SpotRay> spot_rays(const FieldTracer& tracer, const ChiefRay& chief, const PupilBoundary& pupil,
                               const std::vector<PupilNode>& nodes) {
  std::vector<SpotRay> spot;
  if (tracer.transmittance()) {
    const std::vector<WaveRay> rays = trace_wave_rays(tracer, chief, pupil, nodes);
    for (std::size_t n = 0; n < nodes.size(); ++n)
      if (rays[n].passes)
        spot.push_back({rays[n].s_mm, rays[n].t_mm, nodes[n].weight * rays[n].transmittance});
    return spot;
  }
  const Pencil pencil = Pencil::from_object(tracer.lens(), chief.object_field);
  const double outwards = chief.image_height_mm < 0 ? -1.0 : 1.0;
  RayBatch rays;
  for (const PupilNode& node : nodes) {
    // As trace_wave_rays() has it where a label has no ray.
    const Ray ray = pencil.ray(node.u, node.v).value_or(Ray{{0, 0, 0}, {1, 0, 0}});
    rays.push_back(ray.point_mm[0], ray.point_mm[1], ray.point_mm[2], ray.direction[0], ray.direction[1],
                   ray.direction[2], ray.opl_mm);
  }
  tracer.tracer().trace(rays, Tracer::Clip::none);
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (rays.status[n] == RayStatus::ok)
      spot.push_back({outwards * (rays.x_mm[n] - chief.image_x_mm),
                      outwards * (rays.y_mm[n] - chief.image_height_mm), nodes[n].weight});
  return spot;
}

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

std::optional<Psf> traced_spot(const FieldTracer& tracer, const ChiefRay& chief, const PsfGrid& grid,
                               int radial_nodes) {
  const int azimuths = (radial_nodes * 8 / 3 + 1) / 2 * 2;
  const std::optional<PupilBoundary> pupil = tracer.object_pupil(chief, azimuths);
  if (!pupil) return {};
  const std::vector<PupilNode> nodes = pupil_nodes(*pupil, radial_nodes);
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
  for (const SpotRay& ray : spot_rays(tracer, chief, *pupil, nodes)) {
    all += ray.light;
    if (pupil->mirrored()) drop(-ray.s_mm, ray.t_mm, 0.5 * ray.light);
    drop(ray.s_mm, ray.t_mm, pupil->mirrored() ? 0.5 * ray.light : ray.light);
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
