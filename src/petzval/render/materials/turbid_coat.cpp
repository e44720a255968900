// SPDX-License-Identifier: BSD-3-Clause
// A coat that scatters light inside, of Bsdf::layered: walks as in layered_bsdf.cpp, with places where the
// medium between the two boundaries scatters (Guo, Hašan & Zhao 2018).
#include <petzval/render/materials/layer_walk.h>
#include <petzval/render/media/phase_function.h>

namespace petzval::render {

namespace {

/// So many bring light through any coat that lets a visible part of it through.
constexpr int most_events = 10000;

}  // namespace

void Bsdf::make_turbid(const Lanes& albedo, double g) {
  turbid_ = true;
  mirror_ = false;
  turbid_albedo_ = albedo;
  turbid_g_ = g;
}

/// Where a walk is in the coat and where it goes to.
class Bsdf::TurbidWalk {
 public:
  TurbidWalk(const Bsdf& whole, const LayerWalk& layers, WalkNumbers& numbers)
      : whole_(whole), layers_(layers), numbers_(numbers) {}

  enum class Place { base, medium, coat };
  /// To where it is scattered or meets a boundary. \param w  its way.
  Place fly(Vector3 w) {
    const double free = -std::log1p(-numbers_.next());
    const double most = (w.z < 0 ? whole_.thickness_ - depth_ : depth_) / std::abs(w.z);
    depth_ = free < most ? depth_ - free * w.z : w.z < 0 ? whole_.thickness_ : 0;
    return free < most ? Place::medium : w.z < 0 ? Place::base : Place::coat;
  }
  /// What is left on the way from here straight to the coat.
  double left_to_coat(Vector3 w) const { return std::exp(-depth_ / std::abs(w.z)); }

  /// A direction from the base or the medium. \param w  the way on which it was met.
  std::optional<BsdfSample> scatter(Place place, Vector3 w) {
    const double u = numbers_.next(), v = numbers_.next();
    if (place == Place::base) return layers_.base().sample(-w, numbers_.next(), u, v);
    BsdfSample sample;
    sample.wi = sample_henyey_greenstein(w, whole_.turbid_g_, u, v);
    if (sample.wi.z == 0) return {};
    sample.pdf = henyey_greenstein(dot(w, sample.wi), whole_.turbid_g_);
    sample.weight = whole_.turbid_albedo_;
    return sample;
  }
  /// Of light that came along `in` through the coat, where that and the base are mirrors: what the medium
  /// scatters of it straight and from between the two, in all orders.
  Lanes scattered_of_mirrored(Vector3 w, Vector3 in) const {
    const double cos = std::abs(in.z), across = std::exp(-whole_.thickness_ / cos),
                 back = dielectric_reflectance(cos, 1 / whole_.eta_) * across * across;
    const double up = density(Place::medium, w, -in) * std::exp(-depth_ / cos),
                 down = density(Place::medium, w, {-in.x, -in.y, in.z}) *
                        std::exp(-(whole_.thickness_ - depth_) / cos) * across;
    const Lanes orders = mapped(layers_.base().conductor_at(cos), [&](float base) {
      const double each = static_cast<double>(base);
      return (up + down * each) / (cos * (1 - back * each));
    });
    return orders * whole_.turbid_albedo_;
  }
  double density(Place place, Vector3 w, Vector3 to) const {
    return place == Place::base ? layers_.base().pdf(-w, to)
                                : henyey_greenstein(dot(w, to), whole_.turbid_g_);
  }
  /// Of light that goes to `to`, over the cosine that Crossing::weight has.
  Lanes scattered(Place place, Vector3 w, Vector3 to) const {
    if (place == Place::base) return layers_.base().value(-w, to);
    return density(place, w, to) / std::abs(to.z) * whole_.turbid_albedo_;
  }
  /// Whether the walk goes on, at random for what is weak.
  bool goes_on(int event, Lanes& left) {
    const double most = static_cast<double>(left.largest());
    if (event < 2 * roulette_turn || most >= roulette_below) return most > 0;
    if (numbers_.next() * roulette_below >= most) return false;
    left *= roulette_below / most;
    return true;
  }
  int events() const { return whole_.layering_->max_depth > 0 ? whole_.layering_->max_depth : most_events; }

 private:
  const Bsdf& whole_;
  const LayerWalk& layers_;
  WalkNumbers& numbers_;
  double depth_ = 0;  ///< below the coat
};

/// Joined to wi as in layered_value(), at each place where the walk is scattered.
Lanes Bsdf::turbid_value(Vector3 wo, Vector3 wi) const {
  const LayerWalk layers(*this);
  const bool rough = !facets_.smooth();
  WalkNumbers numbers{wo.x, wo.y, wo.z, wi.x, wi.y, wi.z};
  const auto cross = [&](Vector3 w, bool through) {
    const double u = numbers.next();
    return layers.cross(w, through, u, numbers.next());
  };
  Lanes sum = Lanes::all(0);
  for (int i = 0; i < layering_->walks; ++i) {
    const auto in = cross(wo, true), out = cross(wi, true);
    if (!in) continue;
    TurbidWalk walk(*this, layers, numbers);
    Lanes left = Lanes::all(in->weight);
    Vector3 w = in->wi;
    double density = 0;  // of w, where it was scattered last; 0 of a mirror
    for (int event = 0; event < walk.events() && walk.goes_on(event, left); ++event) {
      const TurbidWalk::Place place = walk.fly(w);
      if (place == TurbidWalk::Place::coat) {
        if (rough) {
          const double weight = density > 0 ? density / (density + layers.pdf_through(wi, -w)) : 1;
          sum += weight * (left * layers.coat().value(-w, wi));
        }
        const auto back = cross(-w, false);
        if (!back) break;
        left *= back->weight;
        w = back->wi;
        continue;
      }
      const bool mirror = layers.base().is_mirror();
      if (out && mirror && !rough && place == TurbidWalk::Place::medium) {
        sum += out->weight * eta_ * eta_ * (left * walk.scattered_of_mirrored(w, out->wi));
      } else if (out && !(mirror && place == TurbidWalk::Place::base)) {
        double weight = out->weight * eta_ * eta_ * walk.left_to_coat(out->wi);
        if (rough) weight *= out->pdf / (out->pdf + walk.density(place, w, -out->wi));
        sum += weight * (left * walk.scattered(place, w, -out->wi));
      }
      const auto sent = walk.scatter(place, w);
      if (!sent) break;
      left *= sent->weight;
      density = sent->mirror ? 0 : sent->pdf;
      w = sent->wi;
    }
  }
  const Lanes f = 1.0 / layering_->walks * sum;
  return rough ? f + layers.coat().value(wo, wi) : f;
}

std::optional<BsdfSample> Bsdf::sample_turbid(Vector3 wo, double choice, double u, double v) const {
  const LayerWalk layers(*this);
  WalkNumbers numbers{choice, u, v};
  std::optional<BsdfSample> at = layers.coat().sample(wo, choice, u, v);
  if (!at) return {};
  bool inside = at->transmitted, mirrors = at->mirror;
  Lanes left = at->weight;
  TurbidWalk walk(*this, layers, numbers);
  for (int event = 0; inside && event < walk.events() && walk.goes_on(event, left); ++event) {
    const Vector3 w = at->wi;
    const TurbidWalk::Place place = walk.fly(w);
    if (place == TurbidWalk::Place::coat) {
      const double lot = numbers.next(), first = numbers.next();
      at = layers.coat().sample(-w, lot, first, numbers.next());
      inside = at && !at->transmitted;
    } else {
      at = walk.scatter(place, w);
    }
    if (!at) return {};
    left *= at->weight;
    mirrors = mirrors && at->mirror;
  }
  if (inside || at->wi.z <= 0) return {};
  BsdfSample result;
  result.wi = at->wi;
  result.weight = left;
  result.mirror = mirrors;
  if (!mirrors) result.pdf = layered_pdf(wo, at->wi);
  return result;
}

}  // namespace petzval::render
