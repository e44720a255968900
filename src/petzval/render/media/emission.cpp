// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/render/media/emission.h>

#include <cmath>

namespace petzval::render {

namespace {

constexpr double hc_over_k = 1.438776877e7;  // nm·K
constexpr double coldest = 100;              // K: pbrt-v4's

/// Planck's law by x = hc/(λkT), up to a factor.
double planck(double x) {
  return x * x * x * x * x / std::expm1(x);
}

}  // namespace

Temperatures::Temperatures(GridSamples samples, double offset, double scale, const WavelengthGroups& groups)
    : samples_(std::move(samples)),
      offset_(offset),
      scale_(scale),
      exponents_(groups.sampled([](double nm) { return hc_over_k / nm; })) {}

Lanes Temperatures::radiance(const UnitPlace& place, int group) const {
  const double kelvin = (samples_.at(place) - offset_) * scale_;
  if (!(kelvin > coldest)) return Lanes::all(0);
  // Where it is strongest over wavelengths (Wien's displacement law).
  static const double strongest = planck(4.965114231744276);
  return mapped(exponents_[static_cast<std::size_t>(group)], [&](float exponent) {
    constexpr double far_beyond = 500;  // the exponential is not for more
    const double x = static_cast<double>(exponent) / kelvin;
    return x < far_beyond ? planck(x) / strongest : 0.0;
  });
}

Lanes Emission::at(const UnitPlace& place, int group) const {
  const double times = strength ? strength->at(place) : 1;
  if (!(times > 0)) return Lanes::all(0);
  const Lanes light = times * radiance[static_cast<std::size_t>(group)];
  if (colours) return light * colours->at(place, group);
  return temperatures ? light * temperatures->radiance(place, group) : light;
}

}  // namespace petzval::render
