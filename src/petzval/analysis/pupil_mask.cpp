// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/pupil_mask.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <span>

namespace petzval {

namespace {

constexpr int mask_azimuths = 64, mask_radii = 12, mask_degree = 8;

std::vector<ApertureFigure> closed_figures(const Tracer::PreparedSurface& surface) {
  std::vector<ApertureFigure> closed;
  std::copy_if(surface.apertures.begin(), surface.apertures.end(), std::back_inserter(closed),
               [](const ApertureFigure& figure) { return figure.obscures; });
  return closed;
}

}  // namespace

bool is_obscured(const FieldTracer& tracer, const Ray& launched) {
  if (!tracer.transmittance() || !has_obscurations(tracer.lens())) return false;
  std::vector<Intersection> path;
  tracer.tracer().trace(launched, Tracer::Clip::none, &path);
  return tracer.transmittance()->along(launched, path) == 0;
}

std::optional<PupilMask> PupilMask::of(const FieldTracer& tracer, const ChiefRay& chief) {
  if (tracer.clip() != Tracer::Clip::apertures || !has_obscurations(tracer.lens())) return {};
  const std::optional<PupilBoundary> pupil = tracer.object_pupil(chief, mask_azimuths);
  if (!pupil) return {};
  const Tracer& glass = tracer.tracer();
  std::vector<std::size_t> surfaces;
  for (std::size_t i = 0; i < glass.surface_count(); ++i)
    if (!closed_figures(glass.surfaces()[i]).empty()) surfaces.push_back(i);
  std::vector<double> alpha, beta;
  std::vector<std::vector<double>> x_mm(surfaces.size()), y_mm(surfaces.size());
  const Pencil pencil = Pencil::from_object(tracer.lens(), chief.object_field);
  for (const PupilNode& node : pupil_nodes(*pupil, mask_radii)) {
    const std::optional<Ray> launched = pencil.ray(node.u, node.v);
    std::vector<Intersection> path;
    if (!launched) continue;
    const Ray end = glass.trace(*launched, Tracer::Clip::none, &path);
    if (end.status != RayStatus::ok) continue;
    // Of a centred lens the other half is the mirror image.
    for (const double side : pupil->mirrored() ? std::vector<double>{1, -1} : std::vector<double>{1}) {
      alpha.push_back(side * end.direction[0]);
      beta.push_back(end.direction[1]);
      for (std::size_t k = 0; k < surfaces.size(); ++k) {
        const Tracer::PreparedSurface& surface = glass.surfaces()[surfaces[k]];
        const Frame::Vector own =
            surface.frame.point_from_lens(path[surfaces[k]].point_mm, surface.vertex_z_mm);
        x_mm[k].push_back(side * own[0]);
        y_mm[k].push_back(own[1]);
      }
    }
  }
  PupilMask mask;
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    const std::array<std::span<const double>, 2> values{x_mm[k], y_mm[k]};
    std::vector<ChebyshevSurface> fits =
        ChebyshevSurface::fit(alpha, beta, values, mask_degree, ChebyshevSurface::Symmetry::none);
    if (fits.size() != values.size()) return {};
    mask.surfaces_.push_back(
        {closed_figures(glass.surfaces()[surfaces[k]]), std::move(fits[0]), std::move(fits[1])});
  }
  return mask;
}

bool PupilMask::is_dark(double alpha, double beta) const {
  return std::any_of(surfaces_.begin(), surfaces_.end(), [&](const Closed& surface) {
    const double x = surface.x_mm(alpha, beta), y = surface.y_mm(alpha, beta);
    return std::any_of(surface.figures.begin(), surface.figures.end(),
                       [&](const ApertureFigure& figure) { return figure.reach_sq(x, y) < 1; });
  });
}

}  // namespace petzval
