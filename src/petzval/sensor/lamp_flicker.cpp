// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/units.h>
#include <petzval/sensor/lamp_flicker.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr double fastest_hz = 1e7;

void check_frequency(double hz) {
  if (!(hz > 0 && hz <= fastest_hz))
    throw InputError(
        fmt::format("a flicker of {:g} Hz; above 0 and up to {:g} would be right", hz, fastest_hz));
}

void check_phase(double phase) {
  if (!std::isfinite(phase)) throw InputError("the phase of a flicker must be a finite number of periods");
}

/// ∫₀ᵗ of a lamp that is on, at 1, in the first `duty` of each period of 1; and the integral of that.
struct SwitchedSums {
  double once, twice;
  SwitchedSums(double t, double duty) {
    const double whole = std::floor(t), part = t - whole, on = std::min(part, duty);
    once = whole * duty + on;
    const double of_a_period = duty - duty * duty / 2;
    twice = whole * of_a_period +
            duty * whole * (whole - 1) / 2  // whole periods, each on top of those before
            + whole * duty * part + on * on / 2 + duty * (part - on);
  }
};

}  // namespace

LampFlicker LampFlicker::mains(double mains_hz, double depth, double phase) {
  check_frequency(mains_hz);
  check_phase(phase);
  if (!(depth >= 0 && depth <= 1))
    throw InputError(fmt::format("a depth of flicker of {:g}; 0 to 1 would be right", depth));
  LampFlicker flicker;
  flicker.kind_ = Kind::cosine;
  flicker.frequency_hz_ = 2 * mains_hz;
  flicker.amount_ = depth;
  flicker.phase_ = phase;
  return flicker;
}

LampFlicker LampFlicker::pwm(double frequency_hz, double duty, double phase) {
  check_frequency(frequency_hz);
  check_phase(phase);
  if (!(duty > 0 && duty <= 1))
    throw InputError(fmt::format("a duty of {:g}; above 0 and up to 1 would be right", duty));
  LampFlicker flicker;
  flicker.kind_ = Kind::switched;
  flicker.frequency_hz_ = frequency_hz;
  flicker.amount_ = duty;
  flicker.phase_ = phase;
  return flicker;
}

LampFlicker LampFlicker::parse(std::string_view text) {
  if (text == "none") return {};
  const std::vector<std::string> parts = split_at(text, ':');
  std::vector<double> numbers;
  for (std::size_t i = 1; i < parts.size(); ++i)
    if (const std::optional<double> number = parse_number(parts[i])) numbers.push_back(*number);
  const bool whole = numbers.size() + 1 == parts.size() && (numbers.size() == 2 || numbers.size() == 3);
  if (!whole || (parts[0] != "mains" && parts[0] != "pwm"))
    throw InputError(fmt::format(
        "`flicker` {}: none, mains:50:0.4 (frequency of the mains, depth) or pwm:1000:0.25 (frequency, duty) "
        "would be right, with :PHASE behind it if wanted",
        quotable(text)));
  const double phase = numbers.size() == 3 ? numbers[2] : 0;
  return parts[0] == "mains" ? mains(numbers[0], numbers[1], phase) : pwm(numbers[0], numbers[1], phase);
}

double LampFlicker::at(double t_s) const {
  const double turns = frequency_hz_ * t_s + phase_;
  if (kind_ == Kind::cosine) return 1 + amount_ * std::cos(2 * pi * (turns - std::floor(turns)));
  if (kind_ == Kind::switched) return turns - std::floor(turns) < amount_ ? 1 / amount_ : 0;
  return 1;
}

LampFlicker::Moments LampFlicker::moments(double from_s, double to_s) const {
  const double length = to_s - from_s;
  if (kind_ == Kind::steady) return {length, length * length / 2};
  // Counted from the beginning of the period that `from` lies in, so that late times cost no digits.
  const double turns = frequency_hz_ * from_s + phase_, begin = turns - std::floor(turns);
  const double end = begin + frequency_hz_ * length;
  if (kind_ == Kind::cosine) {
    const double w = 2 * pi * frequency_hz_, a = 2 * pi * begin, b = 2 * pi * end;
    const double first = (std::sin(b) - std::sin(a)) / w;
    // ∫ (t − from) cos = length · sin(b)/w + (cos b − cos a)/w²
    const double second = length * std::sin(b) / w + (std::cos(b) - std::cos(a)) / (w * w);
    return {length + amount_ * first, length * length / 2 + amount_ * second};
  }
  const SwitchedSums a(begin, amount_), b(end, amount_);
  const double light = (b.once - a.once) / (amount_ * frequency_hz_);
  // By parts: ∫ (t − from) m dt = length · M(to) − ∫ M dt, M counted from `from`.
  const double below =
      ((b.twice - a.twice) - a.once * (end - begin)) / (amount_ * frequency_hz_ * frequency_hz_);
  return {light, length * light - below};
}

}  // namespace petzval
