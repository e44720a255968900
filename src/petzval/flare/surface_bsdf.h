// SPDX-License-Identifier: BSD-3-Clause
// What a surface of a lens scatters at one wavelength, and where to.
#pragma once

#include <petzval/lens/scatter.h>

#include <functional>
#include <vector>

namespace petzval {

/// A density over the plane of β − β₀ that depends on τ = |β − β₀| alone, 1 in all over τ ≤ 1, and nothing
/// beyond. Between 1,000 even steps of log τ it is a power of τ, which its sums count exactly; below τ = 1e-6
/// it is flat.
class RadialDensity {
 public:
  RadialDensity() = default;
  /// \param shape  not negative, on any scale.
  explicit RadialDensity(const std::function<double(double)>& shape);

  /// [1 over the unit of τ²]
  double at(double tau) const;
  /// The share within τ.
  double within(double tau) const;
  /// ∬ of the shape as it was given.
  double total() const { return total_; }

 private:
  std::vector<double> log_, sum_;
  double total_ = 0;
};

/// Shares of the light that meets a surface.
struct ScatterShares {
  double polish = 0, dust = 0;  ///< that are scattered
  double blocked = 0;           ///< that dust keeps

  double scattered() const { return polish + dust; }
  /// What goes on as if nothing had been: reflectance and transmittance are shares of this.
  double specular() const { return 1 - polish - dust - blocked; }
};

/// A surface at one wavelength. The flux that it scatters into dω at the angle θ is BSDF cosθ dω = BSDF d²β
/// of what meets it, β as in air (lens/scatter.h): what is scattered, what dust keeps and what goes on are
/// all the light.
///
/// Roughness σ: 1 − exp(−(2πσ(n cosθ − n′ cosθ′)/λ)²), with n + n in place of n − n′ for a mirror: at small
/// σ Bennett and Porteus's (4πσ cosθ/λ)² (1961). b₀ and tables give the share that they sum up to over
/// |β − β₀| ≤ 1, at every angle; b₀ and l go with (λ₀/λ)⁴ and λ/λ₀. Dust that covers c keeps c and diffracts
/// as much (H. C. van de Hulst 1957, ch. 8): forwards, as discs of the sizes of its level do (Airy), fringes
/// beyond the fifth at their mean.
class SurfaceBsdf {
 public:
  SurfaceBsdf() = default;  ///< scatters nothing
  /// \throws InputError as Scatter::validate(), and if it were to scatter more than there is.
  SurfaceBsdf(const Scatter& scatter, double wavelength_nm, double index_before, double index_after,
              bool mirror = false);

  bool scatters() const { return constant_polish_ > 0 || roughness_waves_ > 0 || dust_ > 0; }
  ScatterShares shares(double cosine_before, double cosine_after) const;
  /// The BSDF [1/sr].
  double at(const ScatterShares& shares, double tau) const;
  /// What is scattered within τ, as a share of all light.
  double within(const ScatterShares& shares, double tau) const;

 private:
  double index_before_ = 1, index_after_ = 1;
  double constant_polish_ = 0, roughness_waves_ = 0, dust_ = 0;
  RadialDensity polish_shape_, dust_shape_;
};

}  // namespace petzval
