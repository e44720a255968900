// SPDX-License-Identifier: BSD-3-Clause
// Which samples are taken when.
#pragma once

#include <petzval/render/renderer.h>
#include <petzval/render/tile_renderer.h>

#include <algorithm>
#include <vector>

namespace petzval::render {

/// How the samples of a pixel are dealt out: to the groups of wavelengths in turn, four of each in a pass.
class Passes {
 public:
  /// Samples of each group of wavelengths in one pass over the picture.
  static constexpr int indices_a_pass = 4;

  Passes(const WavelengthGroups& groups, const RenderOptions& options)
      : groups_(groups.count()),
        samples_(effective_samples(groups, options.samples_per_pixel)),
        halves_(options.noise > 0) {
    count_ = (most_of_group() + indices_a_pass - 1) / indices_a_pass;
    if (!halves_) return;
    count_ += count_ % 2;
    samples_ = count_ * indices_a_pass * groups_;
  }

  int count() const { return count_; }
  std::vector<SampleRange> ranges(int pass) const {
    // Of two halves each has samples of its own.
    const int index = (halves_ ? pass / 2 : pass) * indices_a_pass;
    std::vector<SampleRange> result;
    for (int group = 0; group < groups_; ++group)
      result.push_back({index, index + taken(group, pass + 1) - taken(group, pass)});
    return result;
  }
  /// Samples of a group after some passes.
  int taken(int group, int passes) const {
    const int of_group = (samples_ - group + groups_ - 1) / groups_;
    return std::min(passes * indices_a_pass, of_group);
  }
  int taken(int passes) const {
    int sum = 0;
    for (int group = 0; group < groups_; ++group) sum += taken(group, passes);
    return sum;
  }
  /// Passes that take as many samples as a pass can: what follows them does not depend on how many are
  /// wanted.
  int full() const { return samples_ / (indices_a_pass * groups_); }

 private:
  int most_of_group() const { return (samples_ + groups_ - 1) / groups_; }

  int groups_, samples_, count_ = 0;
  bool halves_;
};

}  // namespace petzval::render
