// SPDX-License-Identifier: BSD-3-Clause
// The sheen of cloth: fibres that stand up and shine along the surface.
#pragma once

#include <petzval/render/vector3.h>

#include <algorithm>
#include <array>

namespace petzval::render {

/// Fibres of the distribution and masking of A. C. Estevez & C. Kulla, "Production friendly microfacet sheen
/// BRDF", 2017, as KHR_materials_sheen has it, alpha = roughness². Fine fibres would reflect more than all
/// light along the surface: there they are dimmed to reflect all of it.
class Sheen {
 public:
  /// Finer fibres count as these.
  static constexpr double least_alpha = 0.01;

  Sheen();

  /// f of white fibres; both directions on one side, z the normal.
  double value(Vector3 wo, Vector3 wi, double alpha) const;
  /// What white fibres take of the light from a direction: ∫ value · cos, 1 at most.
  double albedo(double cos, double alpha) const { return std::min(1.0, undimmed(cos, alpha)); }

 private:
  static constexpr int angles = 64, roughnesses = 32;
  double undimmed(double cos, double alpha) const;

  std::array<std::array<double, angles>, roughnesses> table_{};  ///< [alpha][cos], both by their roots
};

}  // namespace petzval::render
