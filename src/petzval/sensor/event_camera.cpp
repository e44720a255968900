// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/numeric/random.h>
#include <petzval/sensor/event_camera.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace petzval {

namespace {

// What random numbers are for; no other part of a sensor uses these.
constexpr std::uint32_t mismatch_purpose = 32, noise_purpose = 33;
constexpr int noise_shift = 8;

/// The photoreceptor while its light changes in a straight line.
class Receptor {
 public:
  Receptor(double level, double input, double slope, double time_constant_s)
      : tau_(time_constant_s), level_(level), input_(input), slope_(slope) {}

  /// τ y' = x − y, x = input + slope·s: solved exactly.
  double at(double s) const {
    if (tau_ == 0) return input_ + slope_ * s;
    const double behind = input_ - slope_ * tau_;
    return behind + slope_ * s + (level_ - behind) * std::exp(-s / tau_);
  }
  /// Where it turns between two instants, or the later one: from either side of it the level is monotone.
  double turn(double from, double to) const {
    if (tau_ == 0 || slope_ == 0) return to;
    const double behind = input_ - slope_ * tau_, ratio = (level_ - behind) / (slope_ * tau_);
    if (!(ratio > 0)) return to;
    const double s = tau_ * std::log(ratio);
    return s > from && s < to ? s : to;
  }
  /// When a monotone piece comes to this level.
  double when(double wanted, double from, double to) const {
    if (tau_ == 0) return std::clamp((wanted - input_) / slope_, from, to);
    const bool rises = at(to) > at(from);
    constexpr int halvings = 60;
    for (int i = 0; i < halvings; ++i) {
      const double middle = (from + to) / 2;
      ((at(middle) < wanted) == rises ? from : to) = middle;
    }
    return to;
  }

 private:
  double tau_, level_, input_, slope_;
};

}  // namespace

void EventCameraOptions::validate() const {
  if (!(threshold_on > 0 && threshold_off > 0))
    throw InputError(fmt::format("contrast thresholds of {:g} and {:g}; numbers above 0 would be right",
                                 threshold_on, threshold_off));
  for (const double amount : {threshold_mismatch, time_constant_s, refractory_s, noise_per_s})
    if (!(amount >= 0 && std::isfinite(amount)))
      throw InputError(fmt::format(
          "an event camera with a mismatch, time or rate of {:g}; 0 or more would be right", amount));
  if (!(dark_e_per_s > 0))
    throw InputError(fmt::format("a dark current of {:g} e/s; above 0 would be right", dark_e_per_s));
}

EventCamera::EventCamera(const EventCameraOptions& options) : options_(options) {
  options.validate();
}

void EventCamera::draw_noise(Pixel& pixel, std::uint64_t place) const {
  if (options_.noise_per_s == 0) return;
  RandomStream random(options_.seed, noise_purpose | pixel.noise_events << noise_shift, place);
  pixel.next_noise += -std::log(random.uniform()) / options_.noise_per_s;
}

void EventCamera::begin(double t_s, const PhotoCurrent& current) {
  pixels_.resize(current.e_per_s.size());
  constexpr double least_threshold = 0.01;  // of the nominal one: a mismatched pixel still compares
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    double share = 1;
    if (options_.threshold_mismatch > 0)
      share += options_.threshold_mismatch * RandomStream(options_.serial, mismatch_purpose, i).normal();
    share = std::max(least_threshold, share);
    const double level = static_cast<double>(current.e_per_s[i]) + options_.dark_e_per_s;
    pixels_[i] = {level,
                  level,
                  -INFINITY,
                  std::exp(share * options_.threshold_on),
                  std::exp(-share * options_.threshold_off),
                  options_.noise_per_s > 0 ? t_s : INFINITY,
                  0};
    draw_noise(pixels_[i], i);
  }
}

void EventCamera::follow(Pixel& pixel, const Stretch& light, int row, int column,
                         std::vector<Event>& events) const {
  const double length = light.to_s - light.from_s;
  const Receptor receptor(pixel.level, light.before, (light.after - light.before) / length,
                          options_.time_constant_s);
  double now = 0;
  while (now < length) {
    if (const double rest = pixel.resting_until - light.from_s; rest > now) {
      if (rest > length) break;
      // Out of reset: from here the pixel compares.
      now = std::max(now, rest);
      pixel.reference = receptor.at(now);
    }
    const double piece = receptor.turn(now, length);
    const double up = pixel.reference * pixel.rise, down = pixel.reference * pixel.fall;
    const double end = receptor.at(piece);
    const bool brighter = end >= up;
    if (!brighter && end > down) {
      now = piece;
      continue;
    }
    now = receptor.when(brighter ? up : down, now, piece);
    const double t_s = light.from_s + now;
    events.push_back({t_s, column, row, brighter});
    pixel.reference = brighter ? up : down;
    pixel.resting_until = options_.refractory_s > 0 ? t_s + options_.refractory_s : -INFINITY;
  }
  pixel.level = receptor.at(length);
}

std::vector<Event> EventCamera::see(double t_s, const PhotoCurrent& current) {
  if (!begun_) {
    begin(t_s, current);
    begun_ = true;
    last_s_ = t_s;
    last_ = current;
    return {};
  }
  if (current.e_per_s.size() != pixels_.size() || !(t_s > last_s_))
    throw InputError("an event camera sees frames of one size, each later than the last");
  const auto columns = static_cast<std::size_t>(current.columns);
  std::vector<std::vector<Event>> by_row(static_cast<std::size_t>(current.rows));
  parallel_for(by_row.size(), [&](std::size_t row) {
    for (std::size_t c = 0; c < columns; ++c) {
      const std::size_t i = row * columns + c;
      Pixel& pixel = pixels_[i];
      follow(pixel,
             {last_s_, t_s, static_cast<double>(last_.e_per_s[i]) + options_.dark_e_per_s,
              static_cast<double>(current.e_per_s[i]) + options_.dark_e_per_s},
             static_cast<int>(row), static_cast<int>(c), by_row[row]);
      while (pixel.next_noise <= t_s) {
        RandomStream random(options_.seed, noise_purpose | pixel.noise_events << noise_shift, i);
        random.uniform();  // which drew the time
        by_row[row].push_back(
            {pixel.next_noise, static_cast<int>(c), static_cast<int>(row), random.uniform() < 0.5});
        ++pixel.noise_events;
        draw_noise(pixel, i);
      }
    }
  });
  std::vector<Event> events;
  for (const std::vector<Event>& row : by_row) events.insert(events.end(), row.begin(), row.end());
  std::ranges::sort(events, {},
                    [](const Event& e) { return std::tuple(e.t_s, e.row, e.column, e.brighter); });
  last_s_ = t_s;
  last_ = current;
  return events;
}

}  // namespace petzval
