// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/render/materials/bsdf.h>
#include <petzval/render/materials/sheen.h>

namespace petzval::render {

void Bsdf::cover(const Sheen& sheen, const Lanes& colour, double alpha) {
  sheen_ = &sheen;
  sheen_colour_ = colour;
  sheen_alpha_ = alpha;
}

/// By the colour's largest part, so that what is below keeps its own.
double Bsdf::left_by_sheen(Vector3 wo, Vector3 wi) const {
  const double taken =
      std::max(sheen_->albedo(std::abs(wo.z), sheen_alpha_), sheen_->albedo(std::abs(wi.z), sheen_alpha_));
  return 1 - static_cast<double>(sheen_colour_.largest()) * taken;
}

/// How often the fibres are followed.
double Bsdf::sheen_share(Vector3 wo) const {
  const double taken = sheen_->albedo(std::abs(wo.z), sheen_alpha_);
  return std::clamp(static_cast<double>(sheen_colour_.largest()) * taken, 0.1, 0.9);
}

Lanes Bsdf::value(Vector3 wo, Vector3 wi) const {
  if (!sheen_) return bare_value(wo, wi);
  if (!(wo.z * wi.z > 0)) return Lanes::all(0);
  return left_by_sheen(wo, wi) * bare_value(wo, wi) + sheen_->value(wo, wi, sheen_alpha_) * sheen_colour_;
}

double Bsdf::pdf(Vector3 wo, Vector3 wi) const {
  if (!sheen_) return bare_pdf(wo, wi);
  if (!(wo.z * wi.z > 0)) return 0;
  const double share = sheen_share(wo);
  return share * std::abs(wi.z) / pi + (1 - share) * bare_pdf(wo, wi);
}

std::optional<BsdfSample> Bsdf::sample(Vector3 wo, double choice, double u, double v) const {
  if (!sheen_) return bare_sample(wo, choice, u, v);
  if (wo.z == 0) return {};
  const double share = sheen_share(wo);
  BsdfSample result;
  if (choice < share) {
    result.wi = sample_cosine(u, v);
    if (wo.z < 0) result.wi.z = -result.wi.z;
  } else {
    const auto below = bare_sample(wo, (choice - share) / (1 - share), u, v);
    if (!below) return {};
    result = *below;
    if (result.mirror) {
      result.weight *= left_by_sheen(wo, result.wi) / (1 - share);
      return result;
    }
  }
  result.pdf = pdf(wo, result.wi);
  if (!(result.pdf > 0)) return {};
  result.weight = std::abs(result.wi.z) / result.pdf * value(wo, result.wi);
  return result;
}

Lanes Bsdf::albedo() const {
  if (!sheen_) return bare_albedo();
  const Vector3 facing{0, 0, 1};
  return left_by_sheen(facing, facing) * bare_albedo() + sheen_->albedo(1, sheen_alpha_) * sheen_colour_;
}

}  // namespace petzval::render
