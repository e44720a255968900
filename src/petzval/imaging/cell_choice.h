// SPDX-License-Identifier: BSD-3-Clause
// How many cells a pixel needs, by the scene's own detail and the lens.
#pragma once

#include <petzval/imaging/frame_transfer.h>
#include <petzval/imaging/image_formation.h>
#include <petzval/imaging/scene_detail.h>

namespace petzval {

/// Relative L2 errors of a picture whose pixels are so many cells wide, whatever the blur method: detail that
/// cells cannot hold, and kernels' samples that mistake one frequency for another. Power of the scene's
/// detail times the square of what comes out wrong of it, zone by zone of the frame, over that of the
/// picture.
class SamplingErrors {
 public:
  /// \param site  must outlive it.
  SamplingErrors(const SceneDetail& detail, const FrameTransfer& lens, const Photosite& site, int cells);
  /// \param source  on the way to the cells; kernels have a window.
  double with(const SourceFilter& source) const;

 private:
  const Photosite& site_;
  int cells_;
  double light_ = 0;
  std::vector<PassedWaves> power_;  ///< by DetailBands, of all zones: times the power of the detail
};

/// How many cells a pixel gets, and the SamplingErrors that they leave, with a caution for edges that lie
/// alike.
struct CellChoice {
  int cells = 1;
  int parts = 1;         ///< of a cell, along a side
  double threefold = 0;  ///< SourceFilter, both
  bool window = true;    ///< LightPath
  double sampling_error = 0;
  /// Standard deviation of the light of cells over its mean, were all detail of the scene as strong as its
  /// finest: large for lights in darkness.
  double contrast = 0;

  /// What light goes through on its way to the cells. \param points  of the scene along a cell: no part of it
  /// may see more than one.
  LightPath path(int points) const;
};

/// In the scene's middle band, the cells and the source filter that take the least work of those whose error
/// leaves the blur what it may take of the tolerance: 2 cells at least, but for previews, and
/// ImagingOptions::most_cells at most. Where the options name the cells, the filter of the least error.
/// \param known  of the same scene, or null.
CellChoice choose_cells(const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
                        const ImagingOptions& options, KnownDetail* known = nullptr);

}  // namespace petzval
