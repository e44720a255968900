// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/field_mixture.h>
#include <petzval/imaging/psf_series.h>
#include <petzval/numeric/interpolation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

namespace petzval {

namespace {

constexpr std::size_t most_steps = 8;

}  // namespace

PsfSeries::PsfSeries(std::vector<double> height_mm, std::vector<SampleLattice> lattices, double step_mm)
    : height_mm_(std::move(height_mm)), lattices_(std::move(lattices)) {
  constexpr double most_bytes = 64e6;
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
    steps_ = static_cast<std::size_t>(std::clamp(wanted, 1.0, double(most_steps)));
  }
  count_ = height_mm_.size() > 1 ? lattices_.size() * steps_ + 1 : 1;
  entries_ = std::make_unique<Entry[]>(count_);
}

std::array<PsfSeries::Share, 4> PsfSeries::shares_at(double height_mm) const {
  std::array<Share, 4> shares{};
  shares[0].weight = 1;
  if (height_mm_.size() == 1) return shares;
  const double inside = std::clamp(height_mm, height_mm_.front(), height_mm_.back());
  const std::size_t interval = bracket(height_mm_, inside);
  const double low = height_mm_[interval], span = height_mm_[interval + 1] - low;
  const double at = std::clamp((inside - low) / span, 0.0, 1.0) * double(steps_);
  // Counted from 1: a first place at 0 would mean the axis, and a mirrored neighbour.
  std::array<double, most_steps + 1> place{};
  std::iota(place.begin(), place.end(), 1.0);
  const auto of_places = field_shares(std::span(place).first(steps_ + 1), at + 1);
  for (std::size_t i = 0; i < shares.size(); ++i) shares[i] = {interval * steps_ + of_places[i].field, of_places[i].weight};
  // The last place has the next interval's lattice.
  std::sort(shares.begin(), shares.end(), [](const Share& a, const Share& b) { return a.index < b.index; });
  return shares;
}

double PsfSeries::height_of(std::size_t index) const {
  const std::size_t interval = index / steps_, step = index % steps_;
  if (step == 0) return height_mm_[interval];
  return height_mm_[interval] +
         (height_mm_[interval + 1] - height_mm_[interval]) * double(step) / double(steps_);
}

}  // namespace petzval
