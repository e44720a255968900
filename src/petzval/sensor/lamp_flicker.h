// SPDX-License-Identifier: BSD-3-Clause
// Lamps whose light goes up and down with the mains, or is switched.
#pragma once

#include <string_view>

namespace petzval {

/// How the light of a lamp changes with time, relative to its mean:
///
///     LampFlicker::mains(50, 0.4).at(t_s)   // 1 + 0.4 cos(2π · 100 Hz · t)
///     LampFlicker::pwm(1000, 0.25).at(t_s)  // 4 in the first quarter of each millisecond, else 0
class LampFlicker {
 public:
  /// No flicker.
  LampFlicker() = default;
  /// A lamp on alternating current: its light follows the power, at twice the frequency of the mains.
  /// \param depth  (greatest − least)/(greatest + least), 0 to 1: the "percent flicker" of the lighting trade
  ///   (IEEE 1789-2015). \param phase  in periods of the light. \throws InputError for what is out of range.
  static LampFlicker mains(double mains_hz, double depth, double phase = 0);
  /// An LED that is switched: on for the share `duty` of each period, above 0 up to 1. \throws InputError.
  static LampFlicker pwm(double frequency_hz, double duty, double phase = 0);
  /// "none", "mains:HZ:DEPTH" or "pwm:HZ:DUTY", each with ":PHASE" behind it if wanted. \throws InputError.
  static LampFlicker parse(std::string_view text);

  bool is_steady() const { return kind_ == Kind::steady; }
  /// Of the light; 0 for a steady one.
  double frequency_hz() const { return frequency_hz_; }
  double at(double t_s) const;

  /// Integrals of the light from one instant to another, in closed form.
  struct Moments {
    double light = 0;       ///< ∫ m dt [s]
    double light_time = 0;  ///< ∫ m (t − from) dt [s²]
  };
  Moments moments(double from_s, double to_s) const;

 private:
  enum class Kind { steady, cosine, switched };
  Kind kind_ = Kind::steady;
  double frequency_hz_ = 0, amount_ = 0, phase_ = 0;  ///< amount: depth or duty
};

}  // namespace petzval
