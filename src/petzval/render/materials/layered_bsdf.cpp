// SPDX-License-Identifier: BSD-3-Clause
// A clear dielectric over an opaque base, of Bsdf (position-free random walks: Guo, Hašan & Zhao, ACM TOG 37
// (2018) 279; Pharr, Jakob & Humphreys, Physically Based Rendering, 4th ed., section 14.3).
#include <petzval/base/units.h>
#include <petzval/render/materials/layer_walk.h>

namespace petzval::render {

namespace {

/// Of the density that stands for a walk's, how much is Lambert's: light that went to and fro in the coat.
constexpr double even_share = 0.2;

}  // namespace

Bsdf Bsdf::layered(const Lanes& first, const Lanes& second, Microfacets coat, Microfacets base,
                   const Layering& layering, std::optional<double> thickness) {
  Bsdf bsdf(Kind::layered, coat);
  bsdf.thickness_ = thickness.value_or(layering.thickness);
  bsdf.first_ = first;
  bsdf.second_ = second;
  bsdf.eta_ = layering.eta;
  bsdf.base_facets_ = base;
  bsdf.layering_ = &layering;
  bsdf.mirror_ = layering.metal && coat.smooth() && base.smooth();
  return bsdf;
}

/// Two smooth boundaries: F + T² B/(1 − F B), B what the base leaves of light that passes the coat twice.
Lanes Bsdf::layered_mirror(double cos) const {
  const double outside = dielectric_reflectance(cos, eta_);
  const double cos_inside = std::sqrt(1 - (1 - cos * cos) / (eta_ * eta_));
  const LayerWalk walk(*this);
  const double absorbed = walk.absorbed(cos_inside);
  const Lanes base = absorbed * absorbed * walk.base().conductor_at(cos_inside);
  return mapped(base, [&](float b) {
    const double each = static_cast<double>(b), again = outside * each;
    double orders = 1 / (1 - again);
    if (walk.turns() < most_turns) orders *= 1 - std::pow(again, walk.turns());
    return outside + (1 - outside) * (1 - outside) * each * orders;
  });
}

/// Each time that a walk from wo meets the base, it is joined to wi in two ways: by the direction that the
/// coat bends wi to, and, if the coat is rough, by the one that the base sends it to.
Lanes Bsdf::layered_value(Vector3 wo, Vector3 wi) const {
  if (wo.z * wi.z < 0) return Lanes::all(0);
  if (wo.z < 0) wo = -wo, wi = -wi;
  if (turbid_) return turbid_value(wo, wi);
  const LayerWalk walk(*this);
  const bool rough = !facets_.smooth();
  WalkNumbers numbers{wo.x, wo.y, wo.z, wi.x, wi.y, wi.z};
  Lanes sum = Lanes::all(0);
  const auto two = [&](auto&& make) {
    const double u = numbers.next();
    return make(u, numbers.next());
  };
  for (int i = 0; i < layering_->walks; ++i) {
    const auto in = two([&](double u, double v) { return walk.cross(wo, true, u, v); });
    const auto out = two([&](double u, double v) { return walk.cross(wi, true, u, v); });
    if (!in) continue;
    Lanes left = Lanes::all(in->weight);
    Vector3 w = in->wi;
    for (int turn = 0; turn < walk.turns(); ++turn) {
      left *= walk.absorbed(w.z);
      if (out && !walk.base().is_mirror()) {
        double weight = out->weight * eta_ * eta_ * walk.absorbed(out->wi.z);
        if (rough) weight *= out->pdf / (out->pdf + walk.base().pdf(-w, -out->wi));
        sum += weight * (left * walk.base().value(-w, -out->wi));
      }
      const auto sent = two([&](double u, double v) { return walk.base().sample(-w, numbers.next(), u, v); });
      if (!sent) break;
      left *= walk.absorbed(sent->wi.z) * sent->weight;
      if (rough) {
        const double found = sent->mirror ? 0 : walk.pdf_through(wi, -sent->wi);
        const double weight = sent->mirror ? 1 : sent->pdf / (sent->pdf + found);
        sum += weight * (left * walk.coat().value(-sent->wi, wi));
      }
      const auto back = two([&](double u, double v) { return walk.cross(-sent->wi, false, u, v); });
      if (!back) break;
      left *= back->weight;
      w = back->wi;
      const double most = static_cast<double>(left.largest());
      if (turn < roulette_turn || most >= roulette_below) continue;
      if (numbers.next() * roulette_below >= most) break;
      left *= roulette_below / most;
    }
  }
  Lanes f = 1.0 / layering_->walks * sum;
  return rough ? f += walk.coat().value(wo, wi) : f;
}

/// The lobe of the coat, the one of the base as the coat bends it, and Lambert's.
double Bsdf::layered_pdf(Vector3 wo, Vector3 wi) const {
  const double even = std::abs(wi.z) / pi, coat = dielectric_reflectance(std::abs(wo.z), eta_);
  const Vector3 m = normalised(wo + wi);
  const auto lobe = [&](const Microfacets& facets) {
    return facets.seen_density(wo, m) / (4 * std::abs(dot(wo, m)));
  };
  double base = even;
  if (layering_->metal) {
    const double width =
        std::clamp(std::hypot(facets_.mean_alpha(), eta_ * base_facets_.mean_alpha()), 0.01, 1.0);
    base = (1 - even_share) * lobe({width, width}) + even_share * even;
  }
  return (1 - coat) * base + (facets_.smooth() ? 0 : coat * lobe(facets_));
}

std::optional<BsdfSample> Bsdf::sample_layered(Vector3 wo, double choice, double u, double v) const {
  BsdfSample result;
  result.mirror = mirror_;
  if (mirror_) {
    result.wi = {-wo.x, -wo.y, wo.z};
    result.weight = layered_mirror(std::abs(wo.z));
    return result;
  }
  const bool below = wo.z < 0;
  if (below) wo = -wo;
  if (turbid_) {
    std::optional<BsdfSample> sample = sample_turbid(wo, choice, u, v);
    if (sample && below) sample->wi = -sample->wi;
    return sample;
  }
  const LayerWalk walk(*this);
  WalkNumbers numbers{choice, u, v};
  std::optional<BsdfSample> at = walk.coat().sample(wo, choice, u, v);
  if (!at) return {};
  Lanes left = at->weight;
  result.mirror = !at->transmitted && at->mirror;
  for (int turn = 0; at->transmitted && turn < walk.turns(); ++turn) {
    const Vector3 w = at->wi;
    // A smooth coat leaves the first two numbers to the base.
    const bool given = turn == 0 && facets_.smooth();
    const double first = numbers.next(), second = numbers.next();
    const auto sent = walk.base().sample(-w, numbers.next(), given ? u : first, given ? v : second);
    if (!sent) return {};
    left *= walk.absorbed(w.z) * walk.absorbed(sent->wi.z) * sent->weight;
    const double lot = numbers.next(), third = numbers.next();
    at = walk.coat().sample(-sent->wi, lot, third, numbers.next());
    if (!at) return {};
    left *= at->weight;
    at->transmitted = !at->transmitted;  // from below: whether it is still in the coat
    const double most = static_cast<double>(left.largest());
    if (!at->transmitted || turn < roulette_turn || most >= roulette_below) continue;
    if (numbers.next() * roulette_below >= most) return {};
    left *= roulette_below / most;
  }
  if (at->wi.z <= 0) return {};
  result.wi = below ? -at->wi : at->wi;
  result.weight = left;
  if (!result.mirror) result.pdf = layered_pdf(wo, at->wi);
  return result;
}

}  // namespace petzval::render
