// SPDX-License-Identifier: BSD-3-Clause
// The two boundaries of Bsdf::layered, as walks at random meet them.
#pragma once

#include <petzval/numeric/sobol.h>
#include <petzval/render/materials/bsdf.h>
#include <petzval/render/materials/fresnel.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <initializer_list>

namespace petzval::render {

/// Enough for any base: what is left of a path falls by a tenth or more each time it meets the coat.
inline constexpr int most_turns = 500;
/// Before that many reflections by the base no walk is ended at random, nor while more than this is left.
inline constexpr int roulette_turn = 2;
inline constexpr double roulette_below = 0.25;

/// Numbers in [0, 1) that others decide.
class WalkNumbers {
 public:
  WalkNumbers(std::initializer_list<double> others) {
    for (const double each : others) {
      const auto bits = std::bit_cast<std::uint64_t>(each);
      seed_ = hashed(hashed(seed_, static_cast<std::uint32_t>(bits)), static_cast<std::uint32_t>(bits >> 32));
    }
  }
  double next() { return hashed(seed_, ++count_) * 0x1p-32; }

 private:
  std::uint32_t seed_ = 1, count_ = 0;
};

/// The two boundaries, as a walk meets them. Directions point away from the boundary; z > 0 is outside.
class Bsdf::LayerWalk {
 public:
  explicit LayerWalk(const Bsdf& whole)
      : layering_(*whole.layering_),
        thickness_(whole.thickness_),
        facets_(whole.facets_),
        coat_(Bsdf::dielectric(Lanes::all(layering_.eta), 0, facets_)),
        base_(layering_.metal ? Bsdf::conductor(1 / layering_.eta * whole.first_,
                                                1 / layering_.eta * whole.second_, whole.base_facets_)
                              : Bsdf::diffuse(whole.first_)) {}

  const Bsdf& coat() const { return coat_; }
  const Bsdf& base() const { return base_; }
  int turns() const {
    return layering_.max_depth > 0 ? std::min(most_turns, (layering_.max_depth + 1) / 2) : most_turns;
  }
  double absorbed(double cos) const { return thickness_ > 0 ? std::exp(-thickness_ / std::abs(cos)) : 1; }

  struct Crossing {
    Vector3 wi;
    double weight, pdf;  ///< f |cos| / pdf; the density, 0 of a smooth boundary
  };
  /// A direction behind the coat, or, with `through` false, before it, never the other: the weight has the
  /// chance of that.
  std::optional<Crossing> cross(Vector3 w, bool through, double u, double v) const {
    const double eta = w.z > 0 ? layering_.eta : 1 / layering_.eta;
    const Vector3 m =
        facets_.smooth() ? Vector3{0, 0, std::copysign(1.0, w.z)} : facing(facets_.sample_seen(w, u, v), w);
    const double reflectance = dielectric_reflectance(std::abs(dot(w, m)), eta);
    const std::optional<Vector3> wi = through ? refracted(w, m, eta) : reflected(w, m);
    if (!wi || wi->z == 0 || (wi->z * w.z > 0) == through) return {};
    Crossing result{*wi, through ? (1 - reflectance) / (eta * eta) : reflectance, 0};
    if (facets_.smooth()) return result;
    result.weight *= facets_.shown(w, *wi) * (1 + facets_.lambda(w));
    if (through) result.pdf = pdf_through(w, *wi);
    return result;
  }
  /// The density with which cross() finds a direction behind the coat.
  double pdf_through(Vector3 w, Vector3 wi) const {
    const double eta = w.z > 0 ? layering_.eta : 1 / layering_.eta;
    const double passing = 1 - dielectric_reflectance(std::abs(dot(w, normalised(w + eta * wi))), eta);
    return passing > 0 ? coat_.pdf(w, wi) / passing : 0;
  }

 private:
  const Layering& layering_;
  double thickness_;
  const Microfacets& facets_;
  Bsdf coat_, base_;
};

}  // namespace petzval::render
