// SPDX-License-Identifier: BSD-3-Clause
// Bright sources in a scene.
#pragma once

#include <petzval/flare/bright_source.h>
#include <petzval/scene/scene.h>

#include <vector>

namespace petzval {

struct SourceSearch {
  /// Samples brighter than this times the mean of the scene belong to sources (radiance, the mean of the
  /// bands).
  double threshold = 100;
  int most = 16;  ///< sources; the brightest are taken

  /// \throws InputError saying what would be right.
  void validate() const;
};

struct SourcesFound {
  std::vector<BrightSource> sources;  ///< the one with the most light first
  int left_out = 0;
  double left_out_share = 0;  ///< of the light of all sources, at the lens
};

/// The `most` with the most light, which come first, and what is left out.
SourcesFound brightest(std::vector<BrightSource> sources, int most);

/// Bright samples that touch are one source: a disc of their solid angle about their centre of light, with
/// all their light. Those more than 80 degrees from the axis are behind the lens's back and do not count.
/// \param track_mm  from the first vertex to the sensor, from which the scene's distance counts.
/// \throws InputError as SourceSearch::validate(), and for a scene with depth.
SourcesFound find_sources(const Scene& scene, double track_mm, const SourceSearch& search = {});

}  // namespace petzval
