// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/colour/band_light.h>
#include <petzval/colour/illuminants.h>
#include <petzval/colour/observer.h>
#include <petzval/colour/reflectance_colour.h>

namespace petzval {

namespace {

std::vector<double> fine_bands_nm() {
  constexpr double step_nm = 5;
  std::vector<double> nm;
  for (double at = SigmoidReflectance::first_nm;
       at <= SigmoidReflectance::first_nm + SigmoidReflectance::range_nm; at += step_nm)
    nm.push_back(at);
  return nm;
}

}  // namespace

ReflectanceColour::ReflectanceColour(const Spectrum& light, std::vector<double> bands_nm) {
  const std::vector<double> nm = bands_nm.empty() ? fine_bands_nm() : std::move(bands_nm);
  const std::vector<double> power = band_light(light, nm);
  const std::vector<Xyz> weights = Observer::cie_1931().weights(nm);
  Xyz white;
  for (std::size_t i = 0; i < nm.size(); ++i) white = white + power[i] * weights[i];
  if (!(white.y > 0)) throw InputError("a light without visible power shows no colours");
  const ColourMatrix adaptation = bradford_adaptation((1 / white.y) * white, display_white());
  for (std::size_t i = 0; i < nm.size(); ++i) {
    const Xyz seen = (power[i] / white.y) * weights[i];
    samples_.push_back(
        {(nm[i] - SigmoidReflectance::first_nm) / SigmoidReflectance::range_nm, adaptation * seen, seen.y});
  }
}

const ReflectanceColour& ReflectanceColour::d65() {
  static const ReflectanceColour colour(illuminant("D65"));
  return colour;
}

LinearRgb ReflectanceColour::operator()(const SigmoidReflectance& reflectance) const {
  Xyz sum;
  for (const Sample& sample : samples_)
    sum = sum +
          reflectance.at(SigmoidReflectance::first_nm + sample.t * SigmoidReflectance::range_nm) * sample.xyz;
  return linear_srgb(sum);
}

double ReflectanceColour::luminous_reflectance(const SigmoidReflectance& reflectance) const {
  double sum = 0;
  for (const Sample& sample : samples_)
    sum += sample.luminous *
           reflectance.at(SigmoidReflectance::first_nm + sample.t * SigmoidReflectance::range_nm);
  return sum;
}

ReflectanceColour::WithSlope ReflectanceColour::with_slope(double c0, double c1, double c2) const {
  WithSlope result;
  for (const Sample& sample : samples_) {
    const double t = sample.t, x = c2 + t * (c1 + t * c0);
    const double root = std::sqrt(1 + x * x);
    const double value = 0.5 + x / (2 * root), slope = 0.5 / (root * root * root);
    const double weights[3] = {sample.xyz.x, sample.xyz.y, sample.xyz.z};
    for (std::size_t i = 0; i < 3; ++i) {
      const double by_c2 = slope * weights[i];
      result.xyz[i] += value * weights[i];
      result.slope[i][0] += by_c2 * t * t;
      result.slope[i][1] += by_c2 * t;
      result.slope[i][2] += by_c2;
    }
  }
  return result;
}

}  // namespace petzval
