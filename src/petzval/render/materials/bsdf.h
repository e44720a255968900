// SPDX-License-Identifier: BSD-3-Clause
// How a point of a surface scatters light.
#pragma once

#include <petzval/render/materials/microfacets.h>
#include <petzval/render/spectra/lanes.h>

#include <array>
#include <optional>

namespace petzval::render {

/// One direction chosen by a surface.
struct BsdfSample {
  Vector3 wi;      ///< where the light comes from
  Lanes weight;    ///< f · |cos| / pdf
  double pdf = 0;  ///< over solid angle; 0 for a mirror direction, which no other way of sampling finds
  bool mirror = false;
  bool transmitted = false;
  double index_ratio = 1;  ///< far side / near side when transmitted: radiance shrinks by its square
};

/// What a coating reflects as a whole from one direction; see coating_albedo.h.
class CoatingAlbedo;

/// Scattering at one point for one group of wavelengths. Everything in the frame of the shading normal, z its
/// axis; wo and wi point away from the surface. Radiance is what travels: transmission carries the factor
/// (near/far index)².
class Bsdf {
 public:
  static Bsdf diffuse(const Lanes& reflectance, const Lanes& transmittance = Lanes::all(0));
  /// Lambert's surface under a clear dielectric without thickness: what the boundary lets in is scattered,
  /// and reflected back at the boundary from below, to all orders.
  static Bsdf coated_diffuse(const Lanes& reflectance, double eta, Microfacets facets,
                             const CoatingAlbedo& coating);
  static Bsdf conductor(const Lanes& eta, const Lanes& k, Microfacets facets);
  /// `eta`: inside / outside for each lane; `hero`: the lane that decides where the light goes.
  static Bsdf dielectric(const Lanes& eta, int hero, Microfacets facets);
  static Bsdf thin_dielectric(const Lanes& eta);

  /// f for both directions; zero for mirrors.
  Lanes value(Vector3 wo, Vector3 wi) const;
  /// The density with which sample() chooses wi; zero for mirrors.
  double pdf(Vector3 wo, Vector3 wi) const;
  /// \param choice, u, v  in [0, 1). Nothing when the light is absorbed.
  std::optional<BsdfSample> sample(Vector3 wo, double choice, double u, double v) const;

  bool is_mirror() const { return mirror_; }
  /// Whether light from behind may come through.
  bool transmits() const;
  /// Whether a transmitted path serves the hero wavelength alone.
  bool disperses() const { return disperses_; }
  /// Share of light reflected as a whole, for albedo pictures: exact for diffuse, facing the surface for
  /// others.
  Lanes albedo() const;

 private:
  enum class Kind { diffuse, coated, conductor, dielectric, thin };
  Bsdf(Kind kind, Microfacets facets) : kind_(kind), facets_(facets) {}

  double coat_share(double cos_out) const;
  Lanes coated_value(Vector3 wo, Vector3 wi) const;
  Lanes conductor_at(double cos) const;
  Lanes dielectric_value(Vector3 wo, Vector3 wi) const;
  double dielectric_pdf(Vector3 wo, Vector3 wi) const;
  std::optional<BsdfSample> sample_diffuse(Vector3 wo, double choice, double u, double v) const;
  std::optional<BsdfSample> sample_coated(Vector3 wo, double choice, double u, double v) const;
  std::optional<BsdfSample> sample_conductor(Vector3 wo, double u, double v) const;
  std::optional<BsdfSample> sample_dielectric(Vector3 wo, double choice, double u, double v) const;
  std::optional<BsdfSample> sample_thin(Vector3 wo, double choice) const;

  Kind kind_;
  Microfacets facets_;
  Lanes first_ = Lanes::all(0);   ///< reflectance, or eta
  Lanes second_ = Lanes::all(0);  ///< transmittance, or k
  double eta_ = 1;
  int hero_ = 0;
  bool mirror_ = false, disperses_ = false;
  const CoatingAlbedo* coating_ = nullptr;
};

/// A direction over the hemisphere with density cos/π, from a point of the unit square (Shirley & Chiu 1997).
Vector3 sample_cosine(double u, double v);

}  // namespace petzval::render
