// SPDX-License-Identifier: BSD-3-Clause
// The scattered light of a source all over the sensor, for any wavelength.
#pragma once

#include <petzval/flare/scatter_way.h>
#include <petzval/sensor/sensor.h>

#include <array>
#include <vector>

namespace petzval {

/// How each surface of a lens scatters at one wavelength: what a ScatterField is asked with.
using LensBsdfs = std::vector<SurfaceBsdf>;

/// What scatter_spread() says, from a grid of points of the sensor: β − β₀ and d²β/d(x, y) of each surface
/// are smooth over the sensor and nearly the same at all wavelengths, the BSDF is neither. β − β₀, the mean
/// over what is lit, is linear between the points of the grid, and so is the other.
class ScatterField {
 public:
  /// \param reach  of the grid, over the frame's width and height. \param across  as ScatterSpreadOptions.
  ScatterField(const ScatterTracer& tracer, const BrightSource& source, const SensorGeometry& frame,
               double reach, int across);

  const SourceImage& image() const { return image_; }
  /// Of what each surface meets.
  std::vector<ScatterShares> shares(const LensBsdfs& bsdfs) const;
  /// Irradiance at a point over that of the source at the first vertex; what lies beyond the grid is as at
  /// its edge. \param shares  as shares() says. \param about_image  the source is imaged there, so that β −
  /// β₀ is nothing there.
  double at(const LensBsdfs& bsdfs, const std::vector<ScatterShares>& shares, double x_mm, double y_mm,
            bool about_image) const;
  /// The mean over a disc about the image.
  double core(const LensBsdfs& bsdfs, double radius_mm) const;
  /// The share of the image's light that is scattered or kept by dust.
  double share(const LensBsdfs& bsdfs) const;

 private:
  struct Node {
    std::array<double, 2> offset{};
    double per_mm2 = 0;
  };
  struct SurfaceField {
    std::vector<Node> nodes;
    std::array<double, 2> offset_at_image{};
    double cosine_before = 1, cosine_after = 1;
    bool lit = false;
  };
  Node interpolated(const SurfaceField& field, double x_mm, double y_mm) const;
  ScatterShares shares_of(const LensBsdfs& bsdfs, std::size_t surface) const;

  static constexpr int side = 9;
  double half_width_mm_ = 1, half_height_mm_ = 1;
  SourceImage image_;
  double imaged_over_lit_ =
      1;  ///< share that is scattered: of the image's rays over that of all that are lit
  std::vector<SurfaceField> fields_;
};

}  // namespace petzval
