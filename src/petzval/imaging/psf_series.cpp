// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/field_mixture.h>
#include <petzval/imaging/psf_series.h>
#include <petzval/numeric/interpolation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

namespace petzval {

namespace {

/// Mixing four of them, more changes an image by less than 1e-5 of itself.
constexpr std::size_t most_steps = 4;

/// PSFs in an interval, of every one as many.
std::size_t steps_of(const std::vector<double>& height_mm, const std::vector<double>& coefficients,
                     double step_mm) {
  constexpr double most_bytes = 64e6;
  double widest_mm = 0;
  for (std::size_t i = 0; i + 1 < height_mm.size(); ++i)
    widest_mm = std::max(widest_mm, height_mm[i + 1] - height_mm[i]);
  const double bytes_a_step = sizeof(float) * std::accumulate(coefficients.begin(), coefficients.end(), 0.0);
  const double wanted = std::min(std::ceil(widest_mm / step_mm), most_bytes / bytes_a_step - 1);
  return static_cast<std::size_t>(std::clamp(wanted, 1.0, double(most_steps)));
}

}  // namespace

PsfSeries::PsfSeries(std::vector<double> height_mm, const std::vector<double>& coefficients, double step_mm)
    : height_mm_(std::move(height_mm)) {
  if (height_mm_.size() > 1) {
    steps_ = steps_of(height_mm_, coefficients, step_mm);
    nodes_ = (height_mm_.size() - 1) * steps_ + 1;
  }
  entries_ = std::make_unique<Entry[]>(nodes_);
}

std::vector<PsfSeries::Share> PsfSeries::shares_at(double height_mm) const {
  if (height_mm_.size() == 1) return {{0, 1}};
  const double inside = std::clamp(height_mm, height_mm_.front(), height_mm_.back());
  const std::size_t interval = bracket(height_mm_, inside);
  const double low = height_mm_[interval], span = height_mm_[interval + 1] - low;
  const double at = std::clamp((inside - low) / span, 0.0, 1.0);
  // Counted from 1: a first place at 0 would mean the axis, and a mirrored neighbour.
  std::array<double, most_steps + 1> place{};
  std::iota(place.begin(), place.end(), 1.0);
  std::vector<Share> shares;
  for (const FieldShare& share : field_shares(std::span(place).first(steps_ + 1), at * double(steps_) + 1))
    if (share.weight != 0) shares.push_back({interval * steps_ + share.field, share.weight});
  return shares;
}

std::vector<std::size_t> PsfSeries::nodes_of(const std::vector<double>& heights_mm) const {
  std::vector<char> wanted(nodes_);
  for (const double height_mm : heights_mm)
    for (const Share& share : shares_at(height_mm)) wanted[share.node] = 1;
  std::vector<std::size_t> nodes;
  for (std::size_t node = 0; node < nodes_; ++node)
    if (wanted[node] != 0) nodes.push_back(node);
  return nodes;
}

std::size_t PsfSeries::interval_of(std::size_t node) const {
  const std::size_t intervals = std::max<std::size_t>(1, height_mm_.size() - 1);
  return std::min(node / steps_, intervals - 1);
}

double PsfSeries::height_of(std::size_t node) const {
  const std::size_t interval = node / steps_, step = node % steps_;
  if (step == 0) return height_mm_[interval];
  return height_mm_[interval] +
         (height_mm_[interval + 1] - height_mm_[interval]) * double(step) / double(steps_);
}

}  // namespace petzval
