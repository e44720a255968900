// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/colour/band_light.h>
#include <petzval/colour/illuminants.h>
#include <petzval/colour/observer.h>
#include <petzval/colour/reflectance_colour.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/colour/reflectance_colour.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using ColourLanes = hn::CappedTag<double, 8>;
using ColourVector = hn::Vec<ColourLanes>;

/// A sigmoid's argument at each wavelength of a vector.
struct Sigmoid {
  ColourVector c0, c1, c2;

  HWY_ATTR explicit Sigmoid(const SigmoidReflectance& of)
      : c0(hn::Set(ColourLanes(), of.c0)),
        c1(hn::Set(ColourLanes(), of.c1)),
        c2(hn::Set(ColourLanes(), of.c2)) {}
  HWY_ATTR HWY_INLINE ColourVector at(ColourVector t) const {
    return hn::MulAdd(t, hn::MulAdd(t, c0, c1), c2);
  }
};

/// 1 / √(1 + x²)
HWY_ATTR HWY_INLINE ColourVector per_root(ColourVector x) {
  const auto one = hn::Set(ColourLanes(), 1.0);
  return hn::Div(one, hn::Sqrt(hn::MulAdd(x, x, one)));
}

/// Σ of weights times a reflectance of finite coefficients. \param count  of wavelengths, in whole vectors.
HWY_ATTR double sum_of(const SigmoidReflectance& reflectance, const double* t, const double* weights,
                       std::size_t count) {
  const ColourLanes d;
  const Sigmoid sigmoid(reflectance);
  const auto half = hn::Set(d, 0.5);
  auto sum = hn::Zero(d);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto x = sigmoid.at(hn::LoadU(d, t + i));
    const auto value = hn::MulAdd(hn::Mul(half, x), per_root(x), half);
    sum = hn::MulAdd(hn::LoadU(d, weights + i), value, sum);
  }
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

/// ReflectanceColour::with_slope(): each value of XYZ, then its three slopes. \param xyz  weights.
HWY_ATTR void with_slope(const SigmoidReflectance& reflectance, const double* t,
                         const std::array<const double*, 3>& xyz, std::size_t count,
                         std::array<std::array<double, 4>, 3>& result) {
  const ColourLanes d;
  const Sigmoid sigmoid(reflectance);
  const auto half = hn::Set(d, 0.5);
  ColourVector sums[3][4];
  for (auto& row : sums)
    for (ColourVector& sum : row) sum = hn::Zero(d);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto at = hn::LoadU(d, t + i), x = sigmoid.at(at), inverse = per_root(x);
    const auto value = hn::MulAdd(hn::Mul(half, x), inverse, half),
               slope = hn::Mul(half, hn::Mul(inverse, hn::Mul(inverse, inverse)));
    for (std::size_t k = 0; k < 3; ++k) {
      const auto weight = hn::LoadU(d, xyz[k] + i);
      const auto by_c2 = hn::Mul(slope, weight), by_c1 = hn::Mul(by_c2, at);
      sums[k][0] = hn::MulAdd(value, weight, sums[k][0]);
      sums[k][1] = hn::MulAdd(by_c1, at, sums[k][1]);
      sums[k][2] = hn::Add(by_c1, sums[k][2]);
      sums[k][3] = hn::Add(by_c2, sums[k][3]);
    }
  }
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 4; ++i) result[k][i] = hn::GetLane(hn::SumOfLanes(d, sums[k][i]));
}

}  // namespace
}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(sum_of);
HWY_EXPORT(with_slope);

namespace {

/// Vectors hold no more doubles.
constexpr std::size_t most_lanes = 8;

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
    const Xyz seen = (power[i] / white.y) * weights[i], adapted = adaptation * seen;
    t_.push_back((nm[i] - SigmoidReflectance::first_nm) / SigmoidReflectance::range_nm);
    x_.push_back(adapted.x), y_.push_back(adapted.y), z_.push_back(adapted.z);
    luminous_.push_back(seen.y);
  }
  const std::size_t whole = (nm.size() + most_lanes - 1) / most_lanes * most_lanes;
  for (std::vector<double>* values : {&t_, &x_, &y_, &z_, &luminous_}) values->resize(whole);
}

const ReflectanceColour& ReflectanceColour::d65() {
  static const ReflectanceColour colour(illuminant("D65"));
  return colour;
}

LinearRgb ReflectanceColour::operator()(const SigmoidReflectance& reflectance) const {
  const auto sum = [&](const std::vector<double>& weights) { return weighted(reflectance, weights); };
  return linear_srgb({sum(x_), sum(y_), sum(z_)});
}

double ReflectanceColour::luminous_reflectance(const SigmoidReflectance& reflectance) const {
  return weighted(reflectance, luminous_);
}

double ReflectanceColour::weighted(const SigmoidReflectance& reflectance,
                                   const std::vector<double>& weights) const {
  // A grey may have an infinite coefficient, and is the same at all wavelengths.
  if (reflectance.c0 == 0 && reflectance.c1 == 0)
    return SigmoidReflectance::sigmoid(reflectance.c2) * std::accumulate(weights.begin(), weights.end(), 0.0);
  return HWY_DYNAMIC_DISPATCH(sum_of)(reflectance, t_.data(), weights.data(), t_.size());
}

ReflectanceColour::WithSlope ReflectanceColour::with_slope(double c0, double c1, double c2) const {
  std::array<std::array<double, 4>, 3> sums{};
  HWY_DYNAMIC_DISPATCH(with_slope)
  ({c0, c1, c2}, t_.data(), {x_.data(), y_.data(), z_.data()}, t_.size(), sums);
  WithSlope result;
  for (std::size_t i = 0; i < 3; ++i) {
    result.xyz[i] = sums[i][0];
    std::copy(sums[i].begin() + 1, sums[i].end(), result.slope[i].begin());
  }
  return result;
}

}  // namespace petzval
#endif
