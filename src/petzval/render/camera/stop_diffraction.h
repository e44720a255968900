// SPDX-License-Identifier: BSD-3-Clause
// Diffraction at the stop, ray by ray.
#pragma once

#include <petzval/trace/kernel_path.h>

#include <array>
#include <span>

namespace petzval::render {

/// Bends rays at random where they cross the stop, the more the nearer they pass by its edge: towards the
/// edge and along it by direction cosines of normal distributions, each as wide as Heisenberg's uncertainty
/// has it for a photon known to within its distances d from the edge, λ/(4π d) (Freniere, Gregory & Hassler,
/// "Edge diffraction in Monte Carlo ray tracing", Proc. SPIE 3780, 1999). Rays know nothing of each other's
/// phase: there are no rings, and the light between them is where a mean over rings has it, roughly
/// (docs/RENDERING.md).
class StopDiffraction {
 public:
  /// Through this lens from the film to the scene, with the blades that the tracer has.
  /// \throws InputError unless the stop has a radius.
  StopDiffraction(const Tracer& tracer, double wavelength_nm);

  /// Traces in place, from the film out in front of the lens, as trace_columns().
  /// \param numbers  two in [0, 1) a ray, that choose its bend.
  void trace(const RayColumns<double>& rays, std::span<const std::array<double, 2>> numbers) const;

 private:
  /// Axes across and along the nearest edge, and how far the stop's edge is along each.
  struct Surroundings {
    std::array<double, 2> across{1, 0};
    double to_edge_mm = 0, to_sides_mm = 0;
  };
  Surroundings round_stop(double x_mm, double y_mm) const;
  Surroundings bladed_stop(double x_mm, double y_mm) const;
  bool bend(const RayColumns<double>& rays, std::size_t i, const std::array<double, 2>& numbers) const;

  KernelPath<double> to_stop_, to_scene_;
  double wavelength_mm_ = 0;  ///< in front of the stop
  double radius_mm_ = 0, apothem_mm_ = 0;
  std::vector<std::array<double, 2>> edges_;  ///< unit normals; none: round
};

}  // namespace petzval::render
