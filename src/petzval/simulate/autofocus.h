// SPDX-License-Identifier: BSD-3-Clause
// Autofocus on a three-dimensional scene: what is asked for, and what it took.
#pragma once

#include <petzval/focus/autofocus.h>
#include <petzval/focus/zones.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace petzval {

/// How a camera focuses by itself on a three-dimensional scene.
struct AutofocusOptions {
  enum class Search {
    brent,        ///< coarse places, then find_focus()
    golden_2006,  ///< the golden sections of 2006, find_focus_2006()
    scan          ///< `most_evaluations` places evenly over the range, scan_focus()
  };
  std::vector<FocusZone> zones = {};  ///< what is to be sharp; empty: the middle ninth of the picture
  FocusMeasureOptions measure = {};
  Search search = Search::brent;
  /// Of the zones. Where their noise leaves the measure ragged, four times and sixteen times as many are
  /// taken.
  int samples_per_pixel = 16;
  /// At most so many places; absent: 12, and of golden_2006 as many as its sections take.
  std::optional<int> most_evaluations = {};
  static constexpr int usual_evaluations = 12;
  /// Film distances searched; absent: from a little before infinity is sharp to 0.15 focal lengths beyond.
  std::optional<double> from_mm = {}, to_mm = {};
  std::optional<double> depth_mm = {};  ///< of focus, the scale of the search; absent: f-number × pixel
};

/// "brent", "golden-2006", "scan". \throws InputError for another name.
AutofocusOptions::Search autofocus_search_of(std::string_view name);

/// A search, and what it took.
struct FocusRun {
  std::string lens;   ///< its name
  std::string zones;  ///< that were looked at: ", zone 0.33 0.67 0.33 0.67"
  FocusResult result;
  double distance_m = 0;      ///< from the film to what is sharp; infinite beyond the focus of infinity
  double depth_mm = 0;        ///< of focus: f-number × pixel, unless it was given
  int samples_per_pixel = 0;  ///< at last
  std::uint64_t camera_rays = 0;
};

}  // namespace petzval
