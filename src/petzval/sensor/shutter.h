// SPDX-License-Identifier: BSD-3-Clause
// When the rows of a frame are exposed.
#pragma once

namespace petzval {

/// A global shutter exposes all rows at once; a rolling one begins each row one row time after the row above
/// it. Rows count from the first one that is read: a smaller frame is read sooner.
struct Shutter {
  enum class Kind { global, rolling };
  Kind kind = Kind::global;
  double row_time_s = 0;  ///< of a rolling shutter

  /// After the frame's first row [s].
  double row_delay_s(int row) const { return kind == Kind::rolling ? row * row_time_s : 0; }
};

}  // namespace petzval
