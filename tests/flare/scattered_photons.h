// SPDX-License-Identifier: BSD-3-Clause
// A second way to scattered light, written without the code that it tests: photons that one surface of a lens
// turns aside at random.
#pragma once

#include <petzval/lens/lens.h>

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "physics/reflected_photons.h"

namespace petzval::test {

class ScatteringLens {
 public:
  using V = std::array<double, 3>;

  ScatteringLens(const Lens& lens, double wavelength_nm) : glass_(lens, wavelength_nm) {
    index_.push_back(1);
    for (const Surface& surface : lens.surfaces) {
      index_.push_back(surface.material.index(wavelength_nm));
      image_z_ += surface.thickness_mm;
    }
  }

  /// Through the lens, turned aside at one surface (none: at its number of surfaces) by n sin θ of
  /// b (1 + (τ/l)²)^(s/2), τ ≤ 1, drawn from the closed form of its sum. \return the place on the sensor.
  template <class Random>
  std::optional<std::array<double, 2>> follow(V at, V along, std::size_t surface, double l, double s,
                                              Random& random) const {
    for (std::size_t i = 0; i < glass_.count(); ++i) {
      V normal;
      if (!glass_.go_to(i, at, along, normal) || !glass_.is_open(i, at[0], at[1])) return {};
      const double length = std::sqrt(dot(normal, normal));
      for (double& each : normal) each /= length;
      const double cosine = dot(along, normal), r = index_[i] / index_[i + 1];
      const double under = 1 - r * r * (1 - cosine * cosine);
      if (under < 0) return {};
      const double bend = std::sqrt(under) - r * cosine;
      for (int k = 0; k < 3; ++k) along[k] = r * along[k] + bend * normal[k];
      if (i == surface && !turn_aside(index_[i + 1], normal, l, s, random, along)) return {};
    }
    const double t = (image_z_ - at[2]) / along[2];
    if (!(along[2] > 0)) return {};
    return std::array{at[0] + t * along[0], at[1] + t * along[1]};
  }

 private:
  static double dot(const V& a, const V& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

  template <class Random>
  static bool turn_aside(double index, const V& normal, double l, double s, Random& random, V& along) {
    std::uniform_real_distribution<double> even(0, 1);
    const double all = std::pow(1 + 1 / (l * l), (s + 2) / 2) - 1;
    const double tau = l * std::sqrt(std::pow(1 + even(random) * all, 2 / (s + 2)) - 1);
    const double azimuth = 2 * std::numbers::pi * even(random);
    // Two directions along the surface.
    V first{normal[2], 0, -normal[0]};
    const double length = std::sqrt(dot(first, first));
    for (double& each : first) each /= length;
    const V second{normal[1] * first[2] - normal[2] * first[1], normal[2] * first[0] - normal[0] * first[2],
                   normal[0] * first[1] - normal[1] * first[0]};
    const double a = index * dot(along, first) + tau * std::cos(azimuth),
                 b = index * dot(along, second) + tau * std::sin(azimuth);
    const double c_sq = index * index - a * a - b * b;
    if (!(c_sq > 0)) return false;
    for (int k = 0; k < 3; ++k)
      along[k] = (a * first[k] + b * second[k] + std::sqrt(c_sq) * normal[k]) / index;
    return true;
  }

  ReflectingLens glass_;
  std::vector<double> index_;
  double image_z_ = 0;
};

}  // namespace petzval::test
