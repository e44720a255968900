// SPDX-License-Identifier: BSD-3-Clause
// What a JPEG makes of pixels: transforms of blocks, rounded.
#pragma once

#include <petzval/measure/sfr/edge_samples.h>

#include <span>
#include <vector>

namespace petzval {

/// A JPEG holds the cosine transforms of blocks of 8 × 8 code values, each coefficient rounded to a multiple
/// of its step (ITU-T T.81).
class RoundedBlocks {
 public:
  static constexpr int side = 8;
  /// Where blocks begin: right of and below a corner of those of the file [pixels], 0 to 7.
  struct Offset {
    int x = 0, y = 0;
  };
  /// \param plane  decoded, linear in light \param steps  of the coefficients, row by row from the lowest
  /// frequency, 64 \param levels  the light of each code value, rising. Steps and levels outlive it.
  RoundedBlocks(const Plane& plane, std::span<const int> steps, std::span<const double> levels);

  /// By how much the light at each sample would change, were it recorded in such blocks. \param light  at
  /// each sample; what else lies in a block is as it is in the plane. Samples in blocks that the picture cuts
  /// off do not change.
  std::vector<double> changes(std::span<const EdgeSample> samples, std::span<const double> light,
                              const Offset& offset) const;

  /// By how much the mean of a block about this light may differ that is recorded as the same.
  double room_of_means(double light) const;

 private:
  double code_of(double light) const;
  double light_of(double code) const;

  Plane codes_;
  std::span<const int> steps_;
  std::span<const double> levels_;
  double bins_per_light_ = 0;             ///< from the first level to the last, in even bins
  std::vector<std::size_t> first_above_;  ///< of the levels but the first, above the beginning of each bin
};

}  // namespace petzval
