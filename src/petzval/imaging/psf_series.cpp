// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/psf_series.h>
#include <petzval/numeric/interpolation.h>

#include <cmath>

namespace petzval {

PsfSeries::PsfSeries(std::vector<double> height_mm, std::vector<SampleLattice> lattices, double step_mm)
    : height_mm_(std::move(height_mm)), lattices_(std::move(lattices)) {
  constexpr double most_bytes = 64e6, most_steps = 8;
  double bytes_a_step = 0;
  for (const SampleLattice& lattice : lattices_) {
    const double side = 2.0 * lattice.half + 1;
    bytes_a_step += side * side * sizeof(double);
  }
  if (height_mm_.size() > 1) {
    double widest_mm = 0;
    for (std::size_t i = 0; i + 1 < height_mm_.size(); ++i)
      widest_mm = std::max(widest_mm, height_mm_[i + 1] - height_mm_[i]);
    const double wanted = std::min(std::ceil(widest_mm / step_mm), most_bytes / bytes_a_step - 1);
    steps_ = static_cast<std::size_t>(std::clamp(wanted, 1.0, most_steps));
  }
  count_ = height_mm_.size() > 1 ? lattices_.size() * steps_ + 1 : 1;
  entries_ = std::make_unique<Entry[]>(count_);
}

PsfSeries::Place PsfSeries::place_of(double height_mm) const {
  if (height_mm_.size() == 1) return {0, 0};
  const double inside = std::clamp(height_mm, height_mm_.front(), height_mm_.back());
  const std::size_t interval = bracket(height_mm_, inside);
  const double low = height_mm_[interval], span = height_mm_[interval + 1] - low;
  const double at = std::clamp((inside - low) / span, 0.0, 1.0) * double(steps_);
  const std::size_t step = std::min(static_cast<std::size_t>(at), steps_ - 1);
  return {interval * steps_ + step, at - double(step)};
}

double PsfSeries::height_of(std::size_t index) const {
  const std::size_t interval = index / steps_, step = index % steps_;
  if (step == 0) return height_mm_[interval];
  return height_mm_[interval] +
         (height_mm_[interval + 1] - height_mm_[interval]) * double(step) / double(steps_);
}

}  // namespace petzval
