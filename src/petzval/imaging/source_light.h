// SPDX-License-Identifier: BSD-3-Clause
// From the light of a scene to that of source cells, each of which has one kernel.
#pragma once

#include <petzval/imaging/cell_plane.h>
#include <petzval/imaging/distortion.h>
#include <petzval/imaging/scene_aim.h>

#include <span>
#include <vector>

namespace petzval {

/// How source cells share in the light of parts of cells: between a plain mean over a cell's width, which
/// keeps the most detail, and three means, one after the other. What is finer than cells can hold comes back
/// as detail that is not there; of what lies one and a half cycles a cell away a plain mean leaves a fifth,
/// three leave a hundredth.
struct SourceFilter {
  int parts = 1;                   ///< a cell is as wide as so many
  std::vector<double> weights{1};  ///< of the parts about a cell, of sum 1; as many on either side

  /// \param parts  at least 1. \param threefold  the share of three means, 0 to 1; with one part it makes no
  /// difference.
  explicit SourceFilter(int parts, double threefold = 1);
  SourceFilter() = default;
  /// Parts beyond the edge of a cell.
  int reach() const { return (static_cast<int>(weights.size()) - parts) / 2; }
  /// What it leaves of a frequency [cycles a cell], with the mean over a part before it.
  double transform(double frequency) const;
};

/// Light under several aims of the camera, added up: what arrives while a shutter is open.
struct AimedLight {
  struct Share {
    SceneAim aim = {};
    double weight = 1;
  };
  std::vector<Share> shares{Share{}};
  RowRange rows = {};  ///< that are wanted; others are dark
};

/// The light of source cells: SceneRows on parts of cells, filtered. \param lights  rows are those of `grid`.
std::vector<CellPlane> source_lights(const Scene& scene, int band, const SceneMap& map,
                                     const SensorGeometry& grid, const SourceFilter& filter,
                                     Surround surround, std::span<const AimedLight> lights);
/// The same of a camera that looks straight.
CellPlane source_light(const Scene& scene, int band, const SceneMap& map, const SensorGeometry& grid,
                       const SourceFilter& filter, Surround surround);

}  // namespace petzval
