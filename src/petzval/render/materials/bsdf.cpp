// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/render/disk_point.h>
#include <petzval/render/materials/bsdf.h>
#include <petzval/render/materials/coating_albedo.h>
#include <petzval/render/materials/fresnel.h>
#include <petzval/render/materials/measured_brdf.h>

#include <algorithm>

namespace petzval::render {

Vector3 sample_cosine(double u, double v) {
  const DiskPoint on = disk_point(u, v);
  return {on.x, on.y, std::sqrt(std::max(0.0, 1 - on.x * on.x - on.y * on.y))};
}

Bsdf Bsdf::diffuse(const Lanes& reflectance, const Lanes& transmittance) {
  Bsdf bsdf(Kind::diffuse, {0, 0});
  bsdf.first_ = reflectance;
  bsdf.second_ = transmittance;
  return bsdf;
}

Bsdf Bsdf::coated_diffuse(const Lanes& reflectance, double eta, Microfacets facets,
                          const CoatingAlbedo& coating) {
  Bsdf bsdf(Kind::coated, facets);
  bsdf.first_ = reflectance;
  bsdf.eta_ = eta;
  bsdf.coating_ = &coating;
  return bsdf;
}

Bsdf Bsdf::conductor(const Lanes& eta, const Lanes& k, Microfacets facets) {
  Bsdf bsdf(Kind::conductor, facets);
  bsdf.first_ = eta;
  bsdf.second_ = k;
  bsdf.mirror_ = facets.smooth();
  return bsdf;
}

Bsdf Bsdf::dielectric(const Lanes& eta, int hero, Microfacets facets) {
  Bsdf bsdf(Kind::dielectric, facets);
  bsdf.first_ = eta;
  bsdf.hero_ = hero;
  bsdf.eta_ = static_cast<double>(eta[hero]);
  bsdf.disperses_ = std::any_of(eta.v, eta.v + lane_count, [&](float each) { return each != eta[hero]; });
  // A boundary between equals is no boundary.
  bsdf.mirror_ = facets.smooth() || (!bsdf.disperses_ && bsdf.eta_ == 1);
  return bsdf;
}

Bsdf Bsdf::thin_dielectric(const Lanes& eta) {
  Bsdf bsdf(Kind::thin, {0, 0});
  bsdf.first_ = eta;
  bsdf.mirror_ = true;
  return bsdf;
}

Bsdf Bsdf::measured(const MeasuredBrdf& measured, int group) {
  Bsdf bsdf(Kind::measured, {0, 0});
  bsdf.measured_ = &measured;
  bsdf.group_ = group;
  return bsdf;
}

bool Bsdf::transmits() const {
  return kind_ == Kind::dielectric || kind_ == Kind::thin || (kind_ == Kind::diffuse && !second_.is_black());
}

Lanes Bsdf::bare_value(Vector3 wo, Vector3 wi) const {
  if (mirror_ || wo.z == 0 || wi.z == 0) return Lanes::all(0);
  switch (kind_) {
    case Kind::diffuse:
      return 1 / pi * (wo.z * wi.z > 0 ? first_ : second_);
    case Kind::coated:
      return coated_value(wo, wi);
    case Kind::conductor: {
      if (wo.z * wi.z < 0) return Lanes::all(0);
      const Vector3 m = normalised(wo + wi);
      return facets_.density(m) * facets_.shown(wo, wi) / (4 * std::abs(wo.z * wi.z)) *
             conductor_at(std::abs(dot(wo, m)));
    }
    case Kind::dielectric:
      return dielectric_value(wo, wi);
    case Kind::layered:
      return layered_value(wo, wi);
    case Kind::measured:
      return measured_->value(wo, wi, group_);
    case Kind::thin:
      break;
  }
  return Lanes::all(0);
}

double Bsdf::bare_pdf(Vector3 wo, Vector3 wi) const {
  if (mirror_ || wo.z == 0 || wi.z == 0) return 0;
  const bool same_side = wo.z * wi.z > 0;
  switch (kind_) {
    case Kind::diffuse: {
      const double r = first_.largest(), t = second_.largest();
      return r + t > 0 ? std::abs(wi.z) / pi * (same_side ? r : t) / (r + t) : 0;
    }
    case Kind::coated: {
      if (!same_side) return 0;
      const double coat = coat_share(std::abs(wo.z)), base = (1 - coat) * std::abs(wi.z) / pi;
      if (facets_.smooth()) return base;
      const Vector3 m = normalised(wo + wi);
      return base + coat * facets_.seen_density(wo, m) / (4 * std::abs(dot(wo, m)));
    }
    case Kind::conductor: {
      if (!same_side) return 0;
      const Vector3 m = normalised(wo + wi);
      return facets_.seen_density(wo, m) / (4 * std::abs(dot(wo, m)));
    }
    case Kind::dielectric:
      return dielectric_pdf(wo, wi);
    case Kind::layered:
      return same_side ? layered_pdf(wo, wi) : 0;
    case Kind::measured:
      return measured_->pdf(wo, wi);
    case Kind::thin:
      break;
  }
  return 0;
}

std::optional<BsdfSample> Bsdf::bare_sample(Vector3 wo, double choice, double u, double v) const {
  if (wo.z == 0) return {};
  switch (kind_) {
    case Kind::diffuse:
      return sample_diffuse(wo, choice, u, v);
    case Kind::coated:
      return sample_coated(wo, choice, u, v);
    case Kind::conductor:
      return sample_conductor(wo, u, v);
    case Kind::dielectric:
      return sample_dielectric(wo, choice, u, v);
    case Kind::layered:
      return sample_layered(wo, choice, u, v);
    case Kind::measured:
      return measured_->sample(wo, u, v, group_);
    case Kind::thin:
      break;
  }
  return sample_thin(wo, choice);
}

Lanes Bsdf::bare_albedo() const {
  if (kind_ == Kind::diffuse || kind_ == Kind::coated) return first_;
  if (kind_ == Kind::conductor) return conductor_at(1);
  if (kind_ == Kind::layered) return layering_->metal ? layered_mirror(1) : first_;
  if (kind_ == Kind::measured) return measured_->albedo(group_);
  return Lanes::all(1);
}

std::optional<BsdfSample> Bsdf::sample_diffuse(Vector3 wo, double choice, double u, double v) const {
  const double r = first_.largest(), t = second_.largest();
  if (!(r + t > 0)) return {};
  const bool reflects = choice * (r + t) < r;
  BsdfSample sample;
  sample.wi = sample_cosine(u, v);
  if ((wo.z > 0) != reflects) sample.wi.z = -sample.wi.z;
  sample.transmitted = !reflects;
  const double share = (reflects ? r : t) / (r + t);
  sample.pdf = std::abs(sample.wi.z) / pi * share;
  if (!(sample.pdf > 0)) return {};
  sample.weight = 1 / share * (reflects ? first_ : second_);
  return sample;
}

/// How often the coating is followed instead of the base: as it reflects, but neither never nor always.
double Bsdf::coat_share(double cos_out) const {
  const double coat = coating_->outside(cos_out, facets_.mean_alpha());
  const double base = (1 - coat) * static_cast<double>(first_.largest());
  return coat + base > 0 ? std::clamp(coat / (coat + base), 0.05, 0.95) : 0.5;
}

Lanes Bsdf::coated_value(Vector3 wo, Vector3 wi) const {
  if (wo.z * wi.z < 0) return Lanes::all(0);
  const double alpha = facets_.mean_alpha(), inside = coating_->inside_mean(alpha);
  const double through = (1 - coating_->outside(std::abs(wo.z), alpha)) *
                         (1 - coating_->outside(std::abs(wi.z), alpha)) / (pi * eta_ * eta_);
  Lanes f = mapped(first_, [&](float base) {
    return through * static_cast<double>(base) / (1 - static_cast<double>(base) * inside);
  });
  if (facets_.smooth()) return f;
  const Vector3 m = normalised(wo + wi);
  const double shine = facets_.density(m) * facets_.shown(wo, wi) *
                       dielectric_reflectance(std::abs(dot(wo, m)), eta_) / (4 * std::abs(wo.z * wi.z));
  return f += Lanes::all(shine);
}

std::optional<BsdfSample> Bsdf::sample_coated(Vector3 wo, double choice, double u, double v) const {
  const double coat = coat_share(std::abs(wo.z));
  BsdfSample sample;
  if (choice < coat && facets_.smooth()) {
    sample.wi = {-wo.x, -wo.y, wo.z};
    sample.mirror = true;
    sample.weight = Lanes::all(dielectric_reflectance(std::abs(wo.z), eta_) / coat);
    return sample;
  }
  if (choice < coat) {
    const Vector3 m = facing(facets_.sample_seen(wo, u, v), wo);
    sample.wi = reflected(wo, m);
    if (sample.wi.z * wo.z <= 0) return {};
  } else {
    sample.wi = sample_cosine(u, v);
    if (wo.z < 0) sample.wi.z = -sample.wi.z;
  }
  sample.pdf = bare_pdf(wo, sample.wi);
  if (!(sample.pdf > 0)) return {};
  sample.weight = std::abs(sample.wi.z) / sample.pdf * coated_value(wo, sample.wi);
  return sample;
}

Lanes Bsdf::conductor_at(double cos) const {
  Lanes result;
  // In single precision, so that the compiler puts lanes side by side.
  const auto cos_incident = static_cast<float>(cos);
  for (int i = 0; i < lane_count; ++i)
    result[i] = std::max(0.0f, conductor_reflectance(cos_incident, first_[i], second_[i]));
  return result;
}

std::optional<BsdfSample> Bsdf::sample_conductor(Vector3 wo, double u, double v) const {
  BsdfSample sample;
  if (mirror_) {
    sample.wi = {-wo.x, -wo.y, wo.z};
    sample.mirror = true;
    sample.weight = conductor_at(std::abs(wo.z));
    return sample;
  }
  const Vector3 m = facing(facets_.sample_seen(wo, u, v), wo);
  sample.wi = reflected(wo, m);
  if (sample.wi.z * wo.z <= 0) return {};
  sample.pdf = facets_.seen_density(wo, m) / (4 * std::abs(dot(wo, m)));
  if (!(sample.pdf > 0)) return {};
  // f cos / pdf = F G2/G1.
  sample.weight =
      facets_.shown(wo, sample.wi) * (1 + facets_.lambda(wo)) * conductor_at(std::abs(dot(wo, m)));
  return sample;
}

std::optional<BsdfSample> Bsdf::sample_thin(Vector3 wo, double choice) const {
  // Both boundaries, to all orders: R + T²R/(1 − R²).
  const auto slab = [&](float eta) {
    const double r = dielectric_reflectance(std::abs(wo.z), static_cast<double>(eta));
    return r < 1 ? 2 * r / (1 + r) : 1.0;
  };
  const Lanes reflectance = mapped(first_, slab);
  double share = 0;
  for (const float each : reflectance.v) share += static_cast<double>(each) / lane_count;
  BsdfSample sample;
  sample.mirror = true;
  if (choice < share) {
    sample.wi = {-wo.x, -wo.y, wo.z};
    sample.weight = 1 / share * reflectance;
  } else {
    sample.wi = -wo;
    sample.transmitted = true;
    sample.weight = mapped(reflectance, [&](float r) { return (1 - static_cast<double>(r)) / (1 - share); });
  }
  return sample;
}

}  // namespace petzval::render
