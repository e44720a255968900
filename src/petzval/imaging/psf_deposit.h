// SPDX-License-Identifier: BSD-3-Clause
// Integrating finely sampled PSFs over the cells of an image.
#pragma once

#include <petzval/wave/psf.h>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace petzval {

/// How the light of a cell falls on the cells about it: (2·radius + 1)² weights, row-major in picture
/// orientation (rows down, columns right). The chief ray meets the centre of the middle cell.
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
  /// Mean position of the weights from the middle cell: {column, row}. Needs a positive sum.
  std::array<double, 2> centroid() const;
  /// Moves the centroid by less than a cell along each axis, by handing that share of every weight to the
  /// next cell; at the rim it stays. The sum is kept and nothing becomes negative.
  void shift(const std::array<double, 2>& by);

 private:
  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>((row + radius) * size() + column + radius);
  }
};

/// A PSF with running sums along its rows, so that the light of any run of samples is one subtraction.
class RunningPsf {
 public:
  explicit RunningPsf(const Psf& psf);

  int size() const { return size_; }
  double spacing_um() const { return spacing_um_; }
  double sum() const { return sum_; }
  /// Σ of sample × position from the chief ray [µm]: {s, t}.
  const std::array<double, 2>& first_moment_um() const { return first_moment_um_; }
  /// Whether two PSFs have their samples in the same places.
  bool same_grid(const RunningPsf& other) const {
    return size_ == other.size_ && spacing_um_ == other.spacing_um_;
  }
  /// Σ of samples [row][from … to − 1].
  double run(std::size_t row, std::size_t from, std::size_t to) const {
    const double* sums = sums_.data() + row * (static_cast<std::size_t>(size_) + 1);
    return sums[to] - sums[from];
  }

 private:
  int size_;
  double spacing_um_;
  double sum_ = 0;
  std::array<double, 2> first_moment_um_{};
  std::vector<double> sums_;  ///< size rows of size + 1
};

struct WeightedPsf {
  const RunningPsf* psf;
  double weight;
};

/// Adds PSFs to a kernel, with their tangential direction along `direction` (x', y') of image space,
/// integrated over cells: each sample is light spread evenly over a square of the spacing (with its sides
/// along the cells), which the cells under it share by area. What falls outside the kernel is left out.
/// \param psfs  at least one, all on the same grid.
void deposit(std::span<const WeightedPsf> psfs, const std::array<double, 2>& direction, double cell_um,
             Kernel& kernel);

}  // namespace petzval
