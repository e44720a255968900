// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/sensor/timed_exposure.h>

#include <algorithm>

namespace petzval {

TimedExposure::Shares TimedExposure::shares(int row, double t0_s, double t1_s) const {
  const double open = timing_.row_start_s(row);
  const double from = std::max(t0_s, open), to = std::min(t1_s, open + timing_.exposure_s);
  if (!(to > from)) return {};
  // ∫ m and ∫ m (t − t0)/(t1 − t0) over the part of the window that lies here.
  const LampFlicker::Moments moments = flicker_.moments(from, to);
  const double of_t1 = (moments.light_time + (from - t0_s) * moments.light) / (t1_s - t0_s);
  return {moments.light - of_t1, of_t1};
}

void TimedExposure::add(double t0_s, const PhotoCurrent& at_t0, double t1_s, const PhotoCurrent& at_t1) {
  if (electrons_.empty()) {
    frame_ = {at_t0.columns, at_t0.rows, at_t0.first_column, at_t0.first_row, {}};
    electrons_.resize(at_t0.e_per_s.size());
  }
  if (at_t0.e_per_s.size() != electrons_.size() || at_t1.e_per_s.size() != electrons_.size() ||
      at_t1.columns != frame_.columns || !(t1_s > t0_s))
    throw InputError("the light of an exposure must be of one frame, and each instant later than the last");
  const auto columns = static_cast<std::size_t>(frame_.columns);
  parallel_for(static_cast<std::size_t>(frame_.rows), [&](std::size_t row) {
    const auto [of_t0, of_t1] = shares(static_cast<int>(row), t0_s, t1_s);
    if (of_t0 == 0 && of_t1 == 0) return;
    const float *before = at_t0.e_per_s.data() + row * columns, *after = at_t1.e_per_s.data() + row * columns;
    double* electrons = electrons_.data() + row * columns;
    for (std::size_t c = 0; c < columns; ++c)
      electrons[c] += of_t0 * static_cast<double>(before[c]) + of_t1 * static_cast<double>(after[c]);
  });
}

PhotoCurrent TimedExposure::mean_current() const {
  PhotoCurrent mean = frame_;
  mean.e_per_s.resize(electrons_.size());
  std::ranges::transform(electrons_, mean.e_per_s.begin(), [&](double electrons) {
    return static_cast<float>(std::max(0.0, electrons) / timing_.exposure_s);
  });
  return mean;
}

}  // namespace petzval
