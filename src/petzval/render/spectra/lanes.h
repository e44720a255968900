// SPDX-License-Identifier: BSD-3-Clause
// The values of one quantity at the wavelengths that travel together along a path.
#pragma once

#include <algorithm>
#include <cmath>

namespace petzval::render {

/// How many wavelengths one path carries.
inline constexpr int lane_count = 8;

static_assert(lane_count == 8, "Lanes::largest() halves them three times");

/// One value a wavelength; arithmetic is lane by lane.
struct alignas(32) Lanes {
  float v[lane_count];

  static Lanes all(double value) {
    Lanes result;
    for (float& lane : result.v) lane = static_cast<float>(value);
    return result;
  }
  float operator[](int lane) const { return v[lane]; }
  float& operator[](int lane) { return v[lane]; }

  Lanes& operator+=(const Lanes& o) {
    for (int i = 0; i < lane_count; ++i) v[i] += o.v[i];
    return *this;
  }
  Lanes& operator*=(const Lanes& o) {
    for (int i = 0; i < lane_count; ++i) v[i] *= o.v[i];
    return *this;
  }
  Lanes& operator*=(double factor) {
    for (float& lane : v) lane *= static_cast<float>(factor);
    return *this;
  }
  friend Lanes operator+(Lanes a, const Lanes& b) { return a += b; }
  friend Lanes operator*(Lanes a, const Lanes& b) { return a *= b; }
  friend Lanes operator*(double factor, Lanes a) { return a *= factor; }

  float largest() const {
    float half[lane_count / 2];
    for (int i = 0; i < lane_count / 2; ++i) half[i] = std::max(v[i], v[i + lane_count / 2]);
    return std::max(std::max(half[0], half[2]), std::max(half[1], half[3]));
  }
  bool is_black() const { return !(largest() > 0); }
};

/// Lane by lane, f(value).
template <class Function>
Lanes mapped(const Lanes& a, Function&& f) {
  Lanes result;
  for (int i = 0; i < lane_count; ++i) result.v[i] = static_cast<float>(f(a.v[i]));
  return result;
}

/// Zero but in one lane.
inline Lanes only(int lane, float value) {
  Lanes result = Lanes::all(0);
  result[lane] = value;
  return result;
}

}  // namespace petzval::render
