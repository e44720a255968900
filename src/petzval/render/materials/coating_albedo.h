// SPDX-License-Identifier: BSD-3-Clause
// What a rough clear coating reflects as a whole.
#pragma once

#include <array>

namespace petzval::render {

/// E(cos, alpha): the share of light from one direction that a dielectric boundary of index `eta` and
/// Trowbridge-Reitz roughness alpha reflects back outside, masking losses included. It takes the place of
/// Fresnel's F in the energy balance of a coated surface, which then keeps all light when the base does,
/// whatever the roughness (in the manner of Kelemen & Szirmay-Kalos, Eurographics 2001).
class CoatingAlbedo {
 public:
  explicit CoatingAlbedo(double eta);

  double eta() const { return eta_; }
  /// Of light from outside.
  double outside(double cos, double alpha) const;
  /// Of diffuse light from inside: 1 − (1 − mean of outside)/eta², by reciprocity.
  double inside_mean(double alpha) const;

 private:
  static constexpr int angles = 32, roughnesses = 16;
  double at(double cos, double row) const;

  double eta_;
  std::array<std::array<double, angles>, roughnesses> table_{};  ///< [alpha][cos]
  std::array<double, roughnesses> mean_{};
};

}  // namespace petzval::render
