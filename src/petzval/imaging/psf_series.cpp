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

/// Mixing four of them, more changes an image by less than 1e-5 of itself.
constexpr std::size_t most_steps = 4;

/// PSFs in an interval, of every one as many.
std::size_t steps_of(const std::vector<double>& height_mm, const std::vector<SampleLattice>& lattices,
                     double step_mm) {
  constexpr double most_bytes = 64e6;
  double bytes_a_step = 0, widest_mm = 0;
  for (std::size_t i = 0; i + 1 < height_mm.size(); ++i) {
    const double side = 2.0 * lattices[i].half() + 1;
    const bool fades = i + 1 < lattices.size() && lattices[i + 1].spacing_um != lattices[i].spacing_um;
    bytes_a_step += (fades ? 2 : 1) * side * side * sizeof(double);
    widest_mm = std::max(widest_mm, height_mm[i + 1] - height_mm[i]);
  }
  const double wanted = std::min(std::ceil(widest_mm / step_mm), most_bytes / bytes_a_step - 1);
  return static_cast<std::size_t>(std::clamp(wanted, 1.0, double(most_steps)));
}

}  // namespace

PsfSeries::PsfSeries(std::vector<double> height_mm, std::vector<SampleLattice> lattices, double step_mm)
    : height_mm_(std::move(height_mm)), lattices_(std::move(lattices)) {
  if (height_mm_.size() > 1) steps_ = steps_of(height_mm_, lattices_, step_mm);
  for (std::size_t i = 0; i < lattices_.size(); ++i) {
    if (runs_.empty() || runs_.back().spacing_um != lattices_[i].spacing_um) {
      Run run;
      run.spacing_um = lattices_[i].spacing_um;
      // What fades into it begins an interval before.
      run.first_node = (i > 0 ? i - 1 : 0) * steps_;
      runs_.push_back(std::move(run));
    }
    runs_.back().last_interval = i;
  }
  for (Run& run : runs_) {
    run.size = (run.last_interval + 1) * steps_ + 1 - run.first_node;
    run.entries = std::make_unique<Entry[]>(run.size);
  }
}

std::vector<PsfSeries::Share> PsfSeries::shares_at(double height_mm) const {
  if (height_mm_.size() == 1) return {{{0, 0}, 1}};
  const double inside = std::clamp(height_mm, height_mm_.front(), height_mm_.back());
  const std::size_t interval = bracket(height_mm_, inside);
  const double low = height_mm_[interval], span = height_mm_[interval + 1] - low;
  const double at = std::clamp((inside - low) / span, 0.0, 1.0);
  // Counted from 1: a first place at 0 would mean the axis, and a mirrored neighbour.
  std::array<double, most_steps + 1> place{};
  std::iota(place.begin(), place.end(), 1.0);
  const auto of_places = field_shares(std::span(place).first(steps_ + 1), at * double(steps_) + 1);

  const auto run = static_cast<std::size_t>(
      std::find_if(runs_.begin(), runs_.end(), [&](const Run& r) { return interval <= r.last_interval; }) -
      runs_.begin());
  const bool fades = run + 1 < runs_.size() && interval == runs_[run].last_interval;
  const double of_next = fades ? at * at * (3 - 2 * at) : 0;
  std::vector<Share> shares;
  const auto add = [&](std::size_t of_run, double weight) {
    for (const FieldShare& share : of_places)
      if (weight * share.weight != 0)
        shares.push_back({{of_run, interval * steps_ + share.field}, weight * share.weight});
  };
  add(run, 1 - of_next);
  add(run + 1, of_next);
  return shares;
}

std::vector<PsfSeries::Node> PsfSeries::nodes_of(const std::vector<double>& heights_mm) const {
  std::vector<std::vector<char>> wanted;
  for (const Run& run : runs_) wanted.emplace_back(run.size);
  for (const double height_mm : heights_mm)
    for (const Share& share : shares_at(height_mm))
      wanted[share.node.run][share.node.index - runs_[share.node.run].first_node] = 1;
  std::vector<Node> nodes;
  for (std::size_t run = 0; run < wanted.size(); ++run)
    for (std::size_t i = 0; i < wanted[run].size(); ++i)
      if (wanted[run][i] != 0) nodes.push_back({run, runs_[run].first_node + i});
  return nodes;
}

double PsfSeries::height_of(std::size_t node) const {
  const std::size_t interval = node / steps_, step = node % steps_;
  if (step == 0) return height_mm_[interval];
  return height_mm_[interval] +
         (height_mm_[interval + 1] - height_mm_[interval]) * double(step) / double(steps_);
}

double PsfSeries::half_side_um(std::size_t node) const {
  return lattices_[std::min(node / steps_, lattices_.size() - 1)].half_side_um;
}

}  // namespace petzval
