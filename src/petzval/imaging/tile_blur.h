// SPDX-License-Identifier: BSD-3-Clause
// The blur of one tile by mixtures of kernels, by Fourier transforms on whatever SIMD the machine has.
#pragma once

#include <petzval/numeric/fft.h>

#include <array>
#include <cstddef>
#include <vector>

namespace petzval {

/// The floats of a vector of this machine, 1 to 16: so many rows or columns of a tile are transformed at
/// once.
std::size_t lane_count();

/// The blocks that a line of so many elements comes down to when it is divided by four as often as may be: 2,
/// 3, 4 or 6 elements.
constexpr int shortest_block(int size) {
  while (size % 4 == 0 && size > 4) size /= 4;
  return size;
}

/// What the transforms of one size share. Frequencies come out in a scrambled order (decimation in frequency,
/// radix 4), which is the same for tiles and kernels and is undone on the way back.
///
/// Columns of frequencies are worked on in blocks of lane_count(). Transfer functions of real kernels are
/// kept for half of the columns, by blocks: [block][row of frequencies]{re, im}[lane]. The other half of the
/// blocks holds the mirrored columns, −k for every k, in the same order. Two columns are their own mirror
/// images, those of frequency 0 and of half the size: they share the last lane, and the transfer function of
/// the second one, conjugate, follows the blocks: [row of frequencies]{re, −im}.
class TileTransform {
 public:
  static constexpr std::array sizes = {32, 64, 96, 128, 192, 256, 384, 512, 768, 1024};
  static constexpr int largest = sizes.back();
  /// \param size  of a side, one of `sizes`. \throws InputError for another.
  explicit TileTransform(int size);
  int size() const { return size_; }
  const float* twiddles() const { return twiddles_.data(); }
  /// Where −k is, for the k at each place.
  const std::vector<int>& mirrored() const { return mirrored_; }
  /// Places of columns: [block][lane], first the kept ones, then as many mirrored ones.
  const std::vector<int>& columns() const { return columns_; }
  std::size_t kept_blocks() const { return kept_blocks_; }
  /// Of the transfer function of one kernel.
  std::size_t otf_floats() const {
    const auto side = static_cast<std::size_t>(size_);
    return side * side + 2 * side;
  }

 private:
  int size_;
  AlignedVector<float> twiddles_;
  std::vector<int> mirrored_, columns_;
  std::size_t kept_blocks_;
};

/// Transfer functions of two kernels of size × size weights. \param otfs  where they go, aligned to 64 bytes;
/// the second kernel and its place may be null.
void transform_kernels(const TileTransform& transform, const std::array<const float*, 2>& kernels, int size,
                       const std::array<float*, 2>& otfs, AlignedVector<float>& workspace);

/// The light of a pair of tiles: two places that share all their kernels, as the real and the imaginary part
/// of one complex tile.
class TileLight {
 public:
  virtual ~TileLight() = default;
  /// Fills a row of both.
  virtual void load_row(int row, float* real, float* imaginary) const = 0;
};

/// Tiles whose every cell has its own mixture of nodes × nodes kernels.
struct TileMixture {
  int tile = 0;    ///< cells along a side
  int extent = 0;  ///< cells along a side of what they spread over, at most the transform's size
  int nodes = 0;
  const float* weights = nullptr;  ///< [node][cell along a side]
  std::vector<const float*> otfs;  ///< [node along the rows][node along the columns]
};

/// Blurs a pair of tiles: Σ_ab kernel_ab ∗ (weight_a weight_b · tile). \param blurred  [row of the
/// extent]{real, imaginary}[transform size], beginning one kernel radius before the tile; aligned to 64
/// bytes. \param workspace  kept between calls.
void blur_tile(const TileTransform& transform, const TileMixture& mixture, const TileLight& light,
               AlignedVector<float>& workspace, float* blurred);

/// Floats of `blurred`: rows of whole vectors.
std::size_t blurred_floats(const TileTransform& transform, const TileMixture& mixture);

}  // namespace petzval
