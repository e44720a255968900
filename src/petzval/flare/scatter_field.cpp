// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/flare/scatter_field.h>

#include <algorithm>
#include <cmath>

namespace petzval {

ScatterField::ScatterField(const ScatterTracer& tracer, const BrightSource& source,
                           const SensorGeometry& frame, double reach, int across)
    : half_width_mm_(reach * frame.width_mm() / 2),
      half_height_mm_(reach * frame.height_mm() / 2),
      fields_(tracer.surface_count()) {
  const std::vector<std::vector<LitPlace>> lit = tracer.light(SourceBeam(source), across, &image_);
  const std::size_t nodes = side * side;
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    fields_[i].nodes.resize(nodes);
    fields_[i].lit = !lit[i].empty();
    double before = 0, after = 0;
    for (const LitPlace& place : lit[i]) before += place.cosine_before, after += place.cosine_after;
    if (!fields_[i].lit) continue;
    fields_[i].cosine_before = before / static_cast<double>(lit[i].size());
    fields_[i].cosine_after = after / static_cast<double>(lit[i].size());
  }
  parallel_for(fields_.size() * nodes, [&](std::size_t item) {
    const std::size_t surface = item / nodes, at = item % nodes;
    const double x = half_width_mm_ * (2.0 * static_cast<double>(at % side) / (side - 1) - 1),
                 y = half_height_mm_ * (2.0 * static_cast<double>(at / side) / (side - 1) - 1);
    Node& node = fields_[surface].nodes[at];
    std::array<double, 2> sum{};
    std::optional<std::array<double, 2>> guess;
    for (const LitPlace& place : lit[surface]) {
      const std::optional<ScatterLink> link = tracer.link(surface, place, x, y, guess);
      guess.reset();
      if (!link) continue;
      guess = link->direction;
      const double length = std::hypot(link->offset[0], link->offset[1]);
      const double scale = length > 0 ? link->per_mm2 * link->tau / length : 0;
      for (std::size_t k = 0; k < 2; ++k) sum[k] += scale * link->offset[k];
      node.per_mm2 += link->per_mm2;
    }
    if (node.per_mm2 > 0) node.offset = {sum[0] / node.per_mm2, sum[1] / node.per_mm2};
  });
  LensBsdfs own;
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    own.push_back(tracer.bsdf(i));
    fields_[i].offset_at_image = interpolated(fields_[i], image_.x_mm, image_.y_mm).offset;
  }
  if (const double lit_share = share(own); lit_share > 0 && image_.clear_flux_mm2 > 0)
    imaged_over_lit_ = image_.scattered_share() / lit_share;
}

ScatterField::Node ScatterField::interpolated(const SurfaceField& field, double x_mm, double y_mm) const {
  const auto place = [](double value, double half) {
    return std::clamp((value / half + 1) / 2 * (side - 1), 0.0, side - 1.0);
  };
  const double column = place(x_mm, half_width_mm_), row = place(y_mm, half_height_mm_);
  const std::size_t c = std::min(static_cast<std::size_t>(column), std::size_t{side - 2}),
                    r = std::min(static_cast<std::size_t>(row), std::size_t{side - 2});
  const double u = column - static_cast<double>(c), v = row - static_cast<double>(r);
  Node mean;
  double seen = 0;  // of the weights of points that any light reaches
  const auto add = [&](std::size_t i, double weight) {
    const Node& node = field.nodes[i];
    if (node.per_mm2 == 0) return;
    seen += weight;
    mean.per_mm2 += weight * node.per_mm2;
    for (std::size_t k = 0; k < 2; ++k) mean.offset[k] += weight * node.offset[k];
  };
  add(r * side + c, (1 - u) * (1 - v));
  add(r * side + c + 1, u * (1 - v));
  add((r + 1) * side + c, (1 - u) * v);
  add((r + 1) * side + c + 1, u * v);
  if (seen > 0)
    for (double& each : mean.offset) each /= seen;
  return mean;
}

ScatterShares ScatterField::shares_of(const LensBsdfs& bsdfs, std::size_t surface) const {
  return bsdfs[surface].shares(fields_[surface].cosine_before, fields_[surface].cosine_after);
}

std::vector<ScatterShares> ScatterField::shares(const LensBsdfs& bsdfs) const {
  std::vector<ScatterShares> all;
  for (std::size_t i = 0; i < fields_.size(); ++i) all.push_back(shares_of(bsdfs, i));
  return all;
}

double ScatterField::at(const LensBsdfs& bsdfs, const std::vector<ScatterShares>& shares, double x_mm,
                        double y_mm, bool about_image) const {
  double sum = 0;
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    if (!fields_[i].lit || !bsdfs[i].scatters()) continue;
    Node node = interpolated(fields_[i], x_mm, y_mm);
    if (about_image)
      for (std::size_t k = 0; k < 2; ++k) node.offset[k] -= fields_[i].offset_at_image[k];
    sum += node.per_mm2 * bsdfs[i].at(shares[i], std::hypot(node.offset[0], node.offset[1]));
  }
  return sum;
}

double ScatterField::core(const LensBsdfs& bsdfs, double radius_mm) const {
  double sum = 0;
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    if (!fields_[i].lit || !bsdfs[i].scatters()) continue;
    double tau = 0;
    constexpr int azimuths = 4;
    for (int k = 0; k < azimuths; ++k) {
      const double angle = 2 * pi * k / azimuths;
      const Node node = interpolated(fields_[i], image_.x_mm + radius_mm * std::cos(angle),
                                     image_.y_mm + radius_mm * std::sin(angle));
      tau += std::hypot(node.offset[0] - fields_[i].offset_at_image[0],
                        node.offset[1] - fields_[i].offset_at_image[1]) /
             azimuths;
    }
    if (!(tau > 0)) continue;
    const double per_mm2 = interpolated(fields_[i], image_.x_mm, image_.y_mm).per_mm2;
    sum += per_mm2 * bsdfs[i].within(shares_of(bsdfs, i), tau) / (pi * tau * tau);
  }
  return sum;
}

double ScatterField::share(const LensBsdfs& bsdfs) const {
  double kept = 1;
  for (std::size_t i = 0; i < fields_.size(); ++i)
    if (bsdfs[i].scatters()) kept *= shares_of(bsdfs, i).specular();
  return imaged_over_lit_ * (1 - kept);
}

}  // namespace petzval
