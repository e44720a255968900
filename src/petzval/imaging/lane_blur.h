// SPDX-License-Identifier: BSD-3-Clause
// Fourier transforms of many tiles at once, on whatever SIMD the machine has: lanes are tiles.
#pragma once

#include <petzval/numeric/fft.h>

#include <array>
#include <cstddef>
#include <vector>

namespace petzval {

/// How many tiles are transformed at once: the floats of a vector of this machine, 4 to 16.
std::size_t lane_count();

/// What the transforms of one size share. Elements lie as lane_count() real parts, then as many imaginary
/// ones. The frequencies come out in a scrambled order (decimation in frequency, radix 4), which is the same
/// for tiles and kernels and is undone on the way back.
class LaneTransform {
 public:
  static constexpr int smallest = 16, largest = 256;
  /// Two columns of a plane of frequencies, which hold the frequencies k and −k along the rows; where these
  /// are the same, twice the same column.
  struct ColumnPair {
    int kept, mirrored;
  };
  /// \param size  of a side: a power of two from `smallest` to `largest`.
  explicit LaneTransform(int size);
  int size() const { return size_; }
  const float* twiddles() const { return twiddles_.data(); }
  /// Where −k is, for the k at each place.
  const std::vector<int>& mirrored() const { return mirrored_; }
  /// All columns. The transfer functions of real kernels need be kept for one of each pair.
  const std::vector<ColumnPair>& columns() const { return columns_; }

 private:
  int size_;
  AlignedVector<float> twiddles_;
  std::vector<int> mirrored_;
  std::vector<ColumnPair> columns_;
};

/// Transfer functions of twice lane_count() kernels. \param kernels  two times size × size elements, real
/// parts only. \param otfs  where element k of the kept column c goes, of the first lane: real part at (c ·
/// size + k) · stride, imaginary part `imaginary` floats behind it. The lanes lie side by side. Null where
/// the second kernels are not wanted.
void transform_lane_kernels(const LaneTransform& transform, const std::array<const float*, 2>& kernels,
                            int size, const std::array<float*, 2>& otfs, std::size_t stride,
                            std::size_t imaginary);

/// Where the light of pairs of tiles comes from and goes to, lane_count() pairs at once. A pair is the real
/// and the imaginary part of one complex tile: two places that share all their kernels. Several such sets of
/// pairs, which share kernels too, are blurred together.
class LaneTileIo {
 public:
  virtual ~LaneTileIo() = default;
  virtual std::size_t sets() const = 0;
  /// Fills the elements of a row of the tiles.
  virtual void load_row(std::size_t set, int row, float* elements) = 0;
  /// Before the first row is stored.
  virtual void begin_store() {}
  /// Takes the elements of a row of the blurred tiles, which begin one kernel radius before them.
  virtual void store_row(std::size_t set, int row, const float* elements) = 0;
};

/// Tiles whose every cell has its own mixture of nodes × nodes kernels.
struct LaneTiles {
  int tile = 0;    ///< cells along a side
  int extent = 0;  ///< cells along a side of what they spread over, at most the transform's size
  int nodes = 0;
  const float* weights = nullptr;  ///< [node][cell along a side]
  std::vector<const float*> otfs;  ///< [node along the rows][node along the columns], of the first lane
  std::size_t otf_stride = 0, otf_imaginary = 0;  ///< as transform_lane_kernels()
};

/// Blurs pairs of tiles: Σ_ab kernel_ab ∗ (weight_a weight_b · tile). Workspace is kept between calls.
void blur_lane_tiles(const LaneTransform& transform, const LaneTiles& tiles, LaneTileIo& io,
                     AlignedVector<float>& workspace);

}  // namespace petzval
