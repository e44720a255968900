// SPDX-License-Identifier: BSD-3-Clause
// Light of a turned lattice of samples falls on the cells of a picture, on whatever SIMD the machine has.
#pragma once

#include <petzval/numeric/fft.h>

#include <array>
#include <cstddef>
#include <span>

namespace petzval {

/// Samples [first, end) of a row: outside them it is dark.
struct LitSamples {
  std::size_t first = 0, end = 0;
};

/// Samples of one PSF of a mixture.
struct SampleSquare {
  const float* samples;   ///< size × size, row-major
  const LitSamples* lit;  ///< of every row
  std::size_t size;
  float weight;
};

/// How samples lie on the cells, which have sides of 1: {column, row}.
struct PlacedLattice {
  std::array<double, 2> first;                ///< the first sample of the first row
  std::array<double, 2> per_row, per_column;  ///< from sample to sample
};

/// Cells, each with the four parts of the light of blobs that begin in it until the end: what stays here,
/// what goes right, below, right below. So a blob is one addition of a short vector.
class Canvas {
 public:
  /// Cells count from 0 to `width` − 1 along either side.
  explicit Canvas(int width)
      : width_(width), parts_(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(width)) {}
  int width() const { return width_; }
  float* cells() { return parts_.data(); }
  /// The light of a cell that is not the first of a row or column.
  double sum(int row, int column) const {
    return double(cell(row, column)[0]) + double(cell(row, column - 1)[1]) +
           double(cell(row - 1, column)[2]) + double(cell(row - 1, column - 1)[3]);
  }

 private:
  const float* cell(int row, int column) const { return parts_.data() + 4 * (row * width_ + column); }

  int width_;
  AlignedVector<float> parts_;
};

/// The radius of the blob of light that a sample becomes. \param step  from sample to sample. Smooth light
/// stays smooth: the spectrum of the blob is small at the lattice's own frequency and beyond.
inline double blob_radius(double step) {
  return 1.5 * step;
}

/// Adds Σ weight · samples to a canvas, squares of odd sizes about one middle, the lattice that of the
/// largest. On either axis the light of a sample lies under (1 − (x/R)²)⁴, R the blob_radius() of √(a² + b²),
/// a and b the steps along rows and columns as far as they go along that axis: for square lattices the same
/// at any angle. At most half a cell: samples farther apart are not smooth. What falls beside the canvas is
/// left out.
void scatter_samples(std::span<const SampleSquare> squares, const PlacedLattice& lattice, Canvas& canvas);

/// sums[i] += weight · row[i], i < count.
void add_scaled(const float* row, float weight, std::size_t count, float* sums);

}  // namespace petzval
