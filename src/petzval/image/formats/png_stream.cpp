// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/image/formats/png_stream.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <vector>

namespace petzval {

namespace {

using Bytes = std::vector<unsigned char>;

constexpr std::size_t block_bytes = 1 << 20;  // of pixels; what blocks could learn from each other is 0.5 %
constexpr int filter_count = 5;               // none, sub, up, average, Paeth

int paeth(int left, int up, int corner) {
  const int to_left = std::abs(up - corner), to_up = std::abs(left - corner),
            to_corner = std::abs(left + up - 2 * corner);
  return to_left <= to_up && to_left <= to_corner ? left : to_up <= to_corner ? up : corner;
}

/// One row by one filter. All have `pixel` zeros before their first byte. \returns the sum of magnitudes.
template <typename Predict>
unsigned filtered_by(const unsigned char* row, const unsigned char* above, std::size_t count,
                     std::size_t pixel, unsigned char* out, const Predict& predict) {
  unsigned sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto left = row - pixel, corner = above - pixel;
    const auto difference = static_cast<unsigned char>(
        row[i] - static_cast<unsigned char>(predict(left[i], above[i], corner[i])));
    out[i] = difference;
    sum += difference < 128 ? difference : 256U - difference;
  }
  return sum;
}

unsigned filtered(int filter, const unsigned char* row, const unsigned char* above, std::size_t count,
                  std::size_t pixel, unsigned char* out) {
  switch (filter) {
    case 0:
      return filtered_by(row, above, count, pixel, out, [](int, int, int) { return 0; });
    case 1:
      return filtered_by(row, above, count, pixel, out, [](int left, int, int) { return left; });
    case 2:
      return filtered_by(row, above, count, pixel, out, [](int, int up, int) { return up; });
    case 3:
      return filtered_by(row, above, count, pixel, out,
                         [](int left, int up, int) { return (left + up) / 2; });
    default:
      return filtered_by(row, above, count, pixel, out, paeth);
  }
}

/// Rows of one block on their way through.
struct Block {
  Bytes rows;  ///< one more in front: the last of the block before; each with `pixel` zeros in front
  Bytes compressed;
  uLong adler = 0;
  std::size_t filtered_bytes = 0;
};

class PngStream {
 public:
  PngStream(int rows, std::size_t row_bytes, std::size_t pixel_bytes)
      : row_bytes_(row_bytes),
        pixel_(pixel_bytes),
        rows_(static_cast<std::size_t>(rows)),
        rows_per_block_(std::max<std::size_t>(1, block_bytes / row_bytes)),
        last_row_(stride()) {}

  std::size_t blocks() const { return (rows_ + rows_per_block_ - 1) / rows_per_block_; }

  void read(std::size_t index, Block& block, const PngByteRow& source) {
    const std::size_t count = rows_of(index);
    block.rows.assign((count + 1) * stride(), 0);
    std::copy(last_row_.begin(), last_row_.end(), block.rows.begin());
    for (std::size_t r = 0; r < count; ++r)
      source(static_cast<int>(index * rows_per_block_ + r),
             std::span(block.rows).subspan((r + 1) * stride() + pixel_, row_bytes_));
    std::copy(block.rows.end() - static_cast<std::ptrdiff_t>(stride()), block.rows.end(), last_row_.begin());
  }

  void compress(std::size_t index, Block& block) const {
    const std::size_t count = rows_of(index);
    Bytes filtered_rows(count * (row_bytes_ + 1));
    for (std::size_t r = 0; r < count; ++r)
      filter_row(block.rows.data() + r * stride() + pixel_, filtered_rows.data() + r * (row_bytes_ + 1));
    block.filtered_bytes = filtered_rows.size();
    block.adler = adler32_z(adler32_z(0, nullptr, 0), filtered_rows.data(), filtered_rows.size());
    // Differences of photographs are noise, in which there is nothing to find but their frequency. Drawings
    // have more, and are quickly done.
    const bool last = index + 1 == blocks();
    deflate_block(filtered_rows, last, {1, Z_RLE}, block.compressed);
    constexpr std::size_t drawing = 4;
    if (drawing * block.compressed.size() < filtered_rows.size())
      deflate_block(filtered_rows, last, {6, Z_DEFAULT_STRATEGY}, block.compressed);
  }

 private:
  std::size_t stride() const { return pixel_ + row_bytes_; }
  std::size_t rows_of(std::size_t index) const {
    return std::min(rows_per_block_, rows_ - index * rows_per_block_);
  }

  void filter_row(const unsigned char* above, unsigned char* out) const {
    Bytes trial(row_bytes_);
    unsigned least = ~0U;
    for (int filter = 0; filter < filter_count; ++filter) {
      const unsigned sum = filtered(filter, above + stride(), above, row_bytes_, pixel_, trial.data());
      if (sum >= least) continue;
      least = sum;
      out[0] = static_cast<unsigned char>(filter);
      std::copy(trial.begin(), trial.end(), out + 1);
    }
  }

  struct Effort {
    int level, strategy;
  };

  /// Ends on a whole byte, so that another block can follow.
  static void deflate_block(Bytes& from, bool last, Effort effort, Bytes& into) {
    constexpr int bare = -15, memory = 9;
    z_stream stream{};
    if (deflateInit2(&stream, effort.level, Z_DEFLATED, bare, memory, effort.strategy) != Z_OK)
      throw Failure("no memory to compress a picture");
    constexpr std::size_t flush_bytes = 16;
    into.resize(deflateBound(&stream, static_cast<uLong>(from.size())) + flush_bytes);
    stream.next_in = from.data();
    stream.avail_in = static_cast<uInt>(from.size());
    stream.next_out = into.data();
    stream.avail_out = static_cast<uInt>(into.size());
    const int result = deflate(&stream, last ? Z_FINISH : Z_SYNC_FLUSH);
    into.resize(into.size() - stream.avail_out);
    deflateEnd(&stream);
    if (result != (last ? Z_STREAM_END : Z_OK)) throw Failure("a picture cannot be compressed");
  }

  std::size_t row_bytes_, pixel_, rows_, rows_per_block_;
  Bytes last_row_;
};

}  // namespace

void compress_png_rows(int rows, std::size_t row_bytes, std::size_t pixel_bytes, const PngByteRow& source,
                       const PngPiece& take) {
  PngStream stream(rows, row_bytes, pixel_bytes);
  const std::size_t count = stream.blocks();
  std::vector<Block> slots(std::min<std::size_t>(count, 2 * static_cast<std::size_t>(thread_count())));
  uLong adler = adler32_z(0, nullptr, 0);
  parallel_stages(count, slots.size(),
                  {[&](std::size_t index, std::size_t slot) { stream.read(index, slots[slot], source); },
                   [&](std::size_t index, std::size_t slot) { stream.compress(index, slots[slot]); },
                   [&](std::size_t index, std::size_t slot) {
                     Bytes& piece = slots[slot].compressed;
                     constexpr std::array<unsigned char, 2> zlib_header = {0x78, 0x9c};
                     if (index == 0) piece.insert(piece.begin(), zlib_header.begin(), zlib_header.end());
                     adler = adler32_combine(adler, slots[slot].adler,
                                             static_cast<z_off_t>(slots[slot].filtered_bytes));
                     if (index + 1 == count)
                       for (int shift = 24; shift >= 0; shift -= 8)
                         piece.push_back(static_cast<unsigned char>(adler >> shift & 0xff));
                     take(piece);
                   }});
}

}  // namespace petzval
