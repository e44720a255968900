// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/render/media/diffuse_albedo.h>
#include <petzval/render/media/grid_reader.h>
#include <petzval/render/media/varied_medium.h>

#include <algorithm>
#include <cmath>

namespace petzval::render {

namespace {

/// The colour is nearly straight in the root of what is absorbed, so that few steps do.
constexpr int steps = 100;
/// Of a texture, which nobody has checked beforehand.
constexpr double most_forward = 0.999;

double possible(double coefficient) {
  return coefficient >= 0 ? std::min(coefficient, densest) : 0;
}

}  // namespace

AlbedoTable::AlbedoTable(double eta) {
  for (int i = 0; i <= steps; ++i) {
    const double root = 1 - static_cast<double>(i) / steps;
    reflectances_.push_back(i == 0 ? 0 : i == steps ? 1 : diffuse_albedo(1 - root * root, eta));
  }
}

double AlbedoTable::scattering_albedo(double reflectance, double g) const {
  if (reflectance >= 1) return 1;
  if (!(reflectance > 0)) return 0;
  const auto above = std::upper_bound(reflectances_.begin() + 1, reflectances_.end() - 1, reflectance);
  const double end = *above, begin = *(above - 1);
  const double at =
      static_cast<double>(above - 1 - reflectances_.begin()) + (reflectance - begin) / (end - begin);
  const double root = 1 - at / steps, even = 1 - root * root;
  return even / (1 - g + even * g);
}

Medium VariedMedium::at(const TexturePoint& point, int group) const {
  const auto which = static_cast<std::size_t>(group);
  Medium medium;
  medium.scatters = true;
  medium.g = std::clamp(g->at(point, group), -most_forward, most_forward);
  medium.angle_shares = AngleShares(medium.g);
  medium.absorption.resize(which + 1), medium.scattering.resize(which + 1);
  Lanes &absorbed = medium.absorption[which], &scattered = medium.scattering[which];
  const double times = std::max(0.0, scale->at(point, group));
  if (!reflectance) {
    const auto coefficient = [&](const SpectrumTexture& texture, const BandSpectrum& constant) {
      return mapped(texture ? texture->at(point, group) : constant[which],
                    [&](float each) { return possible(times * static_cast<double>(each)); });
    };
    absorbed = coefficient(absorption, coefficients[0]);
    scattered = coefficient(scattering, coefficients[1]);
    return medium;
  }
  const Lanes colour = reflectance->at(point, group), free = mfp->at(point, group);
  for (int lane = 0; lane < lane_count; ++lane) {
    const double albedo = albedos[which][static_cast<std::size_t>(lane)]->scattering_albedo(
        static_cast<double>(colour[lane]), medium.g);
    const double extinction = 1 / std::max(1 / densest, times * static_cast<double>(free[lane]));
    scattered[lane] = static_cast<float>(albedo * extinction);
    absorbed[lane] = static_cast<float>((1 - albedo) * extinction);
  }
  return medium;
}

}  // namespace petzval::render
