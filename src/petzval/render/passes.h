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
  /// Of a picture to be denoised: few samples make two halves.
  static constexpr int indices_to_denoise = 2;

  Passes(const WavelengthGroups& groups, const RenderOptions& options)
      : groups_(groups.count()),
        samples_(effective_samples(groups, options.samples_per_pixel)),
        each_(options.denoise ? indices_to_denoise : indices_a_pass),
        halves_(options.noise > 0 || options.denoise) {
    count_ = (most_of_group() + each_ - 1) / each_;
    if (!halves_) return;
    count_ += count_ % 2;
    samples_ = count_ * each_ * groups_;
  }

  int count() const { return count_; }
  std::vector<SampleRange> ranges(int pass) const {
    // Of two halves each has samples of its own.
    const int index = (halves_ ? pass / 2 : pass) * each_;
    std::vector<SampleRange> result;
    for (int group = 0; group < groups_; ++group)
      result.push_back({index, index + taken(group, pass + 1) - taken(group, pass)});
    return result;
  }
  /// Samples of a group after some passes.
  int taken(int group, int passes) const {
    const int of_group = (samples_ - group + groups_ - 1) / groups_;
    return std::min(passes * each_, of_group);
  }
  int taken(int passes) const {
    int sum = 0;
    for (int group = 0; group < groups_; ++group) sum += taken(group, passes);
    return sum;
  }
  /// Passes that take as many samples as a pass can: what follows them does not depend on how many are
  /// wanted.
  int full() const { return samples_ / samples_a_pass(); }
  int samples_a_pass() const { return each_ * groups_; }

 private:
  int most_of_group() const { return (samples_ + groups_ - 1) / groups_; }

  int groups_, samples_, each_, count_ = 0;
  bool halves_;
};

}  // namespace petzval::render
