// SPDX-License-Identifier: BSD-3-Clause
// Where a picture is all one value.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace petzval {

/// A picture in blocks of 16 × 16 samples, and which of them are flat.
class FlatBlocks {
 public:
  /// \param samples  columns × rows of them.
  FlatBlocks(std::span<const float> samples, std::size_t columns, std::size_t rows);

  /// The value of all samples that touch a rectangle [samples from the upper left corner], if they have but
  /// one. \param extended  beyond the picture its outermost samples go on; else nothing is known of there.
  std::optional<float> value_in(double left, double right, double top, double bottom, bool extended) const;
  /// Whether there are any.
  bool any() const { return any_; }

 private:
  std::size_t columns_, rows_, across_;
  std::vector<float> values_;  ///< of each block; NaN: several
  bool any_ = false;
};

}  // namespace petzval
