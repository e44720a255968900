// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/optics/formats/measured_psf.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// Steps of one axis are equal to this share of a step, and a sample this near to a place stands on it.
constexpr double step_tolerance = 1e-3;
constexpr double most_side = 4096;

struct Axis {
  double first_mm = 0, step_mm = 0;
  std::size_t count = 0;
};

Axis axis_of(std::vector<double> places_mm, const char* name) {
  std::sort(places_mm.begin(), places_mm.end());
  const double extent = places_mm.back() - places_mm.front();
  // Places that differ by less than any grid's step are one place, printed twice.
  const double same = extent / most_side * step_tolerance;
  places_mm.erase(std::unique(places_mm.begin(), places_mm.end(),
                              [same](double a, double b) { return std::abs(a - b) <= same; }),
                  places_mm.end());
  if (places_mm.size() < 2 || double(places_mm.size()) > most_side)
    throw InputError(
        fmt::format("has samples at {} places along {}; a grid of 2 to {:g} a side would be right",
                    places_mm.size(), name, most_side));
  const double step = extent / double(places_mm.size() - 1);
  for (std::size_t i = 0; i < places_mm.size(); ++i)
    if (std::abs(places_mm[i] - places_mm.front() - double(i) * step) > step_tolerance * step)
      throw InputError(
          fmt::format("has no even steps along {}: {} mm, {} mm …", name, places_mm[0], places_mm[1]));
  return {places_mm.front(), step, places_mm.size()};
}

/// The sample of a place along an axis of a PSF: a whole number where it stands on one.
double place_of(double mm, double step_mm) {
  const double place = mm / step_mm, whole = std::round(place);
  return std::abs(place - whole) <= step_tolerance ? whole : place;
}

}  // namespace

Psf psf_of_samples(const std::vector<MeasuredSample>& samples, bool clip_negative) {
  std::vector<double> xs, ys;
  for (const MeasuredSample& sample : samples) {
    if (sample.value < 0 && !clip_negative)
      throw InputError(
          fmt::format("has a value of {} at x = {} mm, y = {} mm; light is not negative "
                      "(`clip_negative` takes it for noise)",
                      sample.value, sample.x_mm, sample.y_mm));
    xs.push_back(sample.x_mm);
    ys.push_back(sample.y_mm);
  }
  const Axis x = axis_of(std::move(xs), "x"), y = axis_of(std::move(ys), "y");
  if (x.count * y.count != samples.size())
    throw InputError(fmt::format("has {} samples; {} places along x and {} along y make {}", samples.size(),
                                 x.count, y.count, x.count * y.count));
  if (std::abs(x.step_mm - y.step_mm) > step_tolerance * x.step_mm)
    throw InputError(fmt::format("has steps of {} mm along x and {} mm along y; they must be equal",
                                 x.step_mm, y.step_mm));
  double reach = 0;
  for (const Axis& axis : {x, y})
    reach = std::max(
        {reach, std::abs(axis.first_mm), std::abs(axis.first_mm + double(axis.count - 1) * axis.step_mm)});
  const double half = std::ceil(reach / x.step_mm - step_tolerance);
  if (half > most_side / 2)
    throw InputError(
        fmt::format("reaches {} mm from its chief ray in steps of {} mm: {:g} samples a side are too "
                    "many",
                    reach, x.step_mm, 2 * half + 1));
  Psf psf;
  psf.size = 2 * static_cast<int>(half) + 1;
  psf.spacing_um = x.step_mm * um_per_mm;
  std::vector<double> values(static_cast<std::size_t>(psf.size) * static_cast<std::size_t>(psf.size), 0.0);
  double sum = 0;
  for (const MeasuredSample& sample : samples) {
    const double value = std::max(sample.value, 0.0);
    const double s = place_of(sample.x_mm, x.step_mm) + half, t = place_of(sample.y_mm, x.step_mm) + half;
    const double row = std::floor(t), column = std::floor(s);
    for (const int down : {0, 1})
      for (const int right : {0, 1}) {
        const double share = (down ? t - row : 1 - t + row) * (right ? s - column : 1 - s + column);
        if (share <= 0) continue;
        const auto index = (static_cast<std::size_t>(row) + static_cast<std::size_t>(down)) *
                               static_cast<std::size_t>(psf.size) +
                           static_cast<std::size_t>(column) + static_cast<std::size_t>(right);
        values[index] += share * value;
      }
    sum += value;
  }
  if (!(sum > 0)) throw InputError("has no light");
  for (const double value : values) psf.values.push_back(static_cast<float>(value / sum));
  return psf;
}

}  // namespace petzval
