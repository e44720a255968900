// SPDX-License-Identifier: BSD-3-Clause
// The light of a clip at the instants that it is looked at.
#pragma once

#include <petzval/imaging/cell_plane.h>
#include <petzval/simulate/clip.h>

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace petzval {

/// How much of an exposure's light is that of an instant.
struct InstantShare {
  double t_s = 0, share = 0;
};

class ClipLight {
 public:
  using RowsOf = std::function<RowRange(std::size_t instant)>;
  using See = std::function<void(std::size_t instant, const SpectralImage* light)>;

  virtual ~ClipLight() = default;
  virtual int rows() const = 0;
  /// At the beginning of the clip, by which everything is settled.
  virtual SpectralImage first(const Context& context) const = 0;
  /// From one instant to another, those between which light changes in straight lines.
  virtual std::vector<double> instants(double from_s, double to_s, double exposure_s) const = 0;
  /// Shows the light at each instant in turn; null: as at the one before (of the first: as first()).
  /// \param rows_of  that are wanted.
  virtual void walk(const std::vector<double>& instants, const RowsOf& rows_of, const See& see) const = 0;
  /// The sum of instants, where that is less work than each; absent: it is not, or nothing moves.
  virtual std::optional<SpectralImage> sum(std::span<const InstantShare>) const { return {}; }
};

/// A plane, a panorama or a scene with depth, of whose picture every instant is formed.
std::unique_ptr<ClipLight> light_of_plan(ImagePlan plan, const ClipOptions& options);
/// A scene in three dimensions: every instant is rendered, with random numbers of its own.
std::unique_ptr<ClipLight> rendered_light(const RenderRequest& scene, const ClipOptions& options,
                                          const Context& context);

}  // namespace petzval
