// SPDX-License-Identifier: BSD-3-Clause
// Integrating finely sampled PSFs over the cells of an image.
#pragma once

#include <petzval/imaging/sample_scatter.h>
#include <petzval/wave/psf.h>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace petzval {

/// Moments of a distribution of unit sum over a plane: of u (columns) and v (rows).
struct Moments {
  std::array<double, 2> mean{};   ///< of u, of v
  double uu = 0, uv = 0, vv = 0;  ///< means of u², uv, v²; not about the mean
};

/// How the light of a cell falls on the cells about it: (2·radius + 1)² weights, row-major in picture
/// orientation (rows down, columns right). The origin of the PSF meets the centre of the middle cell.
struct Kernel {
  int radius = 0;
  std::vector<double> weights;

  Kernel() = default;
  explicit Kernel(int radius);  ///< all zero
  int size() const { return 2 * radius + 1; }
  /// Counted from the middle cell.
  double& at(int row, int column) { return weights[index(row, column)]; }
  double at(int row, int column) const { return weights[index(row, column)]; }
  double sum() const;
  /// Of the weights' positions from the middle cell [cells]. Needs a positive sum.
  Moments moments() const;
  /// Moves the moments to the wanted ones by letting every weight hand shares to the eight cells about it; at
  /// the rim it keeps them. The sum is kept. To make a kernel narrower, or to move a peak that is finer than
  /// a cell by a part of one, shares must be negative: beside the peak that leaves lobes below zero, but none
  /// deeper than a twentieth of the highest weight. What they would go beyond it stays undone in the spread;
  /// the centroid is met all the same.
  void match(const Moments& wanted);

 private:
  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>((row + radius) * size() + column + radius);
  }
};

/// What a PSF holds, and its sums of sample × position from an origin, and × products of positions: [µm],
/// [µm²]; u is s, v is t. Each sample is a square of the PSF's spacing.
struct LightMoments {
  double sum = 0;
  Moments sums;
};

/// \param origin_um  how far beyond the chief ray (along t) positions count from.
LightMoments light_moments(const Psf& psf, double origin_um);

/// A PSF with samples no finer than cells need them.
class MergedPsf {
 public:
  /// \param origin_um  how far beyond the chief ray (along t) lies the point that meets a kernel's centre.
  /// \param merged  this many samples along either axis, an odd number, become one: for cells that are much
  /// coarser.
  /// \param light  of the PSF about the origin.
  MergedPsf(const Psf& psf, double origin_um, int merged, const LightMoments& light);
  explicit MergedPsf(const Psf& psf, double origin_um = 0, int merged = 1)
      : MergedPsf(psf, origin_um, merged, light_moments(psf, origin_um)) {}
  /// What a kernel of cells as fine as samples holds that was deposited along (0, 1).
  MergedPsf(const Kernel& fine, double spacing_um);

  int size() const { return size_; }
  double spacing_um() const { return spacing_um_; }
  double sum() const { return light_.sum; }
  double origin_um() const { return origin_um_; }
  /// Where the first sample of a row, and of a column, lies from the chief ray.
  double first_um() const { return first_um_; }
  const Moments& moments() const { return light_.sums; }
  const LightMoments& light() const { return light_; }
  /// The samples of a row.
  const float* row(std::size_t index) const {
    return samples_.data() + index * static_cast<std::size_t>(size_);
  }
  /// What is lit of it.
  SampleSquare square(double weight) const {
    return {samples_.data(), lit_.data(), static_cast<std::size_t>(size_), static_cast<float>(weight)};
  }

 private:
  void find_light();

  int size_;
  double spacing_um_, origin_um_, first_um_;
  LightMoments light_;
  std::vector<float> samples_;   ///< row-major
  std::vector<LitSamples> lit_;  ///< of every row
};

/// How a PSF is laid down: its light, stretched about its centre of gravity along {s, t}.
struct Placement {
  double weight = 1;
  std::array<double, 2> stretch{1, 1};
};

/// Adds a PSF to a kernel, with its tangential direction along `direction` (x', y') of image space,
/// integrated over cells: between samples light is linear, and the cells share in it as they lie under its
/// shadows on the two axes; samples too coarse for that are squares, cut into parts that are not. What falls
/// outside the kernel is left out.
void deposit(const MergedPsf& psf, const Placement& placement, const std::array<double, 2>& direction,
             double cell_um, Kernel& kernel);
/// What one PSF contributes to a mixture.
struct WeightedPsf {
  const MergedPsf* psf;
  double weight;
};
/// The same with Σ weight · psf as they are, made from kernels; neighbours of one spacing at once.
void deposit(std::span<const WeightedPsf> psfs, const std::array<double, 2>& direction, double cell_um,
             Kernel& kernel);

}  // namespace petzval
