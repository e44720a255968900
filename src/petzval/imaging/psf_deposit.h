// SPDX-License-Identifier: BSD-3-Clause
// Integrating finely sampled PSFs over the cells of an image.
#pragma once

#include <petzval/wave/psf.h>

#include <array>
#include <cstddef>
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

  int size() const { return size_; }
  double spacing_um() const { return spacing_um_; }
  double sum() const { return light_.sum; }
  double origin_um() const { return origin_um_; }
  /// Where the first sample of a row, and of a column, lies from the chief ray.
  double first_um() const { return first_um_; }
  const Moments& moments() const { return light_.sums; }
  const LightMoments& light() const { return light_; }
  const std::vector<float>& samples() const { return samples_; }

 private:
  int size_;
  double spacing_um_, origin_um_, first_um_;
  LightMoments light_;
  std::vector<float> samples_;  ///< row-major, then row_padding()
};

/// How a PSF is laid down: its light, stretched about its centre of gravity along {s, t}.
struct Placement {
  double weight = 1;
  std::array<double, 2> stretch{1, 1};
  bool across_axis = false;  ///< seen from the other side of the axis: turned by half a turn
};

/// Adds a PSF to a lattice whose rows run along its tangential direction, integrated over squares as wide as
/// the lattice's spacing: between samples light is linear. What falls outside is left out.
void deposit(const MergedPsf& psf, const Placement& placement, double spacing_um, Kernel& lattice);

}  // namespace petzval
