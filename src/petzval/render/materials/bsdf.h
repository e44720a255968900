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
class MeasuredBrdf;
class Sheen;

/// How a clear dielectric lies over an opaque base.
struct Layering {
  double eta = 1.5;      ///< of the dielectric, against the outside
  double thickness = 0;  ///< its optical depth straight through; 0: it absorbs nothing
  int max_depth = 0;     ///< of light between its two sides, in boundaries met; 0: any
  int walks = 1;         ///< that value() is the mean of
  bool metal = false;    ///< the base: a conductor, or else Lambert's
};

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
  /// A clear dielectric over a base, with all that is reflected between them, by random walks through the two
  /// (Guo, Hasan and Zhao 2018). value() is a draw whose mean is f, the same for the same directions; pdf()
  /// is near the density of sample(), near enough to weigh two ways of sampling.
  /// \param first  of the base: its reflectance, or eta in air. \param second  k in air, of a metal.
  /// \param thickness  here, if not that of `layering`.
  static Bsdf layered(const Lanes& first, const Lanes& second, Microfacets coat, Microfacets base,
                      const Layering& layering, std::optional<double> thickness = {});
  /// `eta`: inside / outside for each lane; `hero`: the lane that decides where the light goes.
  static Bsdf dielectric(const Lanes& eta, int hero, Microfacets facets);
  static Bsdf thin_dielectric(const Lanes& eta);
  /// `measured` must outlive it.
  static Bsdf measured(const MeasuredBrdf& measured, int group);

  /// Fibres over what is there, which must be opaque and not layered: of what they leave of the light both
  /// ways the lesser share lights it (KHR_materials_sheen).
  void cover(const Sheen& sheen, const Lanes& colour, double alpha);

  /// What scatters inside the coat of a layered kind, whose thickness is its extinction.
  /// \param albedo  what it leaves of light each time. \param g  of Henyey and Greenstein's phase function.
  void make_turbid(const Lanes& albedo, double g);

  /// f for both directions; zero for mirrors.
  Lanes value(Vector3 wo, Vector3 wi) const;
  /// The density with which sample() chooses wi; zero for mirrors.
  double pdf(Vector3 wo, Vector3 wi) const;
  /// \param choice, u, v  in [0, 1). Nothing when the light is absorbed.
  std::optional<BsdfSample> sample(Vector3 wo, double choice, double u, double v) const;

  bool is_mirror() const { return mirror_ && !sheen_; }
  /// Whether light from behind may come through.
  bool transmits() const;
  /// Whether a transmitted path serves the hero wavelength alone.
  bool disperses() const { return disperses_; }
  /// Share of light reflected as a whole, for albedo pictures: exact for diffuse, facing the surface for
  /// others.
  Lanes albedo() const;

 private:
  enum class Kind { diffuse, coated, conductor, dielectric, thin, layered, measured };
  class LayerWalk;
  class TurbidWalk;
  Bsdf(Kind kind, Microfacets facets) : kind_(kind), facets_(facets) {}

  Lanes bare_value(Vector3 wo, Vector3 wi) const;
  double bare_pdf(Vector3 wo, Vector3 wi) const;
  std::optional<BsdfSample> bare_sample(Vector3 wo, double choice, double u, double v) const;
  Lanes bare_albedo() const;
  double left_by_sheen(Vector3 wo, Vector3 wi) const;
  double sheen_share(Vector3 wo) const;
  double coat_share(double cos_out) const;
  Lanes coated_value(Vector3 wo, Vector3 wi) const;
  Lanes conductor_at(double cos) const;
  Lanes dielectric_value(Vector3 wo, Vector3 wi) const;
  double dielectric_pdf(Vector3 wo, Vector3 wi) const;
  Lanes layered_value(Vector3 wo, Vector3 wi) const;
  double layered_pdf(Vector3 wo, Vector3 wi) const;
  Lanes layered_mirror(double cos) const;
  Lanes turbid_value(Vector3 wo, Vector3 wi) const;
  std::optional<BsdfSample> sample_turbid(Vector3 wo, double choice, double u, double v) const;
  std::optional<BsdfSample> sample_diffuse(Vector3 wo, double choice, double u, double v) const;
  std::optional<BsdfSample> sample_coated(Vector3 wo, double choice, double u, double v) const;
  std::optional<BsdfSample> sample_conductor(Vector3 wo, double u, double v) const;
  std::optional<BsdfSample> sample_dielectric(Vector3 wo, double choice, double u, double v) const;
  std::optional<BsdfSample> sample_thin(Vector3 wo, double choice) const;
  std::optional<BsdfSample> sample_layered(Vector3 wo, double choice, double u, double v) const;

  Kind kind_;
  Microfacets facets_;
  Lanes first_ = Lanes::all(0);   ///< reflectance, or eta
  Lanes second_ = Lanes::all(0);  ///< transmittance, or k
  double eta_ = 1;
  int hero_ = 0;
  bool mirror_ = false, disperses_ = false, turbid_ = false;
  const CoatingAlbedo* coating_ = nullptr;
  const Layering* layering_ = nullptr;
  double thickness_ = 0;           ///< of the coat
  Microfacets base_facets_{0, 0};  ///< below the coat
  const MeasuredBrdf* measured_ = nullptr;
  int group_ = 0;  ///< of wavelengths, of what is measured
  const Sheen* sheen_ = nullptr;
  Lanes sheen_colour_ = Lanes::all(0);
  double sheen_alpha_ = 1;
  Lanes turbid_albedo_ = Lanes::all(0);  ///< of what scatters in a turbid coat
  double turbid_g_ = 0;
};

/// A direction over the hemisphere with density cos/π, from a point of the unit square (Shirley & Chiu 1997).
Vector3 sample_cosine(double u, double v);

}  // namespace petzval::render
