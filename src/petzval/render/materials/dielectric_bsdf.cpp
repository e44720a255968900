// SPDX-License-Identifier: BSD-3-Clause
// The dielectric boundary of Bsdf: glass and water, smooth and rough (Walter et al., EGSR 2007).
#include <petzval/render/materials/bsdf.h>
#include <petzval/render/materials/fresnel.h>

#include <algorithm>

namespace petzval::render {

namespace {

/// The facet that takes wo to wi, facing +z; nothing if none does.
std::optional<Vector3> facet_between(Vector3 wo, Vector3 wi, double eta) {
  const bool same_side = wo.z * wi.z > 0;
  const Vector3 sum = wo + (same_side ? 1 : eta) * wi;
  if (!(dot(sum, sum) > 0)) return {};
  const Vector3 m = facing(normalised(sum), {0, 0, 1});
  // The facet must show wo and wi the sides that the surface shows them.
  if (dot(m, wi) * wi.z <= 0 || dot(m, wo) * wo.z <= 0) return {};
  return m;
}

}  // namespace

Lanes Bsdf::dielectric_value(Vector3 wo, Vector3 wi) const {
  const bool same_side = wo.z * wi.z > 0;
  Lanes result;
  for (int i = 0; i < lane_count; ++i) {
    result[i] = 0;
    if (i > 0 && !disperses_) {
      result[i] = result[0];
      continue;
    }
    const double inside = static_cast<double>(first_[i]), eta = wo.z > 0 ? inside : 1 / inside;
    const std::optional<Vector3> m = facet_between(wo, wi, eta);
    if (!m) continue;
    const double cos_o = std::abs(dot(wo, *m)), cos_i = std::abs(dot(wi, *m));
    const double reflectance = dielectric_reflectance(cos_o, eta);
    const double common = facets_.density(*m) * facets_.shown(wo, wi) / std::abs(wo.z * wi.z);
    if (same_side) {
      result[i] = static_cast<float>(common * reflectance / 4);
    } else {
      const double bend = dot(wi, *m) + dot(wo, *m) / eta;
      result[i] =
          static_cast<float>(common * (1 - reflectance) * cos_i * cos_o / (bend * bend) / (eta * eta));
    }
  }
  return result;
}

double Bsdf::dielectric_pdf(Vector3 wo, Vector3 wi) const {
  const double eta = wo.z > 0 ? eta_ : 1 / eta_;
  const std::optional<Vector3> m = facet_between(wo, wi, eta);
  if (!m) return 0;
  const double cos_o = std::abs(dot(wo, *m)), cos_i = std::abs(dot(wi, *m));
  const double reflectance = dielectric_reflectance(cos_o, eta), seen = facets_.seen_density(wo, *m);
  if (wo.z * wi.z > 0) return reflectance * seen / (4 * cos_o);
  const double bend = dot(wi, *m) + dot(wo, *m) / eta;
  return (1 - reflectance) * seen * cos_i / (bend * bend);
}

std::optional<BsdfSample> Bsdf::sample_dielectric(Vector3 wo, double choice, double u, double v) const {
  const double eta = wo.z > 0 ? eta_ : 1 / eta_;
  const Vector3 m =
      mirror_ ? Vector3{0, 0, std::copysign(1.0, wo.z)} : facing(facets_.sample_seen(wo, u, v), wo);
  const double cos = std::abs(dot(wo, m)), reflectance = dielectric_reflectance(cos, eta);
  BsdfSample sample;
  sample.mirror = mirror_;
  const auto reflectance_of = [&](float lane_eta) {
    const double inside = static_cast<double>(lane_eta);
    return dielectric_reflectance(cos, wo.z > 0 ? inside : 1 / inside);
  };
  if (choice < reflectance) {
    sample.wi = reflected(wo, m);
    sample.weight = disperses_
                        ? mapped(first_, [&](float each) { return reflectance_of(each) / reflectance; })
                        : Lanes::all(1);
  } else {
    const std::optional<Vector3> wi = refracted(wo, m, eta);
    if (!wi) return {};
    sample.wi = *wi;
    sample.transmitted = true;
    sample.index_ratio = eta;
    // Radiance shrinks by eta²; only the hero wavelength goes exactly this way if the glass disperses.
    sample.weight =
        disperses_ ? only(hero_, static_cast<float>(1 / (eta * eta))) : Lanes::all(1 / (eta * eta));
  }
  if (mirror_) return sample;
  if (sample.wi.z == 0 || (sample.wi.z * wo.z > 0) == sample.transmitted) return {};
  sample.pdf = dielectric_pdf(wo, sample.wi);
  if (!(sample.pdf > 0)) return {};
  const double masking = facets_.shown(wo, sample.wi) * (1 + facets_.lambda(wo));
  sample.weight *= masking;
  return sample;
}

}  // namespace petzval::render
